#pragma once

#include "pipeline/synth/landscape.h"
#include "pipeline/synth/ray_caster.h"
#include "pipeline/synth/sensor.h"
#include "tiling/image.h"

#include <cstdint>
#include <functional>

namespace hsgm::synth {

/// The line of sight of a point of an image, given by column and row (integer at pixel
/// centres). Must be smooth: a renderer asks every 16 px and interpolates, which for lines
/// that bend less than 1e-7 per px and px is exact to 1e-5 cells.
using RayOfPixel = std::function<Ray(double col, double row)>;
/// The line of sight through a point of the map at a height.
using RayThrough = std::function<Ray(double x, double y, double height_m)>;

/// What a map cell is made of, as in truth_classes.tif.
enum class CellClass : std::uint8_t { ground = 0, object = 1, low_texture = 4 };

/// Renders a scene as cameras far above see it, with the truth on the map. Any rectangle can
/// be rendered on its own and has the pixels that the whole would have; all methods are const
/// and may be called from any number of threads at once.
class OverheadRenderer {
public:
    /// Throws std::invalid_argument where the scene is not valid.
    explicit OverheadRenderer(const Scene& scene) : landscape_(scene) {}

    /// Heights that nothing passes, in metres above the base.
    DisparityBounds heights_m() const { return landscape_.bounds(); }

    /// Height of the bare ground at a point of the map, in metres above the base.
    double ground_m(double x, double y) const { return landscape_.ground().disparity(x, y); }

    /// Gray levels 1..full scale, 0 = nodata: a pixel is the mean of 4 x 4 rays.
    void render(const RayOfPixel& ray_of, const Camera& camera, const tiling::Rect& part,
                tiling::ImageView<std::uint16_t> out) const;

    /// Height at the centres of the map's cells (rows = y, columns = x), in metres above the
    /// base, and what is there.
    void heights(const tiling::Rect& part, tiling::ImageView<float> out) const;
    void classes(const tiling::Rect& part, tiling::ImageView<std::uint8_t> out) const;

    /// Sets `bit` in the cells whose surface the camera of these rays sees.
    void add_seen(const RayThrough& ray_through, std::uint8_t bit, const tiling::Rect& part,
                  tiling::ImageView<std::uint8_t> out) const;

private:
    Landscape landscape_;
};

} // namespace hsgm::synth
