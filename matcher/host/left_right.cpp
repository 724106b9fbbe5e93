#include "matcher/host/left_right.h"

#include "matcher/kernel.h"
#include "matcher/reasons.h"

#include <algorithm>
#include <cstring>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/left_right.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef HSGM_LEFT_RIGHT_ROW
#define HSGM_LEFT_RIGHT_ROW
namespace hsgm::matcher::host {

// One row, its arrays readable to the end of the last vector.
struct LeftRightRow {
    const std::int32_t* disparity_q8;
    const std::uint16_t* reasons;
    int cols;
    int first_col;             // global column of the first pixel
    const std::uint32_t* keys; // of right columns key_begin..key_end - 1; at least one entry
    int key_begin;
    int key_end;
    int asked_min;
    int tolerance;
};

} // namespace hsgm::matcher::host
#endif

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Values where both views agree, else holes; suspects gets 1 where a value was lost.
// Returns whether there is any.
bool check_row(const LeftRightRow& row, std::int32_t* values, std::uint8_t* suspects)
{
    const hn::ScalableTag<std::int32_t> d;
    const hn::Rebind<std::uint32_t, decltype(d)> du;
    const hn::Rebind<std::uint16_t, decltype(d)> d16;
    const hn::Rebind<std::uint8_t, decltype(d)> d8;
    const auto hole = hn::Set(d, kHole);
    const auto begin = hn::Set(d, row.key_begin);
    const auto end = hn::Set(d, row.key_end);
    const auto bound = hn::Set(d, row.tolerance + 1);
    const auto none = hn::BitCast(d, hn::Set(du, kNoKey));
    const auto invalidating = hn::Set(d, kInvalidating);
    auto any = hn::Zero(d);
    for (int i = 0; i < row.cols; i += static_cast<int>(hn::Lanes(d))) {
        const auto value = hn::LoadU(d, row.disparity_q8 + i);
        const auto winner = hn::ShiftRight<8>(hn::Add(value, hn::Set(d, 127)));
        const auto bits = hn::PromoteTo(d, hn::LoadU(d16, row.reasons + i));
        const auto valid = hn::Eq(hn::And(bits, invalidating), hn::Zero(d));
        const auto counterpart = hn::Sub(hn::Iota(d, row.first_col + i), winner);
        const auto met = hn::AndNot(hn::Lt(counterpart, begin), hn::Lt(counterpart, end));
        const auto index = hn::IfThenElseZero(met, hn::Sub(counterpart, begin));
        const auto key =
            hn::GatherIndex(d, reinterpret_cast<const std::int32_t*>(row.keys), index);
        const auto theirs =
            hn::Add(hn::And(key, hn::Set(d, 0xFFFF)), hn::Set(d, row.asked_min));
        const auto close = hn::Lt(hn::Abs(hn::Sub(theirs, winner)), bound);
        const auto agrees = hn::And(hn::And(met, close), hn::Ne(key, none));
        hn::StoreU(hn::IfThenElse(hn::And(valid, agrees), value, hole), d, values + i);
        const auto lost = hn::IfThenElseZero(hn::AndNot(agrees, valid), hn::Set(d, 1));
        any = hn::Or(any, lost);
        hn::StoreU(hn::DemoteTo(d8, lost), d8, suspects + i);
    }
    return !hn::AllTrue(d, hn::Eq(any, hn::Zero(d)));
}

