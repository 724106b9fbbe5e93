#include "matcher/host/subpixel_row.h"

#include "matcher/host/disparity_plane.h"
#include "matcher/kernel.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>

// The instruction that counts bits in vectors is worth a target of its own here.
#define HWY_WANT_AVX3_DL
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/subpixel_row.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Wide = hn::ScalableTag<std::uint16_t>;
using Signed = hn::RebindToSigned<Wide>;
using Values = hn::Rebind<std::int32_t, hn::Half<Wide>>;

void winners_row(const std::int32_t* disparity_q8, int cols, std::int16_t* winners)
{
    const hn::ScalableTag<std::int32_t> d;
    const hn::Rebind<std::int16_t, decltype(d)> d16;
    for (int i = 0; i < cols; i += static_cast<int>(hn::Lanes(d))) {
        const auto value = hn::LoadU(d, disparity_q8 + i);
        const auto winner = hn::ShiftRight<8>(hn::Add(value, hn::Set(d, 127)));
        hn::StoreU(hn::DemoteTo(d16, winner), d16, winners + i); // saturates: kNoWinner
    }
}

// Pixels of one winner meet right pixels that follow each other.
HWY_INLINE void compare_together(const WordsRow& row, int i, int right,
                                 const std::array<std::uint16_t*, kComparisons>& bits)
{
    const Wide d;
    const auto word = hn::LoadU(d, row.left + i);
    const auto unknown = hn::Set(d, std::uint16_t{kNoCounterpartBits});
    for (int k = 0; k < kComparisons; ++k) {
        const int at = right + 2 - k;
        const auto differing = hn::PopulationCount(hn::Xor(word, hn::LoadU(d, row.right + at)));
        const auto valid = hn::Ne(hn::LoadU(d, row.right_valid + at), hn::Zero(d));
        hn::StoreU(hn::IfThenElse(valid, differing, unknown), d,
                   bits[static_cast<std::size_t>(k)] + i);
    }
}

HWY_INLINE void compare_alone(const WordsRow& row, int i, int right,
                              const std::array<std::uint16_t*, kComparisons>& bits)
{
    for (int k = 0; k < kComparisons; ++k) {
        const int at = right + 2 - k;
        const bool valid = at >= 0 && at < row.right_count && row.right_valid[at] != 0;
        const unsigned differing =
            valid ? static_cast<unsigned>(row.left[i] ^ row.right[at]) : 0;
        bits[static_cast<std::size_t>(k)][i] =
            static_cast<std::uint16_t>(valid ? std::popcount(differing) : kNoCounterpartBits);
    }
}

// Pixels begin..end - 1 share a winner. Vectors may reach beyond them: what follows is
// compared later.
HWY_INLINE void compare_run(const WordsRow& row, int begin, int end, int winner,
                            const std::array<std::uint16_t*, kComparisons>& bits)
{
    if (winner == kNoWinner) {
        return;
    }
    const Wide d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const int shift = row.first_col - winner - row.right_begin;
    for (int i = begin; i < end; i += lanes) {
        if (i + shift >= 2 && i + shift + 2 + lanes <= row.right_count) {
            compare_together(row, i, i + shift, bits);
            continue;
        }
        for (int j = i; j < std::min(i + lanes, end); ++j) {
            compare_alone(row, j, j + shift, bits);
        }
    }
}

void compare_row(const WordsRow& row, const std::int16_t* winners,
                 const std::array<std::uint16_t*, kComparisons>& bits)
{
    const hn::CappedTag<std::int16_t, 16> d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    int begin = 0;
    for (int i = 1; i < row.cols; i += lanes) {
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(d, hn::Ne(hn::LoadU(d, winners + i), hn::LoadU(d, winners + i - 1)),
                          bytes);
        std::uint64_t changes = 0;
        std::memcpy(&changes, bytes, sizeof changes);
        for (; changes != 0; changes &= changes - 1) {
            const int end = std::min(i + std::countr_zero(changes), row.cols);
            compare_run(row, begin, end, winners[begin], bits);
            begin = end;
        }
    }
    compare_run(row, begin, row.cols, winners[begin], bits);
}

struct Sums {
    hn::Vec<Wide> below;
    hn::Vec<Wide> at;
    hn::Vec<Wide> above;
};

