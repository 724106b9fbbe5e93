#pragma once

#include "tiling/image.h"

#include <array>
#include <cstdint>
#include <vector>

namespace hsgm::matcher::host {

/// The sparse census of one image, row by row (docs/algorithm.md, section 6, step 6): sixteen
/// bits a pixel, for the neighbours 1 and 3 px away in rows and columns, set where they are
/// darker. `image` must hold the rows asked for and the columns [col, col_end), grown by 3 px
/// and clipped to `full`, the size of the whole image, at whose borders neighbours are
/// replicated. Nodata neighbours are never darker. `image` must outlive this.
class SparseCensus {
public:
    static constexpr int kRadius = 3;

    SparseCensus(const tiling::Patch<std::uint16_t>& image, tiling::Size full, int col,
                 int col_end);

    /// Words of the row's pixels [col, col_end); writes up to 64 more behind them.
    void row(int row, std::uint16_t* words);

private:
    const tiling::Patch<std::uint16_t>& image_;
    tiling::Size full_;
    int col_;
    int cols_;
    std::array<std::vector<std::uint16_t>, 5> rows_; // -3, -1, 0, 1, 3, with 3 px on both sides
};

} // namespace hsgm::matcher::host
