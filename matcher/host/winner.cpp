#include "matcher/host/winner.h"

#include "matcher/kernel.h"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/winner.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After Highway: compiled once for every target.
#include "matcher/host/sweep_step-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

// A pixel's sums in 2 * kVectors vectors of kLanes, first those of the even indices. What
// pads them is as dear as a sum can be and comes last, so it neither wins nor is the only
// rival.
template <int kLanes, int kVectors>
class PixelWinner {
    using D = hn::CappedTag<std::uint16_t, kLanes>;
    using V = hn::Vec<D>;
    static constexpr int kN = int(hn::MaxLanes(D()));

public:
    explicit PixelWinner(const SumsRow& row)
        : half_(row.stride / 2), count_(row.count), vectors_(row.stride / 2 / kN)
    {
    }

    HWY_INLINE Winner of(const std::uint16_t* sums) const
    {
        const D d;
        const auto infinite = hn::Set(d, std::uint16_t{0xFFFF});
        V least = infinite;
        for (int v = 0; v < vectors(); ++v) {
            least = hn::Min(least, hn::Min(even(sums, v), odd(sums, v)));
        }
        const std::uint16_t sum = least_lane(d, least);
        const auto all = hn::Set(d, sum);
        V first = infinite;
        for (int v = 0; v < vectors(); ++v) {
            first = hn::Min(first, where(hn::Eq(even(sums, v), all), index(v, 0)));
            first = hn::Min(first, where(hn::Eq(odd(sums, v), all), index(v, 1)));
        }
        const std::uint16_t winner = least_lane(d, first);
        V rival = infinite;
        for (int v = 0; v < vectors(); ++v) {
            rival = hn::Min(rival, far_from(winner, even(sums, v), index(v, 0)));
            rival = hn::Min(rival, far_from(winner, odd(sums, v), index(v, 1)));
        }
        const bool lonely = winner <= 1 && winner + 2 >= count_;
        return {winner, sum, lonely ? -1 : least_lane(d, rival)};
    }

private:
    HWY_INLINE int vectors() const { return kVectors > 0 ? kVectors : vectors_; }
    HWY_INLINE V even(const std::uint16_t* sums, int v) const
    {
        return hn::LoadU(D(), sums + v * kN);
    }
    HWY_INLINE V odd(const std::uint16_t* sums, int v) const
    {
        return hn::LoadU(D(), sums + half_ + v * kN);
    }
    // The disparity index of every lane.
    HWY_INLINE V index(int v, int odd) const
    {
        const D d;
        const auto lane = hn::Iota(d, 0);
        return hn::Add(hn::Add(lane, lane),
                       hn::Set(d, static_cast<std::uint16_t>(2 * v * kN + odd)));
    }
    template <class M>
    HWY_INLINE V where(M mask, V value) const
    {
        return hn::IfThenElse(mask, value, hn::Set(D(), std::uint16_t{0xFFFF}));
    }
    // The sums two or more away from the winner: lanes at most one away are those whose
    // distance from the one below it is 0, 1 or 2.
    HWY_INLINE V far_from(std::uint16_t winner, V sums, V at) const
    {
        const D d;
        const auto distance = hn::Sub(at, hn::Set(d, static_cast<std::uint16_t>(winner - 1)));
        const auto near = hn::Eq(hn::Min(distance, hn::Set(d, std::uint16_t{2})), distance);
        return hn::Or(sums, hn::VecFromMask(d, near));
    }

    int half_;
    int count_;
    int vectors_;
};

template <int kLanes, int kVectors>
void winners_of_row(const SumsRow& row, Winner* winners)
{
    const PixelWinner<kLanes, kVectors> winner(row);
    for (int col = 0; col < row.cols; ++col) {
        winners[col] = winner.of(row.at(col));
    }
}

