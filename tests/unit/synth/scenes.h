#pragma once

#include "pipeline/synth/renderer.h"

#include "tiling/image.h"

#include <cstdint>

// Scenes that several tests share, and whole images of them.
namespace hsgm::synth::testing {

inline Scene plane(double offset_px, double slope_x = 0, double slope_y = 0)
{
    Scene scene;
    scene.size = {40, 60};
    scene.terrain.offset_px = offset_px;
    scene.terrain.slope_x = slope_x;
    scene.terrain.slope_y = slope_y;
    return scene;
}

/// A town on hills with all that a scene can have.
inline Scene small_city()
{
    Scene scene;
    scene.size = {150, 700};
    scene.seed = 3;
    scene.bits = 12;
    scene.terrain.offset_px = 4;
    scene.terrain.slope_x = 0.01;
    scene.terrain.waves = {{3, 300, 20, 40}, {1, 90, 100, 0}};
    scene.city = City{};
    scene.city->cell_px = 64;
    scene.objects = {{Shape::ellipse, 350, 70, 60, 40, 30, 25, Roof::gable, 5, {}}};
    scene.low_texture = {{100, 10, 120, 60, 0.02}};
    scene.left.noise_gray = 8;
    scene.right = {0.9, 0.03, 1.1, 8, 2, {{300, 40, 12}}};
    return scene;
}

inline tiling::Image<std::uint16_t> image(const Renderer& r, View view)
{
    tiling::Image<std::uint16_t> out(r.scene().size);
    const tiling::Rect whole = tiling::rect_of(out.size());
    view == View::left ? r.render_left(whole, out) : r.render_right(whole, out);
    return out;
}

inline tiling::Image<float> truth(const Renderer& r, View view)
{
    tiling::Image<float> out(r.scene().size);
    const tiling::Rect whole = tiling::rect_of(out.size());
    view == View::left ? r.truth_left(whole, out) : r.truth_right(whole, out);
    return out;
}

inline tiling::Image<std::uint8_t> visible(const Renderer& r, View view)
{
    tiling::Image<std::uint8_t> out(r.scene().size);
    const tiling::Rect whole = tiling::rect_of(out.size());
    view == View::left ? r.visible_left(whole, out) : r.visible_right(whole, out);
    return out;
}

} // namespace hsgm::synth::testing
