#include "matcher/host/sum_results.h"

#include "matcher/host/sums.h"

#include <algorithm>

namespace hsgm::matcher::host {

namespace {

// Sums have 16 bits, so what is divided here has at most 24, which a float holds exactly;
// and the quotients, at most 256, differ from the next whole number by more than a float is
// rounded there. So dividing floats and dropping the fraction is the division of integers,
// but several at once.

// Offsets of the winner's neighbours, as `subpixel_q8` has them: a below, b above.
void subpixel_row(const float* a, const float* b, const std::int32_t* winner, int cols,
                  std::int32_t* disparity_q8)
{
    for (int i = 0; i < cols; ++i) {
        const float least = std::min(a[i], b[i]);
        const float most = std::max(a[i], b[i]);
        const auto x = static_cast<std::int32_t>(256.0F * least / std::max(most, 1.0F));
        const std::int32_t offset = most > 0.0F ? 128 - ((x * x + 256 * x) >> 10) : 0;
        disparity_q8[i] = winner[i] + (a[i] < b[i] ? -std::min(offset, 127) : offset);
    }
}

void confidence_row(const float* least, const float* rival, int cols, std::uint8_t* confidence)
{
    for (int i = 0; i < cols; ++i) {
        const auto c = static_cast<std::int32_t>(255.0F * (rival[i] - least[i]) /
                                                 std::max(rival[i], 1.0F));
        // A negative rival stands for none.
        confidence[i] = static_cast<std::uint8_t>(rival[i] < 0.0F ? 255 : std::max(c, 1));
    }
}

} // namespace

void sum_results(const SumsRow& row, const Winner* winners, int range_min,
                 Buffer<float>& workspace, std::int32_t* disparity_q8, std::uint8_t* confidence)
{
    const auto cols = static_cast<std::size_t>(row.cols);
    float* below = workspace.need(4 * cols);
    float* above = below + cols;
    float* least = above + cols;
    float* rival = least + cols;
    for (int i = 0; i < row.cols; ++i) {
        const Winner& w = winners[i];
        const std::uint16_t* sums = row.at(i);
        const bool inner = w.index > 0 && w.index + 1 < row.count;
        // Without two neighbours both offsets are 0, which leaves the winner as it is.
        below[i] =
            static_cast<float>(inner ? sum_at(sums, row.stride, w.index - 1) - w.sum : 0);
        above[i] =
            static_cast<float>(inner ? sum_at(sums, row.stride, w.index + 1) - w.sum : 0);
        least[i] = static_cast<float>(w.sum);
        rival[i] = static_cast<float>(w.rival);
        disparity_q8[i] = 256 * (range_min + w.index);
    }
    subpixel_row(below, above, disparity_q8, row.cols, disparity_q8);
    confidence_row(least, rival, row.cols, confidence);
}

} // namespace hsgm::matcher::host
