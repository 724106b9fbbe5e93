#include "matcher/host/penalty_maps.h"

#include "matcher/kernel.h"

#include <tbb/parallel_for.h>

#include <cstdlib>

namespace hsgm::matcher::host {

PenaltyMaps::PenaltyMaps(const tiling::Patch<std::uint8_t>& left_tone, const tiling::Rect& area,
                         const Options& options)
{
    std::array<std::uint8_t, 256> p2{};
    for (int a = 0; a < 256; ++a) {
        p2[std::size_t(a)] = static_cast<std::uint8_t>(
            p2_gradient(options.p1, options.p2, options.p2_half_tone, a));
    }
    constexpr std::array<Direction, 4> kAxes{{{0, 1}, {1, 0}, {1, 1}, {1, -1}}};
    for (std::size_t i = 0; i < kAxes.size(); ++i) {
        const Direction r = kAxes[i];
        const tiling::Rect map_area = expand(area, 1);
        maps_[i] = tiling::Patch<std::uint8_t>(map_area);
        const tiling::Rect tone = left_tone.rect;
        const tiling::Rect both =
            intersect(intersect(map_area, tone),
                      {tone.row + r.row, tone.col + r.col, tone.rows, tone.cols});
        tbb::parallel_for(both.row, both.row_end(), [&](int row) {
            const std::uint8_t* here = &left_tone.at(row, both.col);
            const std::uint8_t* before = &left_tone.at(row - r.row, both.col - r.col);
            std::uint8_t* out = &maps_[i].at(row, both.col);
            for (int c = 0; c < both.cols; ++c) {
                out[c] = p2[std::size_t(std::abs(here[c] - before[c]))];
            }
        });
    }
}

} // namespace hsgm::matcher::host
