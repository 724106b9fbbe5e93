#pragma once

#include "pipeline/synth/landscape.h"
#include "pipeline/synth/sensor.h"

#include "tiling/image.h"

#include <cstdint>

namespace hsgm::synth {

/// Renders a scene: two images, and the exact truth of each.
///
/// Any rectangle inside the images can be rendered on its own, at a cost proportional to
/// its area, and has the pixels that the whole would have. All methods are const and may be
/// called from any number of threads at once.
///
/// Images: a pixel is a square of 4 x 4 samples, which decide what surfaces it shows and in
/// which shares; each surface gives its brightness at the middle of its samples. Away from
/// edges that is the brightness at the pixel centre, so textures are sampled exactly and
/// edges are mixed. Truth belongs to the pixel centre alone.
class Renderer {
public:
    /// Throws std::invalid_argument where the scene is not valid.
    explicit Renderer(const Scene& scene);

    const Scene& scene() const { return scene_; }

    /// Bounds of all disparities (the search range of a matcher): nothing lies outside, but
    /// they need not be reached.
    DisparityBounds disparity_bounds() const { return landscape_.bounds(); }

    /// Gray levels 1..full scale; 0 = nodata. `out` has the size of `part`; a part that
    /// reaches outside the image throws std::invalid_argument, here and below.
    void render_left(const tiling::Rect& part, tiling::ImageView<std::uint16_t> out) const;
    void render_right(const tiling::Rect& part, tiling::ImageView<std::uint16_t> out) const;

    /// Disparity x_left - x_right of the surface at each pixel centre, in pixels; known
    /// everywhere, also under nodata.
    void truth_left(const tiling::Rect& part, tiling::ImageView<float> out) const;
    void truth_right(const tiling::Rect& part, tiling::ImageView<float> out) const;

    /// 255 where the point at the pixel centre shows in both images. 0 where the other view
    /// hides it behind something nearer, has it outside its frame (columns -0.5 to
    /// cols - 0.5), or where one of the two pixels is nodata.
    void visible_left(const tiling::Rect& part, tiling::ImageView<std::uint8_t> out) const;
    void visible_right(const tiling::Rect& part, tiling::ImageView<std::uint8_t> out) const;

private:
    void render(View view, const tiling::Rect& part,
                tiling::ImageView<std::uint16_t> out) const;
    void truth(View view, const tiling::Rect& part, tiling::ImageView<float> out) const;
    void visible(View view, const tiling::Rect& part,
                 tiling::ImageView<std::uint8_t> out) const;
    void truth_of_block(View view, const tiling::Rect& block,
                        tiling::ImageView<float> out) const;
    void visible_of_block(View view, const tiling::Rect& block,
                          tiling::ImageView<std::uint8_t> out) const;

    const Camera& camera(View view) const { return view == View::left ? left_ : right_; }

    Scene scene_;
    Landscape landscape_;
    Camera left_;
    Camera right_;
};

} // namespace hsgm::synth
