#pragma once

#include "matcher/cuda/packed.cuh"
#include "matcher/cuda/solve_job.h"

// How the features of a left pixel and two right ones become two matching costs, in both halves
// of a word (docs/algorithm.md, section 3).
namespace hsgm::matcher::cuda {

/// Bits that differ, in both halves.
template <typename F>
__device__ unsigned differing_bits(const F& left, const F& low, const F& high)
{
    const int low_bits = __popc(left.x ^ low.x) + __popc(left.y ^ low.y);
    const int high_bits = __popc(left.x ^ high.x) + __popc(left.y ^ high.y);
    return static_cast<unsigned>(high_bits * 0x10000 + low_bits);
}

/// Hamming distance of census words.
struct CensusCost {
    unsigned scale;
    unsigned most;

    __device__ unsigned operator()(Feature left, Feature low, Feature high) const
    {
        return lesser(differing_bits(left, low, high) * scale, pair_of(most));
    }
};

/// Census bits and the difference of tones: census_ad.
struct CensusToneCost {
    unsigned most;

    __device__ unsigned one(Feature left, Feature right) const
    {
        const int a = static_cast<int>(left.y & 0xFFU) - static_cast<int>(right.y & 0xFFU);
        const int bits = __popc(left.x ^ right.x);
        return least_of(static_cast<unsigned>(2 * bits + least_of(a < 0 ? -a : a, 24) / 2),
                        most);
    }
    __device__ unsigned operator()(Feature left, Feature low, Feature high) const
    {
        return one(left, low) | one(left, high) << 16;
    }
};

/// A table by the tones of both pixels: HMI.
struct TableCost {
    const std::uint8_t* table;

    __device__ unsigned operator()(Feature left, Feature low, Feature high) const
    {
        return __ldg(table + (left.x << 8 | low.x)) |
               static_cast<unsigned>(__ldg(table + (left.x << 8 | high.x))) << 16;
    }
};

/// Two values in halves, and the least and largest of them within half a pixel; under 256.
struct Samples {
    unsigned value;
    unsigned least;
    unsigned most;
};

/// How far each value of either lies outside what the other one's may be, the smaller of both
/// (Birchfield and Tomasi 1998).
__device__ __forceinline__ unsigned sampling_difference(const Samples& left,
                                                        const Samples& right)
{
    // Negative differences below it, so that no half borrows from the other.
    constexpr unsigned kNone = 0x01000100;
    const unsigned of_left =
        lesser(kNone + right.most - left.value, kNone + left.value - right.least, kNone);
    const unsigned of_right =
        lesser(kNone + left.most - right.value, kNone + right.value - left.least, kNone);
    const unsigned greater = of_left + of_right - lesser(of_left, of_right);
    return kNone - greater;
}

/// Bits of touching pixels, so many quarters each, and the difference of sampled gradients:
/// pairs_bt; and pairs5x5, whose features have no gradients.
struct PairsCost {
    unsigned scale;
    unsigned most;

    // Of two pixels, in both halves.
    __device__ static Samples gradients(const LongFeature& low, const LongFeature& high)
    {
        return {__byte_perm(low.z, high.z, 0x3430), __byte_perm(low.z, high.z, 0x3531),
                __byte_perm(low.z, high.z, 0x3632)};
    }
    __device__ unsigned operator()(const LongFeature& left, const LongFeature& low,
                                   const LongFeature& high) const
    {
        const unsigned g = sampling_difference(gradients(left, left), gradients(low, high));
        const unsigned sum =
            scale * differing_bits(left, low, high) + 2 * g + (g >> 1 & 0x000F000FU);
        return lesser(sum >> 2 & 0x00FF00FFU, pair_of(most));
    }
};

/// What birchfield_tomasi adds up over a block: the difference of one pair of pixels.
struct SampleDifference {
    static constexpr unsigned kMost = 26;

    Samples left; ///< tone in the low half, gradient in the high one
    bool valid;

    __device__ explicit SampleDifference(Feature feature)
        : left(samples(feature)), valid((feature.y & kValidFeature) != 0)
    {
    }
    __device__ static Samples samples(Feature f)
    {
        return {f.x & 0x00FF00FFU, f.x >> 8 & 0x00FF00FFU, f.y & 0x00FF00FFU};
    }
    __device__ unsigned operator()(Feature right) const
    {
        const unsigned d = sampling_difference(left, samples(right));
        const unsigned sum = (d >> 15 & 0x1FEU) + (d >> 2 & 0x3FU);
        const bool both = valid && (right.y & kValidFeature) != 0;
        return both ? least_of(sum, kMost) : kMost / 2;
    }
};

} // namespace hsgm::matcher::cuda
