#include "matcher/host/census.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <vector>

namespace hsgm::matcher::host {

namespace {

using tiling::Patch;
using tiling::Rect;
using tiling::Size;

// The pixels of `area`, with replicated ones where it reaches outside the image.
Patch<std::uint16_t> padded(const Patch<std::uint16_t>& image, Size full, const Rect& area)
{
    Patch<std::uint16_t> result(area);
    for (int row = area.row; row < area.row_end(); ++row) {
        const int from_row = std::clamp(row, 0, full.rows - 1);
        std::uint16_t* to = &result.at(row, area.col);
        for (int col = area.col; col < area.col_end(); ++col) {
            *to++ = image.at(from_row, std::clamp(col, 0, full.cols - 1));
        }
    }
    return result;
}

// Bits are gathered in 16-bit words, as wide as the pixels, so that the compiler compares
// and shifts a full vector of them; four words make the 64 bits.
class CensusRow {
public:
    explicit CensusRow(int cols) : cols_(std::size_t(cols))
    {
        for (auto& word : words_) {
            word.resize(cols_);
        }
    }

    void compute(const Patch<std::uint16_t>& image, int row, int col, int radius_rows,
                 int radius_cols, std::uint64_t* result)
    {
        for (auto& word : words_) {
            std::fill(word.begin(), word.end(), std::uint16_t{0});
        }
        const std::uint16_t* centre = &image.at(row, col);
        int bit = 0;
        for (int dr = -radius_rows; dr <= radius_rows; ++dr) {
            for (int dc = -radius_cols; dc <= radius_cols; ++dc) {
                if (dr != 0 || dc != 0) {
                    add_bit(&image.at(row + dr, col + dc), centre,
                            words_[std::size_t(bit++ / 16)]);
                }
            }
        }
        for (std::size_t i = 0; i < cols_; ++i) {
            result[i] = std::uint64_t{words_[0][i]} | std::uint64_t{words_[1][i]} << 16 |
                        std::uint64_t{words_[2][i]} << 32 | std::uint64_t{words_[3][i]} << 48;
        }
    }

private:
    void add_bit(const std::uint16_t* neighbour, const std::uint16_t* centre,
                 std::vector<std::uint16_t>& word) const
    {
        std::uint16_t* w = word.data();
        for (std::size_t i = 0; i < cols_; ++i) {
            w[i] = static_cast<std::uint16_t>(w[i] << 1 | (neighbour[i] < centre[i] ? 1 : 0));
        }
    }

    std::size_t cols_;
    std::array<std::vector<std::uint16_t>, 4> words_;
};

} // namespace

Patch<std::uint64_t> census(const Patch<std::uint16_t>& image, Size full, int radius_rows,
                            int radius_cols, const Rect& area)
{
    Patch<std::uint64_t> result(area);
    if (area.empty()) {
        return result;
    }
    const auto source = padded(image, full,
                               {area.row - radius_rows, area.col - radius_cols,
                                area.rows + 2 * radius_rows, area.cols + 2 * radius_cols});
    tbb::parallel_for(tbb::blocked_range<int>(area.row, area.row_end(), 32),
                      [&](const tbb::blocked_range<int>& rows) {
                          CensusRow one(area.cols);
                          for (int row = rows.begin(); row < rows.end(); ++row) {
                              one.compute(source, row, area.col, radius_rows, radius_cols,
                                          &result.at(row, area.col));
                          }
                      });
    return result;
}

} // namespace hsgm::matcher::host
