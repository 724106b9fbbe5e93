#include "pipeline/synth/overhead_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hsgm::synth {

namespace {

using tiling::Rect;

constexpr int kBlock = 16;  // px between the rays that are asked for
constexpr int kSamples = 4; // of a pixel, across and down
constexpr double kSeen_m = 0.01;

Ray mixed(const Ray& a, const Ray& b, double part)
{
    const auto mix = [part](double p, double q) { return p + part * (q - p); };
    return {mix(a.x, b.x), mix(a.y, b.y), mix(a.x_per_m, b.x_per_m), mix(a.y_per_m, b.y_per_m)};
}

/// The rays of a block of an image, between those of its corners.
class RayBlock {
public:
    RayBlock(const RayOfPixel& ray_of, int row, int col) : row_(row), col_(col)
    {
        for (int i = 0; i < 4; ++i) {
            corners_[static_cast<std::size_t>(i)] =
                ray_of(col - 0.5 + (i % 2) * kBlock, row - 0.5 + (i / 2) * kBlock);
        }
    }

    Ray at(double col, double row) const
    {
        const double right = (col - (col_ - 0.5)) / kBlock;
        const double down = (row - (row_ - 0.5)) / kBlock;
        return mixed(mixed(corners_[0], corners_[1], right),
                     mixed(corners_[2], corners_[3], right), down);
    }

    /// What of the map its rays pass between two heights.
    Area area(const DisparityBounds& heights_m) const
    {
        Area area{corners_[0].x, corners_[0].x, corners_[0].y, corners_[0].y};
        for (const Ray& ray : corners_) {
            for (const double height_m : {heights_m.min_px, heights_m.max_px}) {
                area.x_begin = std::min(area.x_begin, ray.x_at(height_m));
                area.x_end = std::max(area.x_end, ray.x_at(height_m));
                area.y_begin = std::min(area.y_begin, ray.y_at(height_m));
                area.y_end = std::max(area.y_end, ray.y_at(height_m));
            }
        }
        return area;
    }

private:
    int row_;
    int col_;
    std::array<Ray, 4> corners_; // upper left, upper right, lower left, lower right
};

double mean_brightness(const RayCaster& caster, const RayBlock& rays, int row, int col)
{
    double sum = 0;
    for (int i = 0; i < kSamples * kSamples; ++i) {
        const Ray ray = rays.at(col - 0.5 + (i % kSamples + 0.5) / kSamples,
                                row - 0.5 + (i / kSamples + 0.5) / kSamples);
        sum += caster.brightness(ray, caster.first_hit(ray));
    }
    return sum / (kSamples * kSamples);
}

// Calls visit(block) for the blocks of a fixed grid that cover a part, cut to it.
template <typename Visit>
void for_each_block(const Rect& part, Visit visit)
{
    const auto first = [](int v) { return tiling::floor_div(v, kBlock) * kBlock; };
    for (int row = first(part.row); row < part.row_end(); row += kBlock) {
        for (int col = first(part.col); col < part.col_end(); col += kBlock) {
            visit(Rect{row, col, kBlock, kBlock});
        }
    }
}

// Calls visit(row, col, ray) for the cells of a part of the map, seen from straight above.
template <typename Visit>
void for_each_cell(const Landscape& landscape, const Rect& part, Visit visit)
{
    for_each_block(part, [&](const Rect& block) {
        const Rect cells = intersect(block, part);
        const RayCaster caster(landscape, {cells.col - 1.0, cells.col_end() + 1.0,
                                           cells.row - 1.0, cells.row_end() + 1.0});
        for (int row = cells.row; row < cells.row_end(); ++row) {
            for (int col = cells.col; col < cells.col_end(); ++col) {
                visit(row, col, caster.first_hit({double(col), double(row), 0, 0}));
            }
        }
    });
}

} // namespace

void OverheadRenderer::render(const RayOfPixel& ray_of, const Camera& camera, const Rect& part,
                              tiling::ImageView<std::uint16_t> out) const
{
    for_each_block(part, [&](const Rect& block) {
        const RayBlock rays(ray_of, block.row, block.col);
        const RayCaster caster(landscape_, rays.area(landscape_.bounds()));
        const Rect pixels = intersect(block, part);
        for (int row = pixels.row; row < pixels.row_end(); ++row) {
            for (int col = pixels.col; col < pixels.col_end(); ++col) {
                out(row - part.row, col - part.col) =
                    camera.has_data(row, col)
                        ? camera.gray(mean_brightness(caster, rays, row, col), row, col)
                        : std::uint16_t{0};
            }
        }
    });
}

void OverheadRenderer::heights(const Rect& part, tiling::ImageView<float> out) const
{
    for_each_cell(landscape_, part, [&](int row, int col, const Hit& hit) {
        out(row - part.row, col - part.col) = static_cast<float>(hit.height_m);
    });
}

void OverheadRenderer::classes(const Rect& part, tiling::ImageView<std::uint8_t> out) const
{
    constexpr double kLow = 0.3; // of the contrast elsewhere
    for_each_cell(landscape_, part, [&](int row, int col, const Hit& hit) {
        const bool low = landscape_.contrast_scale(col, row) < kLow;
        const CellClass what = hit.surface != Surface::ground ? CellClass::object
                               : low                          ? CellClass::low_texture
                                                              : CellClass::ground;
        out(row - part.row, col - part.col) = static_cast<std::uint8_t>(what);
    });
}

void OverheadRenderer::add_seen(const RayThrough& ray_through, std::uint8_t bit,
                                const Rect& part, tiling::ImageView<std::uint8_t> out) const
{
    const DisparityBounds heights_m = landscape_.bounds();
    for_each_block(part, [&](const Rect& block) {
        const Rect cells = intersect(block, part);
        const double reach_m = heights_m.max_px - heights_m.min_px;
        const Ray typical = ray_through(cells.col, cells.row, heights_m.min_px);
        const double margin =
            2 + reach_m * 1.01 * std::max(std::abs(typical.x_per_m), std::abs(typical.y_per_m));
        const RayCaster caster(landscape_, {cells.col - margin, cells.col_end() + margin,
                                            cells.row - margin, cells.row_end() + margin});
        for_each_cell(landscape_, cells, [&](int row, int col, const Hit& top) {
            const Hit seen = caster.first_hit(ray_through(col, row, top.height_m));
            if (std::abs(seen.height_m - top.height_m) < kSeen_m) {
                out(row - part.row, col - part.col) |= bit;
            }
        });
    });
}

} // namespace hsgm::synth
