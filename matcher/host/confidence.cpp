#include "matcher/host/confidence.h"

#include "matcher/confidence.h"

#include <algorithm>
#include <array>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/confidence.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef HSGM_CONFIDENCE_ROW
#define HSGM_CONFIDENCE_ROW
namespace hsgm::matcher::host {

// Neighbours in eight directions at two distances.
constexpr int kNear = 2;
constexpr int kFar = 5;
// Margins are added over a square of five pixels a side.
constexpr int kMarginReach = 2;

// Rows of disparities round one, and the sums of the margins of every column over the rows of
// the square, from the column kMarginReach before the first pixel on.
struct ConfidenceRow {
    std::array<const std::int32_t*, 5> disparity_q8; // -kFar, -kNear, 0, kNear, kFar
    const std::uint16_t* margins;
    int cols;
};

} // namespace hsgm::matcher::host
#endif

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Adds the margins of pixels that have a value to the sums of their columns, or takes them
// off again.
void add_margins(const std::int32_t* disparity_q8, const std::uint8_t* margins, int cols,
                 bool take_off, std::uint16_t* sums)
{
    const hn::ScalableTag<std::int32_t> d;
    const hn::Rebind<std::uint8_t, decltype(d)> d8;
    const hn::Rebind<std::uint16_t, decltype(d)> d16;
    const auto hole = hn::Set(d, kHole);
    for (int i = 0; i < cols; i += static_cast<int>(hn::Lanes(d))) {
        const auto has_value = hn::Ne(hn::LoadU(d, disparity_q8 + i), hole);
        const auto margin = hn::DemoteTo(
            d16, hn::IfThenElseZero(has_value, hn::PromoteTo(d, hn::LoadU(d8, margins + i))));
        const auto sum = hn::LoadU(d16, sums + i);
        hn::StoreU(take_off ? hn::Sub(sum, margin) : hn::Add(sum, margin), d16, sums + i);
    }
}

// Scores of all pixels; of holes, too, where they mean nothing.
void score_row(const ConfidenceRow& row, std::uint16_t* scores)
{
    const hn::ScalableTag<std::int32_t> d;
    const hn::Rebind<std::uint16_t, decltype(d)> d16;
    const auto close = hn::Set(d, kCloseSupport_q8 + 1);
    const auto wide = hn::Set(d, kWideSupport_q8 + 1);
    for (int i = 0; i < row.cols; i += static_cast<int>(hn::Lanes(d))) {
        const auto centre = hn::LoadU(d, row.disparity_q8[2] + i);
        auto support = hn::Zero(d);
        const auto look_at = [&](const std::int32_t* neighbour) HWY_ATTR {
            const auto apart = hn::Abs(hn::Sub(hn::LoadU(d, neighbour + i), centre));
            support = hn::Sub(support, hn::VecFromMask(d, hn::Lt(apart, close)));
            support = hn::Sub(support, hn::VecFromMask(d, hn::Lt(apart, wide)));
        };
        for (const int step : {-kFar, 0, kFar}) {
            look_at(row.disparity_q8[0] + step);
            look_at(row.disparity_q8[4] + step);
        }
        for (const int step : {-kNear, 0, kNear}) {
            look_at(row.disparity_q8[1] + step);
            look_at(row.disparity_q8[3] + step);
        }
        for (const int step : {-kFar, -kNear, kNear, kFar}) {
            look_at(row.disparity_q8[2] + step);
        }
        auto margin = hn::Zero(d16);
        for (int step = 0; step <= 2 * kMarginReach; ++step) {
            margin = hn::Add(margin, hn::LoadU(d16, row.margins + i + step));
        }
        const auto score =
            hn::Add(hn::Mul(support, hn::Set(d, kSupportWeight)), hn::PromoteTo(d, margin));
        hn::StoreU(hn::DemoteTo(d16, score), d16, scores + i);
    }
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(add_margins);
HWY_EXPORT(score_row);

namespace {

using tiling::Patch;
using tiling::Rect;

constexpr int kPad = 64; // elements that vectors may touch beyond the last one

// Sums of margins over the rows of a square, which moves down row by row.
class MarginColumns {
public:
    // The square's centre begins one row above those wanted.
    MarginColumns(const DisparityPlane& disparities, const Patch<std::uint8_t>& margins,
                  const Rect& wanted)
        : disparities_(disparities), margins_(margins),
          area_(intersect(expand(wanted, kMarginReach + 1), margins.rect)),
          first_(area_.col - (wanted.col - kMarginReach - 1)),
          sums_(std::size_t(wanted.cols + 2 * kMarginReach + 2 + kPad)),
          margin_row_(std::size_t(area_.cols + kPad)), centre_(wanted.row - 1)
    {
        for (int row = centre_ - kMarginReach; row <= centre_ + kMarginReach; ++row) {
            change(row, false);
        }
    }

    // One row down; the sums from the column kMarginReach before the first one wanted on.
    const std::uint16_t* next()
    {
        change(centre_ - kMarginReach, true);
        ++centre_;
        change(centre_ + kMarginReach, false);
        return sums_.data() + 1;
    }

private:
    void change(int row, bool take_off)
    {
        if (row < area_.row || row >= area_.row_end()) {
            return;
        }
        std::copy_n(&margins_.at(row, area_.col), area_.cols, margin_row_.data());
        HWY_DYNAMIC_DISPATCH(add_margins)
        (disparities_.at(row, area_.col), margin_row_.data(), area_.cols, take_off,
         sums_.data() + first_);
    }

    const DisparityPlane& disparities_;
    const Patch<std::uint8_t>& margins_;
    Rect area_;
    int first_; // of sums_ that a column of area_ has
    std::vector<std::uint16_t> sums_;
    std::vector<std::uint8_t> margin_row_;
    int centre_;
};

} // namespace

Patch<std::uint8_t> confidences(const DisparityPlane& disparities,
                                const Patch<std::uint8_t>& margins, const Rect& wanted)
{
    Patch<std::uint8_t> result(wanted);
    MarginColumns columns(disparities, margins, wanted);
    std::vector<std::uint16_t> scores(std::size_t(wanted.cols + kPad));
    for (int row = wanted.row; row < wanted.row_end(); ++row) {
        const auto at = [&](int step) { return disparities.at(row + step, wanted.col); };
        HWY_DYNAMIC_DISPATCH(score_row)
        ({{at(-kFar), at(-kNear), at(0), at(kNear), at(kFar)}, columns.next(), wanted.cols},
         scores.data());
        const std::int32_t* values = at(0);
        std::uint8_t* out = result.pixels.row(row - wanted.row);
        for (int i = 0; i < wanted.cols; ++i) {
            const auto score = static_cast<std::size_t>(scores[std::size_t(i)] >> 9);
            out[i] = values[i] == kHole ? std::uint8_t{0} : kConfidenceOfScore[score];
        }
    }
    return result;
}

} // namespace hsgm::matcher::host
#endif
