#pragma once

// The words of the CUDA language that hsgm's kernels use, for a plain C++ compiler. There is
// no __activemask here, and there are no cooperative groups: kernels do without.

#include "tests/device_stand_in/kernel_run.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#define HSGM_DEVICE_STAND_IN 1

// The names belong to the language that is stood in for.
// NOLINTBEGIN(bugprone-reserved-identifier)

#define __host__
#define __device__
#define __global__
#define __forceinline__ inline
#define __shared__ static
#define __launch_bounds__(...)
#define __grid_constant__

#define threadIdx (::hsgm::stand_in::place.thread)
#define blockIdx (::hsgm::stand_in::place.block)
#define blockDim (::hsgm::stand_in::place.block_size)
#define gridDim (::hsgm::stand_in::place.grid_size)

struct uint2 {
    unsigned x;
    unsigned y;
};
struct alignas(16) uint4 {
    unsigned x;
    unsigned y;
    unsigned z;
    unsigned w;
};
inline uint2 make_uint2(unsigned x, unsigned y)
{
    return {x, y};
}
inline uint4 make_uint4(unsigned x, unsigned y, unsigned z, unsigned w)
{
    return {x, y, z, w};
}

template <typename T>
T __ldg(const T* address)
{
    return *address;
}

using StandInHere = hsgm::stand_in::Here;

inline void __syncthreads(const StandInHere& here = StandInHere::current())
{
    hsgm::stand_in::meet_threads(hsgm::stand_in::Barrier::plain, 0, here);
}
inline int __syncthreads_or(int predicate, const StandInHere& here = StandInHere::current())
{
    return hsgm::stand_in::meet_threads(hsgm::stand_in::Barrier::any, predicate, here);
}
inline int __syncthreads_and(int predicate, const StandInHere& here = StandInHere::current())
{
    return hsgm::stand_in::meet_threads(hsgm::stand_in::Barrier::all, predicate, here);
}
inline void __syncwarp(unsigned mask = ~0U, const StandInHere& here = StandInHere::current())
{
    hsgm::stand_in::meet_lanes(hsgm::stand_in::Collective::sync, mask, 0, 0, here);
}

namespace hsgm::stand_in {

inline int own_lane()
{
    const Place& p = place;
    const unsigned linear =
        (p.thread.z * p.block_size.y + p.thread.y) * p.block_size.x + p.thread.x;
    return static_cast<int>(linear % 32);
}

template <typename T>
T shuffle(unsigned mask, T value, int lane, const Here& here)
{
    static_assert(sizeof(T) == 4);
    return std::bit_cast<T>(static_cast<std::uint32_t>(meet_lanes(
        Collective::shuffle, mask, std::bit_cast<std::uint32_t>(value), lane, here)));
}

} // namespace hsgm::stand_in

// Groups of `width` lanes, as in CUDA; a lane beyond its group reads itself.
template <typename T>
T __shfl_sync(unsigned mask, T value, int lane, int width = 32,
              const StandInHere& here = StandInHere::current())
{
    const int own = hsgm::stand_in::own_lane();
    return hsgm::stand_in::shuffle(mask, value, (own & -width) + (lane & (width - 1)), here);
}
template <typename T>
T __shfl_xor_sync(unsigned mask, T value, int bits, int width = 32,
                  const StandInHere& here = StandInHere::current())
{
    const int own = hsgm::stand_in::own_lane();
    const int other = own ^ bits;
    const bool inside = (other & -width) <= (own & -width);
    return hsgm::stand_in::shuffle(mask, value, inside ? other : own, here);
}
template <typename T>
T __shfl_up_sync(unsigned mask, T value, unsigned by, int width = 32,
                 const StandInHere& here = StandInHere::current())
{
    const int own = hsgm::stand_in::own_lane();
    const int other = own - static_cast<int>(by);
    return hsgm::stand_in::shuffle(mask, value, other >= (own & -width) ? other : own, here);
}
template <typename T>
T __shfl_down_sync(unsigned mask, T value, unsigned by, int width = 32,
                   const StandInHere& here = StandInHere::current())
{
    const int own = hsgm::stand_in::own_lane();
    const int other = own + static_cast<int>(by);
    const bool inside = other < (own & -width) + width;
    return hsgm::stand_in::shuffle(mask, value, inside ? other : own, here);
}