// Whether one of `count` right pixels from `first_col` on agrees with its disparity to the
// left pixel at `col`. A right pixel that nothing met holds a disparity that agrees with none.
bool agrees_anywhere(const std::uint32_t* keys, int count, int first_disparity, int asked_min,
                     int tolerance)
{
    const hn::ScalableTag<std::int32_t> d;
    const auto bound = hn::Set(d, tolerance + 1);
    const int lanes = static_cast<int>(hn::Lanes(d));
    int i = 0;
    for (; i + lanes <= count; i += lanes) {
        const auto key = hn::LoadU(d, reinterpret_cast<const std::int32_t*>(keys) + i);
        const auto theirs = hn::Add(hn::And(key, hn::Set(d, 0xFFFF)), hn::Set(d, asked_min));
        const auto ours = hn::Sub(hn::Set(d, first_disparity - i), hn::Iota(d, 0));
        if (!hn::AllFalse(d, hn::Lt(hn::Abs(hn::Sub(theirs, ours)), bound))) {
            return true;
        }
    }
    for (; i < count; ++i) {
        const int theirs = static_cast<int>(keys[i] & 0xFFFFU) + asked_min;
        if (std::abs(theirs - (first_disparity - i)) <= tolerance) {
            return true;
        }
    }
    return false;
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(check_row);
HWY_EXPORT(agrees_anywhere);

namespace {

using tiling::Patch;
using tiling::Rect;

// Of a pixel whose counterpart disagrees. Where its epipolar line meets the right view's
// surface somewhere it is a mismatch, otherwise occluded (Hirschmueller 2008, section 2.4).
Reason reason_of(int col, int winner, const std::uint32_t* keys, const Rect& key_rect,
                 const PairShape& shape, int tolerance)
{
    const int counterpart = col - winner;
    if (counterpart < 0 || counterpart >= shape.right.cols) {
        return kOutside;
    }
    const int first = std::max(key_rect.col, col - shape.asked.max);
    const int last = std::min(key_rect.col_end() - 1, col - shape.asked.min);
    const bool elsewhere =
        HWY_DYNAMIC_DISPATCH(agrees_anywhere)(keys + (first - key_rect.col), last - first + 1,
                                              col - first, shape.asked.min, tolerance);
    return elsewhere ? kInconsistent : kOccluded;
}

// Without a check: what has a value keeps it.
void keep_values(const Patch<std::int32_t>& disparity_q8, const Patch<std::uint16_t>& reasons,
                 DisparityPlane& plane)
{
    const Rect& part = plane.rect();
    for (int row = part.row; row < part.row_end(); ++row) {
        const std::uint16_t* bits = &reasons.at(row, part.col);
        const std::int32_t* values = &disparity_q8.at(row, part.col);
        std::int32_t* out = plane.at(row, part.col);
        for (int i = 0; i < part.cols; ++i) {
            out[i] = (bits[i] & kInvalidating) == 0 ? values[i] : kHole;
        }
    }
}

} // namespace

void check_left_right(const Patch<std::int32_t>& disparity_q8,
                      const Patch<std::uint32_t>& right_keys, const PairShape& shape,
                      int tolerance_px, const Rect& explained, Patch<std::uint16_t>& reasons,
                      DisparityPlane& plane)
{
    if (tolerance_px < 0) {
        keep_values(disparity_q8, reasons, plane);
        return;
    }
    const Rect& part = plane.rect();
    const Rect& met = right_keys.rect;
    const auto padded = static_cast<std::size_t>(part.cols + DisparityPlane::kFrameCols);
    std::vector<std::int32_t> values(padded);
    std::vector<std::uint16_t> bits(padded, kOutside);
    std::vector<std::uint8_t> suspects(padded);
    for (int row = part.row; row < part.row_end(); ++row) {
        std::copy_n(&disparity_q8.at(row, part.col), part.cols, values.data());
        std::uint16_t* of_row = &reasons.at(row, part.col);
        std::copy_n(of_row, part.cols, bits.data());
        const std::uint32_t* keys =
            met.empty() ? &kNoKey : right_keys.pixels.row(row - met.row);
        const LeftRightRow one{values.data(),
                               bits.data(),
                               part.cols,
                               part.col,
                               keys,
                               met.col,
                               met.empty() ? met.col : met.col_end(),
                               shape.asked.min,
                               tolerance_px};
        const bool any =
            HWY_DYNAMIC_DISPATCH(check_row)(one, plane.at(row, part.col), suspects.data());
        if (!any || row < explained.row || row >= explained.row_end()) {
            continue;
        }
        for (int i = explained.col - part.col; i < explained.col_end() - part.col; ++i) {
            const auto rest = static_cast<std::size_t>(explained.col_end() - part.col - i);
            const void* next = std::memchr(suspects.data() + i, 1, rest);
            if (next == nullptr) {
                break;
            }
            i = static_cast<int>(static_cast<const std::uint8_t*>(next) - suspects.data());
            const int winner = winner_of(values[std::size_t(i)]);
            of_row[i] = static_cast<std::uint16_t>(
                of_row[i] | reason_of(part.col + i, winner, keys, met, shape, tolerance_px));
        }
    }
}

} // namespace hsgm::matcher::host
#endif