// Adds the bits of pixels `step` columns away, whose winner differs by one at most: each
// shifted so that it speaks of the same three disparities.
HWY_INLINE void add_pixels(const ComparedRow& row, int at, hn::Vec<Signed> winner, Sums& sums)
{
    const Signed ds;
    const Wide d;
    const auto one = hn::Set(ds, std::int16_t{1});
    const auto step = hn::Sub(winner, hn::LoadU(ds, row.winners + at));
    const auto same = hn::RebindMask(d, hn::Eq(step, hn::Zero(ds)));
    const auto lower = hn::RebindMask(d, hn::Eq(step, one)); // than ours, by one
    const auto higher = hn::RebindMask(d, hn::Eq(step, hn::Neg(one)));
    const auto bits = [&](int k) HWY_ATTR {
        return hn::LoadU(d, row.bits[static_cast<std::size_t>(k)] + at);
    };
    const auto b0 = bits(0), b1 = bits(1), b2 = bits(2), b3 = bits(3), b4 = bits(4);
    const auto chosen = [&](auto if_higher, auto if_same, auto if_lower) HWY_ATTR {
        return hn::Or(
            hn::Or(hn::IfThenElseZero(same, if_same), hn::IfThenElseZero(lower, if_lower)),
            hn::IfThenElseZero(higher, if_higher));
    };
    sums.below = hn::Add(sums.below, chosen(b0, b1, b2));
    sums.at = hn::Add(sums.at, chosen(b1, b2, b3));
    sums.above = hn::Add(sums.above, chosen(b2, b3, b4));
}

// census_subpixel_q8 for one half of the lanes. Quotients of integers this small are exact
// to the floor in 32-bit floats.
HWY_INLINE hn::Vec<Values> value_of(hn::Vec<Values> value, hn::Vec<Values> rise_below,
                                    hn::Vec<Values> rise_above, const FractionRow& row)
{
    const Values d;
    const hn::RebindToFloat<Values> df;
    const auto full = hn::Set(d, 128);
    const auto winner = hn::ShiftRight<8>(hn::Add(value, hn::Set(d, 127)));
    const auto whole = hn::ShiftLeft<8>(winner);
    const auto before = hn::Sub(value, whole);
    const auto votes = hn::Set(d, kFractionVotes);
    const auto zero = hn::Zero(d);
    const auto a = hn::Add(hn::ShiftLeft<7>(rise_below),
                           hn::Mul(votes, hn::Add(full, hn::Min(before, zero))));
    const auto b = hn::Add(hn::ShiftLeft<7>(rise_above),
                           hn::Mul(votes, hn::Sub(full, hn::Max(before, zero))));
    const auto quotient =
        hn::ConvertTo(d, hn::Div(hn::ConvertTo(df, hn::ShiftLeft<7>(hn::Min(a, b))),
                                 hn::ConvertTo(df, hn::Max(a, b))));
    const auto offset = hn::Sub(full, quotient);
    const auto result = hn::IfThenElse(
        hn::Lt(a, b), hn::Sub(whole, hn::Min(offset, hn::Set(d, 127))), hn::Add(whole, offset));
    const auto inner = hn::And(hn::Gt(winner, hn::Set(d, row.asked_min)),
                               hn::Lt(winner, hn::Set(d, row.asked_max)));
    return hn::IfThenElse(inner, result, value); // a hole is beyond every asked disparity
}

void fractions_row(const FractionRow& row, std::int32_t* result_q8)
{
    const Wide d;
    const Signed ds;
    const Values d32;
    const hn::Half<Wide> half;
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int i = 0; i < row.cols; i += lanes) {
        const auto winner = hn::LoadU(ds, row.rows[1].winners + i);
        Sums sums{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
        for (const ComparedRow& r : row.rows) {
            for (int step = -3; step <= 3; step += 3) {
                add_pixels(r, i + step, winner, sums);
            }
        }
        const auto below = hn::SaturatedSub(sums.below, sums.at);
        const auto above = hn::SaturatedSub(sums.above, sums.at);
        const int middle = i + lanes / 2;
        hn::StoreU(value_of(hn::LoadU(d32, row.disparity_q8 + i),
                            hn::PromoteTo(d32, hn::LowerHalf(half, below)),
                            hn::PromoteTo(d32, hn::LowerHalf(half, above)), row),
                   d32, result_q8 + i);
        hn::StoreU(value_of(hn::LoadU(d32, row.disparity_q8 + middle),
                            hn::PromoteTo(d32, hn::UpperHalf(half, below)),
                            hn::PromoteTo(d32, hn::UpperHalf(half, above)), row),
                   d32, result_q8 + middle);
    }
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(winners_row);
HWY_EXPORT(compare_row);
HWY_EXPORT(fractions_row);

void compare_words(const WordsRow& row, const std::int16_t* winners,
                   const std::array<std::uint16_t*, kComparisons>& bits)
{
    HWY_DYNAMIC_DISPATCH(compare_row)(row, winners, bits);
}

void winners_of(const std::int32_t* disparity_q8, int cols, std::int16_t* winners)
{
    HWY_DYNAMIC_DISPATCH(winners_row)(disparity_q8, cols, winners);
}

void fractions(const FractionRow& row, std::int32_t* result_q8)
{
    HWY_DYNAMIC_DISPATCH(fractions_row)(row, result_q8);
}

} // namespace hsgm::matcher::host
#endif
