#pragma once

#include "matcher/host/directions.h"
#include "matcher/options.h"
#include "tiling/image.h"

#include <array>
#include <cstdint>

namespace hsgm::matcher::host {

/// P2' between every pixel and its neighbours (docs/algorithm.md, section 4), for path costs
/// of 8 bits. A path and its opposite pay the same between the same two pixels, so one map
/// serves both: four maps for eight directions.
class PenaltyMaps {
public:
    PenaltyMaps() = default;
    /// For the pixels of `area` and their predecessors, where both lie in `left_tone`.
    PenaltyMaps(const tiling::Patch<std::uint8_t>& left_tone, const tiling::Rect& area,
                const Options& options);

    /// P2' of the path of direction `r` (steps of at most one) at (row, col); the pixels to
    /// the right follow. Anything may be read where there is no predecessor.
    const std::uint8_t* at(Direction r, int row, int col) const
    {
        const bool opposite = r.row < 0 || (r.row == 0 && r.col < 0);
        const auto& map = maps_[axis(r)];
        return opposite ? &map.at(row - r.row, col - r.col) : &map.at(row, col);
    }

private:
    // (0,1) (1,0) (1,1) (1,-1) and their opposites.
    static std::size_t axis(Direction r)
    {
        if (r.row == 0) {
            return 0;
        }
        const int slant = r.row * r.col;
        return slant == 0 ? 1 : slant > 0 ? 2 : 3;
    }

    std::array<tiling::Patch<std::uint8_t>, 4> maps_;
};

} // namespace hsgm::matcher::host