template <int kLanes>
void winners_in_lanes(const SumsRow& row, Winner* winners)
{
    const hn::CappedTag<std::uint16_t, kLanes> d;
    switch (row.stride / 2 / static_cast<int>(hn::Lanes(d))) {
    case 1:
        return winners_of_row<kLanes, 1>(row, winners);
    case 2:
        return winners_of_row<kLanes, 2>(row, winners);
    case 3:
        return winners_of_row<kLanes, 3>(row, winners);
    case 4:
        return winners_of_row<kLanes, 4>(row, winners);
    default:
        return winners_of_row<kLanes, 0>(row, winners);
    }
}

void winners(const SumsRow& row, Winner* out)
{
    if (row.stride % 64 == 0 && row.stride > 128) {
        winners_in_lanes<32>(row, out);
    } else if (row.stride % 32 == 0) {
        winners_in_lanes<16>(row, out);
    } else {
        winners_in_lanes<8>(row, out);
    }
}

// (s - least) / kPaths, capped: the even plane becomes the low bytes, the odd one the high
// ones, which is natural order.
template <int kLanes, int kPaths>
void prior_in_lanes(const SumsRow& row, const Winner* winners, std::uint8_t* prior)
{
    const hn::CappedTag<std::uint16_t, kLanes> d;
    const hn::Repartition<std::uint8_t, decltype(d)> d8;
    const auto cap = hn::Set(d, std::uint16_t{kPriorCap});
    const int half = row.stride / 2;
    const auto quotient = [&](const std::uint16_t* sums, int least) HWY_ATTR {
        const auto x =
            hn::SaturatedSub(hn::LoadU(d, sums), hn::Set(d, static_cast<std::uint16_t>(least)));
        if constexpr (kPaths == 5) {
            // floor(x / 5) = x * 52429 >> 18 for every 16-bit x.
            return hn::Min(hn::ShiftRight<2>(hn::MulHigh(x, hn::Set(d, std::uint16_t{52429}))),
                           cap);
        } else {
            return hn::Min(hn::ShiftRight < kPaths == 4 ? 2 : kPaths == 8 ? 3 : 4 > (x), cap);
        }
    };
    for (int col = 0; col < row.cols; ++col, prior += row.stride) {
        const std::uint16_t* sums = row.at(col);
        for (int i = 0; i < half; i += static_cast<int>(hn::Lanes(d))) {
            const auto even = quotient(sums + i, winners[col].sum);
            const auto odd = quotient(sums + half + i, winners[col].sum);
            hn::StoreU(hn::BitCast(d8, hn::Or(even, hn::ShiftLeft<8>(odd))), d8, prior + 2 * i);
        }
    }
}

template <int kPaths>
void prior_of_paths(const SumsRow& row, const Winner* winners, std::uint8_t* prior)
{
    if (row.stride % 32 == 0) {
        prior_in_lanes<16, kPaths>(row, winners, prior);
    } else {
        prior_in_lanes<8, kPaths>(row, winners, prior);
    }
}

void prior(const SumsRow& row, const Winner* winners, int paths, std::uint8_t* out)
{
    switch (paths) {
    case 4:
        return prior_of_paths<4>(row, winners, out);
    case 5:
        return prior_of_paths<5>(row, winners, out);
    case 8:
        return prior_of_paths<8>(row, winners, out);
    default:
        return prior_of_paths<16>(row, winners, out);
    }
}

// Keeps the lesser sums of one plane of a pixel, and whose they are.
template <int kLanes, bool kPadded>
class RightMerge {
    using D = hn::CappedTag<std::uint16_t, kLanes>;

public:
    explicit RightMerge(const SumsRow& row)
        : half_(row.stride / 2), end_(hn::Set(D(), static_cast<std::uint16_t>(row.count)))
    {
    }

