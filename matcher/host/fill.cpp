#include "matcher/host/fill.h"

#include "matcher/reasons.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace hsgm::matcher::host {

namespace {

using tiling::Patch;
using tiling::Rect;

constexpr std::uint16_t kMismatch = kInconsistent | kSpeckle | kUncertain;

// The nearest values in up to eight directions, sorted.
class Around {
public:
    void add(std::int32_t value)
    {
        std::size_t at = count_++;
        for (; at > 0 && values_[at - 1] > value; --at) {
            values_[at] = values_[at - 1];
        }
        values_[at] = value;
    }
    std::size_t count() const { return count_; }
    std::int32_t at(std::size_t rank) const { return values_[rank]; }

private:
    std::array<std::int32_t, 8> values_{};
    std::size_t count_ = 0;
};

// How many steps of -1, 0 or 1 stay inside begin..end - 1.
int steps_inside(int at, int step, int begin, int end, int most)
{
    const int room = step > 0 ? end - 1 - at : at - begin;
    return step == 0 ? most : std::min(room, most);
}

// Adds the first value on the way from a pixel, if there is one in reach.
void look(const Patch<std::int32_t>& disparity_q8, int row, int col, int row_step, int col_step,
          int reach_px, Around& around)
{
    const Rect& part = disparity_q8.rect;
    int steps = steps_inside(row, row_step, part.row, part.row_end(), reach_px);
    steps = steps_inside(col, col_step, part.col, part.col_end(), steps);
    const std::ptrdiff_t stride = std::ptrdiff_t{row_step} * part.cols + col_step;
    const std::int32_t* at = &disparity_q8.at(row, col);
    for (int i = 0; i < steps; ++i) {
        at += stride;
        if (*at != kHole) {
            around.add(*at);
            return;
        }
    }
}

Around look_around(const Patch<std::int32_t>& disparity_q8, int row, int col, int reach_px)
{
    Around around;
    for (int row_step = -1; row_step <= 1; ++row_step) {
        for (int col_step = -1; col_step <= 1; ++col_step) {
            if (row_step != 0 || col_step != 0) {
                look(disparity_q8, row, col, row_step, col_step, reach_px, around);
            }
        }
    }
    return around;
}

} // namespace

Patch<std::int32_t> filled(const Patch<std::int32_t>& disparity_q8, int reach_px,
                           bool mismatches, const Rect& wanted, Patch<std::uint16_t>& reasons)
{
    Patch<std::int32_t> result(wanted);
    for (int row = wanted.row; row < wanted.row_end(); ++row) {
        for (int col = wanted.col; col < wanted.col_end(); ++col) {
            std::int32_t& value = result.at(row, col);
            value = disparity_q8.at(row, col);
            std::uint16_t& bits = reasons.at(row, col);
            const bool occluded = (bits & kOccluded) != 0;
            if (value != kHole || !(occluded || (mismatches && (bits & kMismatch) != 0))) {
                continue;
            }
            const Around around = look_around(disparity_q8, row, col, reach_px);
            if (around.count() < 2) {
                continue;
            }
            value = around.at(occluded ? 1 : (around.count() - 1) / 2);
            bits = static_cast<std::uint16_t>((bits & ~kInvalidating) | kInterpolated);
        }
    }
    return result;
}

} // namespace hsgm::matcher::host
