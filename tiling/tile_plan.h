#pragma once

#include "tiling/rect.h"

#include <cstdint>
#include <vector>

namespace hsgm::tiling {

/// Cuts a raster into tiles whose cores partition it: every pixel lies in exactly one core.
/// Tiles are numbered row by row; those at the right and lower edge may be smaller.
class TilePlan {
public:
    /// `tile_size_px` is the side of a tile; 0 means one tile for the whole raster.
    /// Throws std::invalid_argument for an empty raster or a negative tile size.
    TilePlan(Size raster, int tile_size_px);

    int count() const { return tile_rows_ * tile_cols_; }
    Size raster() const { return raster_; }
    Size tile_size() const { return tile_; }
    /// The pixels that tile `index` (0 <= index < count()) writes.
    Rect core(int index) const;

private:
    Size raster_;
    Size tile_;
    int tile_rows_;
    int tile_cols_;
};

/// The order in which tiles are visited. It never changes a result; other orders than
/// `rows` exist so that tests can show this.
enum class TileOrder { rows, columns, reversed, shuffled };

/// All tile numbers in the given order. `shuffled` is a fixed permutation for each `seed`,
/// the same on every machine.
std::vector<int> tile_sequence(const TilePlan& plan, TileOrder order, std::uint32_t seed = 0);

} // namespace hsgm::tiling