    HWY_INLINE void plane(const std::uint16_t* HWY_RESTRICT sums, int odd, std::uint16_t pixel,
                          std::uint16_t* HWY_RESTRICT least,
                          std::uint16_t* HWY_RESTRICT pixels) const
    {
        const D d;
        const auto mine = hn::Set(d, pixel);
        for (int i = 0; i < half_; i += static_cast<int>(hn::Lanes(d))) {
            const auto s = searched(hn::LoadU(d, sums + i), 2 * i + odd);
            const auto old = hn::LoadU(d, least + i);
            const auto less = hn::Min(s, old);
            const auto stays = hn::Eq(less, old);
            hn::StoreU(less, d, least + i);
            hn::StoreU(hn::IfThenElse(stays, hn::LoadU(d, pixels + i), mine), d, pixels + i);
        }
    }

private:
    // Padding must not stand for a right pixel: there it is infinitely dear.
    HWY_INLINE hn::Vec<D> searched(hn::Vec<D> sums, int first) const
    {
        if constexpr (!kPadded) {
            return sums;
        } else {
            const D d;
            const auto lane = hn::Iota(d, 0);
            const auto index =
                hn::Add(hn::Add(lane, lane), hn::Set(d, static_cast<std::uint16_t>(first)));
            return hn::Or(sums, hn::VecFromMask(d, hn::Eq(hn::Max(index, end_), index)));
        }
    }

    int half_;
    hn::Vec<D> end_;
};

// Neighbouring pixels write over one another by one lane, and reading what was just written
// at another place takes the processor long: the two halves of the row take turns, each with
// candidates of its own.
template <int kLanes, bool kPadded>
void merge_row(const SumsRow& row, const std::uint8_t* valid, const CandidatePlanes& left,
               const CandidatePlanes& right)
{
    const RightMerge<kLanes, kPadded> merge(row);
    const auto pixel = [&](int col, const CandidatePlanes& to) HWY_ATTR {
        if (valid[col] != 0) {
            // The even disparities meet every second right pixel from number `first` on.
            const int first = row.cols - 1 - col;
            const int even = (first % 2 != 0 ? to.plane : 0) + first / 2;
            const int odd = (first % 2 != 0 ? 0 : to.plane) + (first + 1) / 2;
            const auto number = static_cast<std::uint16_t>(col);
            merge.plane(row.at(col), 0, number, to.sums + even, to.pixels + even);
            merge.plane(row.at(col) + row.stride / 2, 1, number, to.sums + odd,
                        to.pixels + odd);
        }
    };
    const int half = row.cols / 2;
    for (int col = 0; col < half; ++col) {
        pixel(col, left);
        pixel(half + col, right);
    }
    if (row.cols % 2 != 0) {
        pixel(row.cols - 1, right);
    }
    // Of equal sums the left half's stays.
    for (int i = 0; i < 2 * left.plane; ++i) {
        const bool stays = left.sums[i] <= right.sums[i];
        left.pixels[i] = stays ? left.pixels[i] : right.pixels[i];
        left.sums[i] = stays ? left.sums[i] : right.sums[i];
    }
}

// Lowers four keys by those whose low and high halves lie side by side, in falling order.
HWY_INLINE void lower_four(hn::Vec<hn::FixedTag<std::uint16_t, 8>> halves, std::uint32_t* keys)
{
    const hn::FixedTag<std::uint32_t, 4> d;
    const auto mine = hn::Reverse(d, hn::BitCast(d, halves));
    hn::StoreU(hn::Min(hn::LoadU(d, keys), mine), d, keys);
}

// Eight candidates: sums and pixels of the numbers from `first` on, in order.
HWY_INLINE void lower_eight(hn::Vec<hn::FixedTag<std::uint16_t, 8>> sums,
                            hn::Vec<hn::FixedTag<std::uint16_t, 8>> pixels, int first,
                            std::uint32_t* keys)
{
    const hn::FixedTag<std::uint16_t, 8> d;
    const auto nobody =
        hn::VecFromMask(d, hn::Eq(pixels, hn::Set(d, RightCandidates::kNobody)));
    const auto number = hn::Add(hn::Iota(d, 0), hn::Set(d, static_cast<std::uint16_t>(first)));
    const auto low = hn::Or(hn::Add(number, pixels), nobody);
    const auto high = hn::Or(sums, nobody);
    lower_four(hn::InterleaveLower(d, low, high), keys - 3);
    lower_four(hn::InterleaveUpper(d, low, high), keys - 7);
}

