#include "matcher/reduce.h"

#include "matcher/pixel.h"

#include <algorithm>
#include <array>
#include <vector>

namespace hsgm::matcher {

namespace {

constexpr std::array<unsigned, 4> kTaps{1, 3, 3, 1};

std::uint16_t reduced_pixel(const tiling::Patch<std::uint16_t>& fine, tiling::Size size,
                            int row, int col)
{
    unsigned sum = 0;
    unsigned weight = 0;
    for (int i = 0; i < 4; ++i) {
        const int r = std::clamp(2 * row - 1 + i, 0, size.rows - 1);
        for (int j = 0; j < 4; ++j) {
            const int c = std::clamp(2 * col - 1 + j, 0, size.cols - 1);
            const std::uint16_t pixel = fine.at(r, c);
            if (is_valid(pixel)) {
                const unsigned w = kTaps[std::size_t(i)] * kTaps[std::size_t(j)];
                sum += w * pixel;
                weight += w;
            }
        }
    }
    return weight == 0 ? kNodataPixel : static_cast<std::uint16_t>((sum + weight / 2) / weight);
}

// Columns of four rows, weighted 1-3-3-1; false if a pixel has no data.
bool weighted_columns(const std::array<const std::uint16_t*, 4>& rows, int cols,
                      std::uint32_t* sums)
{
    std::uint16_t greatest = 0;
    for (int i = 0; i < cols; ++i) {
        const std::uint16_t outer = std::max(rows[0][i], rows[3][i]);
        const std::uint16_t inner = std::max(rows[1][i], rows[2][i]);
        greatest = std::max(greatest, std::max(outer, inner));
        sums[i] = std::uint32_t{rows[0][i]} + rows[3][i] +
                  3 * (std::uint32_t{rows[1][i]} + rows[2][i]);
    }
    return is_valid(greatest);
}

// The coarse pixels [col, col + cols) of one row whose taps are all inside the image, where
// all those are valid: no weights to count, and loops without branches.
bool reduced_row(const tiling::Patch<std::uint16_t>& fine, tiling::Size size, int row, int col,
                 int cols, std::vector<std::uint32_t>& columns, std::uint16_t* out)
{
    const int first = 2 * col - 1;
    const int count = 2 * cols + 2;
    columns.resize(static_cast<std::size_t>(count));
    std::array<const std::uint16_t*, 4> rows{};
    for (int i = 0; i < 4; ++i) {
        rows[std::size_t(i)] = &fine.at(std::clamp(2 * row - 1 + i, 0, size.rows - 1), first);
    }
    if (!weighted_columns(rows, count, columns.data())) {
        return false;
    }
    const std::uint32_t* t = columns.data();
    for (int c = 0; c < cols; ++c) {
        const std::uint32_t sum = t[2 * c] + t[2 * c + 3] + 3 * (t[2 * c + 1] + t[2 * c + 2]);
        out[c] = static_cast<std::uint16_t>((sum + 32) >> 6);
    }
    return true;
}

} // namespace

void reduce(const tiling::Patch<std::uint16_t>& fine, tiling::Size fine_size,
            const tiling::Rect& coarse, tiling::ImageView<std::uint16_t> result)
{
    std::vector<std::uint32_t> columns;
    // Inside: 2 col - 1 >= 0 and 2 col + 2 < fine cols.
    const int begin = std::clamp(1, coarse.col, coarse.col_end());
    const int end = std::clamp((fine_size.cols - 1) / 2, begin, coarse.col_end());
    for (int r = 0; r < coarse.rows; ++r) {
        const int row = coarse.row + r;
        std::uint16_t* out = result.row(r);
        const bool done = end > begin && reduced_row(fine, fine_size, row, begin, end - begin,
                                                     columns, out + (begin - coarse.col));
        for (int col = coarse.col; col < coarse.col_end(); ++col) {
            if (done && col == begin) {
                col = end;
            }
            if (col < coarse.col_end()) {
                out[col - coarse.col] = reduced_pixel(fine, fine_size, row, col);
            }
        }
    }
}

} // namespace hsgm::matcher
