#include "matcher/host/winner.h"

#include "matcher/kernel.h"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/winner.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The smallest lane: halves are folded down to 128 bits, where one instruction does it.
template <class D>
HWY_INLINE std::uint16_t least_lane(D d, hn::Vec<D> v)
{
    if constexpr (hn::MaxLanes(d) > 8) {
        const hn::Half<D> half;
        return least_lane(half, hn::Min(hn::UpperHalf(half, v), hn::LowerHalf(half, v)));
    } else {
        return hn::GetLane(hn::MinOfLanes(d, v));
    }
}

// Both planes of a pixel in vectors of kLanes; padding lanes become infinitely dear.
template <int kLanes>
struct Planes {
    using D = hn::CappedTag<std::uint16_t, kLanes>;
    using V = hn::Vec<D>;

    explicit Planes(const SumsRow& row)
        : half(row.stride / 2), count(static_cast<std::uint16_t>(row.count)),
          padded(row.count != row.stride), twice_iota(hn::Add(hn::Iota(D(), 0), hn::Iota(D(), 0)))
    {
    }

    // Calls body(sums, index of every lane) for all vectors of the pixel.
    template <class Body>
    HWY_INLINE void each(const std::uint16_t* sums, Body body) const
    {
        const D d;
        for (int i = 0; i < half; i += static_cast<int>(hn::Lanes(d))) {
            const auto even = hn::Add(twice_iota, hn::Set(d, static_cast<std::uint16_t>(2 * i)));
            const auto odd = hn::Add(even, hn::Set(d, std::uint16_t{1}));
            body(searched(hn::LoadU(d, sums + i), even), even);
            body(searched(hn::LoadU(d, sums + half + i), odd), odd);
        }
    }
    HWY_INLINE V searched(V sums, V index) const
    {
        const D d;
        const auto end = hn::Set(d, count);
        return padded ? hn::IfThenElse(hn::Eq(hn::Max(index, end), index),
                                       hn::Set(d, std::uint16_t{0xFFFF}), sums)
                      : sums;
    }

    int half;
    std::uint16_t count;
    bool padded;
    V twice_iota;
};

template <int kLanes>
HWY_INLINE Winner winner_of(const Planes<kLanes>& planes, const std::uint16_t* sums)
{
    using V = typename Planes<kLanes>::V;
    const typename Planes<kLanes>::D d;
    const auto infinite = hn::Set(d, std::uint16_t{0xFFFF});
    V least = infinite;
    planes.each(sums, [&](V s, V) HWY_ATTR { least = hn::Min(least, s); });
    const std::uint16_t sum = least_lane(d, least);
    const auto all = hn::Set(d, sum);
    V first = infinite;
    planes.each(sums, [&](V s, V index) HWY_ATTR {
        first = hn::Min(first, hn::IfThenElse(hn::Eq(s, all), index, infinite));
    });
    const std::uint16_t index = least_lane(d, first);
    // Lanes at index - 1 .. index + 1 are those whose distance from index - 1 is at most 2.
    const auto below = hn::Set(d, static_cast<std::uint16_t>(index - 1));
    const auto two = hn::Set(d, std::uint16_t{2});
    V rival = infinite;
    planes.each(sums, [&](V s, V at) HWY_ATTR {
        const auto distance = hn::Sub(at, below);
        const auto near = hn::Eq(hn::Min(distance, two), distance);
        rival = hn::Min(rival, hn::IfThenElse(near, infinite, s));
    });
    const bool lonely = index <= 1 && index + 2 >= planes.count;
    return {index, sum, lonely ? -1 : least_lane(d, rival)};
}

template <int kLanes>
void winners_in_lanes(const SumsRow& row, Winner* winners)
{
    const Planes<kLanes> planes(row);
    for (int col = 0; col < row.cols; ++col) {
        winners[col] = winner_of(planes, row.at(col));
    }
}

void winners(const SumsRow& row, Winner* out)
{
    if (row.stride % 64 == 0) {
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
        const auto x = hn::SaturatedSub(hn::LoadU(d, sums),
                                        hn::Set(d, static_cast<std::uint16_t>(least)));
        if constexpr (kPaths == 5) {
            // floor(x / 5) = x * 52429 >> 18 for every 16-bit x.
            return hn::Min(hn::ShiftRight<2>(hn::MulHigh(x, hn::Set(d, std::uint16_t{52429}))),
                           cap);
        } else {
            return hn::Min(hn::ShiftRight<kPaths == 4 ? 2 : kPaths == 8 ? 3 : 4>(x), cap);
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
template <class Planes>
HWY_INLINE void keep_less(const Planes& planes, const std::uint16_t* HWY_RESTRICT sums, int odd,
                          std::uint16_t pixel, std::uint16_t* HWY_RESTRICT least,
                          std::uint16_t* HWY_RESTRICT pixels)
{
    const typename Planes::D d;
    const auto mine = hn::Set(d, pixel);
    for (int i = 0; i < planes.half; i += static_cast<int>(hn::Lanes(d))) {
        const auto index =
            hn::Add(planes.twice_iota, hn::Set(d, static_cast<std::uint16_t>(2 * i + odd)));
        const auto s = planes.searched(hn::LoadU(d, sums + i), index);
        const auto old = hn::LoadU(d, least + i);
        const auto less = hn::Min(s, old);
        const auto stays = hn::Eq(less, old);
        hn::StoreU(less, d, least + i);
        hn::StoreU(hn::IfThenElse(stays, hn::LoadU(d, pixels + i), mine), d, pixels + i);
    }
}

template <int kLanes>
void merge_in_lanes(const SumsRow& row, const std::uint8_t* valid, int plane,
                    std::uint16_t* least, std::uint16_t* pixels)
{
    const Planes<kLanes> planes(row);
    const int half = row.stride / 2;
    for (int col = 0; col < row.cols; ++col) {
        if (valid[col] == 0) {
            continue;
        }
        // The even disparities meet every second right pixel from number `first` on.
        const int first = row.cols - 1 - col;
        const int even = (first % 2 != 0 ? plane : 0) + first / 2;
        const int odd = (first % 2 != 0 ? 0 : plane) + (first + 1) / 2;
        const auto pixel = static_cast<std::uint16_t>(col);
        keep_less(planes, row.at(col), 0, pixel, least + even, pixels + even);
        keep_less(planes, row.at(col) + half, 1, pixel, least + odd, pixels + odd);
    }
}

void merge(const SumsRow& row, const std::uint8_t* valid, int plane, std::uint16_t* least,
           std::uint16_t* pixels)
{
    if (row.stride % 64 == 0) {
        merge_in_lanes<32>(row, valid, plane, least, pixels);
    } else if (row.stride % 32 == 0) {
        merge_in_lanes<16>(row, valid, plane, least, pixels);
    } else {
        merge_in_lanes<8>(row, valid, plane, least, pixels);
    }
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(winners);
HWY_EXPORT(prior);
HWY_EXPORT(merge);

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
    half_ = (cols + stride) / 2 + 1;
    const auto size = 2 * static_cast<std::size_t>(half_);
    sums_ = sums_buffer_.need(size);
    pixels_ = pixels_buffer_.need(size);
    std::fill_n(sums_, size, std::uint16_t{0xFFFF});
    std::fill_n(pixels_, size, kNobody);
}

void RightCandidates::merge(const SumsRow& row, const std::uint8_t* valid)
{
    HWY_DYNAMIC_DISPATCH(merge)(row, valid, half_, sums_, pixels_);
}

} // namespace hsgm::matcher::host
#endif
