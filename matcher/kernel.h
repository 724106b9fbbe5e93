#pragma once

// The matcher's integer arithmetic, one small function each, in a form that compiles for
// host and device alike. The SIMD code states the same formulas in vectors; docs/algorithm.md
// says where each comes from.

#include <cstdint>

#if defined(__CUDACC__)
#define HSGM_HOST_DEVICE __host__ __device__
#else
#define HSGM_HOST_DEVICE
#endif

namespace hsgm::matcher {

/// The coarser level's normalised sums are capped at this before they become the prior.
constexpr int kPriorCap = 16;
/// The prior is divided by two to the power of this before it joins a matching cost...
constexpr int kPriorShift = 2;
/// ... and where there is texture by this.
constexpr int kPriorShiftTextured = 4;
/// Largest addition of the prior to a matching cost.
constexpr int kPriorMax = kPriorCap >> kPriorShift;
/// A 7 x 7 neighbourhood whose tones span less than this counts as low texture.
constexpr int kTextureGate = 7;
/// How much dearer than P2 a coarse disparity is that was never searched.
constexpr int kUnsearchedMargin = 24;
/// Right-view key of a right pixel that no left pixel met.
constexpr std::uint32_t kNoKey = 0xFFFFFFFFU;

/// P2 by the tone difference `a` along the path, gradient rule: p2 at 0, falling to p1,
/// half-way there at `half`.
HSGM_HOST_DEVICE constexpr int p2_gradient(int p1, int p2, int half, int a)
{
    return p1 + (p2 - p1) * half / (half + a);
}

/// P2 by eq. 3 of Won and Jung.
HSGM_HOST_DEVICE constexpr int p2_equation3(int p1, int p2, int a)
{
    return p1 + (p2 - p1) / (1 + a);
}

/// Value of an odd disparity between its two coarser neighbours; the one rounding rule.
HSGM_HOST_DEVICE constexpr int between(int lower, int upper)
{
    return (lower + upper + 1) >> 1;
}

/// Prior q of a disparity from the sums of its pixel (docs/algorithm.md, section 3).
HSGM_HOST_DEVICE constexpr int prior_of(int sum, int least_sum, int paths)
{
    const int q = (sum - least_sum) / paths;
    return q < kPriorCap ? q : kPriorCap;
}

/// Sub-pixel position of winner `d` in 1/256 px from the sums at d-1, d, d+1.
/// Between a parabola and straight lines; least pixel locking of the rules tried.
/// Offsets lie in [-127, 128], so the result tells its winner (`winner_of`).
HSGM_HOST_DEVICE constexpr std::int32_t subpixel_q8(int d, int below, int at, int above)
{
    const int a = below - at;
    const int b = above - at;
    const int least = a < b ? a : b;
    const int most = a < b ? b : a;
    if (most == 0) {
        return d * 256;
    }
    const int x = (least << 8) / most;
    const int offset = 128 - ((x * x + 256 * x) >> 10);
    return a < b ? d * 256 - (offset < 127 ? offset : 127) : d * 256 + offset;
}

/// Confidence 1..255 from the least sum and the least one two or more disparities away.
HSGM_HOST_DEVICE constexpr int confidence_of(int least, int rival)
{
    const int c = rival > 0 ? 255 * (rival - least) / rival : 1;
    return c < 1 ? 1 : c;
}

/// Differing bits of the sparse census that count as neither match nor mismatch: there is no
/// counterpart to compare with.
constexpr int kNoCounterpartBits = 8;
/// The fraction that the sums give has the weight of this many differing bits.
constexpr int kFractionVotes = 6;

/// Sub-pixel position of winner `d` in 1/256 px from differing bits of the sparse census at
/// d-1, d, d+1, summed over the same pixels, and `before`, the offset in 1/256 px that the sums
/// of path costs gave. Straight lines of equal slope through the three, as far as the nearer
/// neighbour is no better than d itself (docs/algorithm.md, section 6).
HSGM_HOST_DEVICE constexpr std::int32_t census_subpixel_q8(int d, int below, int at, int above,
                                                           int before)
{
    const int rise_below = below > at ? below - at : 0;
    const int rise_above = above > at ? above - at : 0;
    const int a = 128 * rise_below + kFractionVotes * (before < 0 ? 128 + before : 128);
    const int b = 128 * rise_above + kFractionVotes * (before > 0 ? 128 - before : 128);
    const int offset = a < b ? 128 - 128 * a / b : 128 - 128 * b / a;
    return a < b ? d * 256 - (offset < 127 ? offset : 127) : d * 256 + offset;
}

/// Rounds a count of disparities up to what the vector code stores for a pixel: full vectors
/// of 32 bytes, but for the shortest ranges.
constexpr int padded_count(int count)
{
    return count <= 16 ? 16 : (count + 31) / 32 * 32;
}

} // namespace hsgm::matcher