// Whole vectors of candidates from the even number `begin` on; returns the first number left.
int lower_keys(const CandidatePlanes& from, int begin, int end, int offset, std::uint32_t* keys)
{
    const hn::FixedTag<std::uint16_t, 8> d;
    int j = begin;
    for (; j + 16 <= end; j += 16, keys -= 16) {
        const auto even_sums = hn::LoadU(d, from.sums + j / 2);
        const auto odd_sums = hn::LoadU(d, from.sums + from.plane + j / 2);
        const auto even_pixels = hn::LoadU(d, from.pixels + j / 2);
        const auto odd_pixels = hn::LoadU(d, from.pixels + from.plane + j / 2);
        lower_eight(hn::InterleaveLower(d, even_sums, odd_sums),
                    hn::InterleaveLower(d, even_pixels, odd_pixels), j + offset, keys);
        lower_eight(hn::InterleaveUpper(d, even_sums, odd_sums),
                    hn::InterleaveUpper(d, even_pixels, odd_pixels), j + 8 + offset, keys - 8);
    }
    return j;
}

template <int kLanes>
void merge_in_lanes(const SumsRow& row, const std::uint8_t* valid, const CandidatePlanes& left,
                    const CandidatePlanes& right)
{
    if (row.count == row.stride) {
        merge_row<kLanes, false>(row, valid, left, right);
    } else {
        merge_row<kLanes, true>(row, valid, left, right);
    }
}

void merge(const SumsRow& row, const std::uint8_t* valid, const CandidatePlanes& left,
           const CandidatePlanes& right)
{
    if (row.stride % 64 == 0 && row.stride > 128) {
        merge_in_lanes<32>(row, valid, left, right);
    } else if (row.stride % 32 == 0) {
        merge_in_lanes<16>(row, valid, left, right);
    } else {
        merge_in_lanes<8>(row, valid, left, right);
    }
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(winners);
HWY_EXPORT(prior);
HWY_EXPORT(merge);
HWY_EXPORT(lower_keys);

void find_winners(const SumsRow& row, Winner* out)
{
    HWY_DYNAMIC_DISPATCH(winners)(row, out);
}

void prior_row(const SumsRow& row, const Winner* winners, int paths, std::uint8_t* out)
{
    HWY_DYNAMIC_DISPATCH(prior)(row, winners, paths, out);
}

void RightCandidates::clear(int cols, int stride)
{
    const int plane = (cols + stride) / 2 + 1;
    const auto size = 4 * static_cast<std::size_t>(plane);
    std::uint16_t* sums = sums_.need(size);
    std::uint16_t* pixels = pixels_.need(size);
    std::fill_n(sums, size, std::uint16_t{0xFFFF});
    std::fill_n(pixels, size, kNobody);
    left_ = {plane, sums, pixels};
    right_ = {plane, sums + size / 2, pixels + size / 2};
}

void RightCandidates::merge(const SumsRow& row, const std::uint8_t* valid)
{
    HWY_DYNAMIC_DISPATCH(merge)(row, valid, left_, right_);
}

void RightCandidates::lower_keys(int begin, int end, int offset, std::uint32_t* keys) const
{
    const auto one = [&](int j) {
        const auto at = static_cast<std::size_t>((j % 2 != 0 ? left_.plane : 0) + j / 2);
        const std::uint32_t pixel = left_.pixels[at];
        const auto low = static_cast<std::uint16_t>(j + offset + int(pixel));
        if (pixel != kNobody) {
            std::uint32_t& key = keys[-(j - begin)];
            key = std::min(key, std::uint32_t{left_.sums[at]} << 16 | low);
        }
    };
    int j = begin;
    if (j % 2 != 0 && j < end) {
        one(j++);
    }
    j = HWY_DYNAMIC_DISPATCH(lower_keys)(left_, j, end, offset, keys - (j - begin));
    for (; j < end; ++j) {
        one(j);
    }
}

} // namespace hsgm::matcher::host
#endif
