#pragma once

#include "pipeline/geometry/lattice.h"
#include "pipeline/geometry/points.h"
#include "tiling/image.h"
#include "tiling/rect.h"

#include <array>
#include <functional>
#include <vector>

namespace hsgm::geometry {

/// How pixels are weighted round a place between them.
enum class Kernel {
    bicubic, ///< Keys' cubic convolution, a = -1/2: 4 x 4 pixels
    lanczos  ///< Lanczos' windowed sinc of 3 lobes: 6 x 6 pixels, sharper
};

/// Reads a window of the source, inside it, into a view of its size; NaN where a pixel has no
/// value.
using ReadPixels =
    std::function<void(const tiling::Rect& window, tiling::ImageView<double> values)>;

/// Where the source shows what a lattice's (x, y) speak of, if that is not the source itself;
/// not finite where it shows nothing.
using PlaceInSource = std::function<ImagePoint(ImagePoint)>;

/// Draws a source image into a frame, straight from its pixels. A pixel of the result depends
/// on its place alone and not on the window in which it is asked for, to the last bit.
///
/// Where a step of the frame spans more than a pixel of the source, the kernel is stretched
/// so that it weighs all that the step covers. A pixel has no value (NaN) where the source
/// pixel nearest to it has none or lies outside; elsewhere, what the kernel lacks is taken to
/// equal that nearest pixel. Places are rounded to 1/1024 px.
class Resampler {
public:
    /// `sensor_from_frame` holds x and y in the source for rows and columns of the frame; it
    /// must outlive this. With `then`, x and y are not yet those of the source: each place is
    /// handed through it. It must depend on the place alone, and move neighbours alike.
    Resampler(const Lattice& sensor_from_frame, tiling::Size source, Kernel kernel,
              PlaceInSource then = nullptr);

    /// The source pixels that a window of the frame may read: inside the source, perhaps empty.
    tiling::Rect source_window(const tiling::Rect& window) const;

    /// Fills `result` (of the window's size). Reads the source in pieces of a few megabytes.
    /// Safe from several threads where `read` is.
    void resample(const tiling::Rect& window, const ReadPixels& read,
                  tiling::ImageView<double> result) const;

    /// Source pixels that a step of the frame spans along the source's x and y.
    double span_x() const { return across_.span; }
    double span_y() const { return down_.span; }

private:
    /// One direction of the kernel: weights of `taps` pixels for each fraction of a pixel.
    struct Weights {
        double span = 1;
        int taps = 0;
        std::vector<double> table;
        const double* at(int phase) const
        {
            return table.data() + static_cast<std::size_t>(phase) * std::size_t(taps);
        }
    };
    /// The pixels of a block: places in the source, in 1/1024 px.
    struct Places;

    static Weights make_weights(double span, Kernel kernel);
    Places places_of(const tiling::Rect& block) const;
    tiling::Rect reach(const Places& places) const;
    void resample_block(const tiling::Rect& block, const ReadPixels& read,
                        tiling::ImageView<double> result) const;
    double value(const tiling::Patch<double>& source, int x_fixed, int y_fixed) const;
    double patched(const tiling::Patch<double>& source, int x_fixed, int y_fixed,
                   double nearest) const;

    const Lattice& lattice_;
    tiling::Size source_;
    PlaceInSource then_;
    Weights across_;
    Weights down_;
};

} // namespace hsgm::geometry
