#include "matcher/reduce.h"

#include "matcher/pixel.h"

#include <algorithm>
#include <array>

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

} // namespace

void reduce(const tiling::Patch<std::uint16_t>& fine, tiling::Size fine_size,
            const tiling::Rect& coarse, tiling::ImageView<std::uint16_t> result)
{
    for (int r = 0; r < coarse.rows; ++r) {
        for (int c = 0; c < coarse.cols; ++c) {
            result(r, c) = reduced_pixel(fine, fine_size, coarse.row + r, coarse.col + c);
        }
    }
}

} // namespace hsgm::matcher