inline int __any_sync(unsigned mask, int predicate,
                      const StandInHere& here = StandInHere::current())
{
    return static_cast<int>(
        hsgm::stand_in::meet_lanes(hsgm::stand_in::Collective::any, mask,
                                   static_cast<std::uint64_t>(predicate != 0), 0, here));
}
inline int __all_sync(unsigned mask, int predicate,
                      const StandInHere& here = StandInHere::current())
{
    return static_cast<int>(
        hsgm::stand_in::meet_lanes(hsgm::stand_in::Collective::all, mask,
                                   static_cast<std::uint64_t>(predicate != 0), 0, here));
}
inline unsigned __ballot_sync(unsigned mask, int predicate,
                              const StandInHere& here = StandInHere::current())
{
    return static_cast<unsigned>(
        hsgm::stand_in::meet_lanes(hsgm::stand_in::Collective::ballot, mask,
                                   static_cast<std::uint64_t>(predicate != 0), 0, here));
}
inline unsigned __reduce_min_sync(unsigned mask, unsigned value,
                                  const StandInHere& here = StandInHere::current())
{
    return static_cast<unsigned>(
        hsgm::stand_in::meet_lanes(hsgm::stand_in::Collective::minimum, mask, value, 0, here));
}

template <typename T>
T atomicAdd(T* address, T value)
{
    hsgm::stand_in::maybe_switch();
    return __atomic_fetch_add(address, value, __ATOMIC_RELAXED);
}
template <typename T>
T atomicMin(T* address, T value)
{
    hsgm::stand_in::maybe_switch();
    T seen = __atomic_load_n(address, __ATOMIC_RELAXED);
    while (value < seen && !__atomic_compare_exchange_n(address, &seen, value, true,
                                                        __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
    }
    return seen;
}

inline int __popc(unsigned bits)
{
    return std::popcount(bits);
}

/// Each nibble of `selector` picks one of the eight bytes of (high, low).
inline unsigned __byte_perm(unsigned low, unsigned high, unsigned selector)
{
    const std::uint64_t bytes = std::uint64_t{high} << 32 | low;
    unsigned result = 0;
    for (unsigned i = 0; i < 4; ++i) {
        const unsigned pick = selector >> (4 * i) & 7U;
        result |= static_cast<unsigned>(bytes >> (8 * pick) & 0xFFU) << (8 * i);
    }
    return result;
}

namespace hsgm::stand_in {

// Applies `f` to fields of `kBits` bits each.
template <unsigned kBits, typename F>
unsigned by_field(unsigned a, unsigned b, F f)
{
    constexpr unsigned kField = (1U << kBits) - 1;
    unsigned result = 0;
    for (unsigned at = 0; at < 32; at += kBits) {
        result |= (f(a >> at & kField, b >> at & kField) & kField) << at;
    }
    return result;
}

} // namespace hsgm::stand_in

inline unsigned __vminu2(unsigned a, unsigned b)
{
    return hsgm::stand_in::by_field<16>(a, b,
                                        [](unsigned x, unsigned y) { return std::min(x, y); });
}
inline unsigned __vmaxu2(unsigned a, unsigned b)
{
    return hsgm::stand_in::by_field<16>(a, b,
                                        [](unsigned x, unsigned y) { return std::max(x, y); });
}
inline unsigned __vminu4(unsigned a, unsigned b)
{
    return hsgm::stand_in::by_field<8>(a, b,
                                       [](unsigned x, unsigned y) { return std::min(x, y); });
}
inline unsigned __vaddus4(unsigned a, unsigned b)
{
    return hsgm::stand_in::by_field<8>(
        a, b, [](unsigned x, unsigned y) { return std::min(x + y, 255U); });
}
/// min(a + b, c) in 16-bit fields.
inline unsigned __viaddmin_u16x2(unsigned a, unsigned b, unsigned c)
{
    const unsigned sum =
        hsgm::stand_in::by_field<16>(a, b, [](unsigned x, unsigned y) { return x + y; });
    return __vminu2(sum, c);
}
/// Two 16-bit numbers times the lower, or upper, two of four 8-bit ones, summed up.
inline unsigned __dp2a_lo(unsigned a, unsigned b, unsigned sum)
{
    return sum + (a & 0xFFFFU) * (b & 0xFFU) + (a >> 16) * (b >> 8 & 0xFFU);
}
inline unsigned __dp2a_hi(unsigned a, unsigned b, unsigned sum)
{
    return __dp2a_lo(a, b >> 16, sum);
}
inline unsigned __vimin3_u16x2(unsigned a, unsigned b, unsigned c)
{
    return __vminu2(__vminu2(a, b), c);
}

// NOLINTEND(bugprone-reserved-identifier)
