#pragma once

#include "matcher/cuda/device.cuh"

// Two 16-bit path costs in one 32-bit word. All of them stay under 0x7C00, where the order of
// IEEE half-precision numbers is that of their bits as integers: so processors that compare
// pairs of halves, but not pairs of integers, serve as well.
namespace hsgm::matcher::cuda {

/// Dearer than any path cost (C_max + prior + P2 <= 4063) and any jump (8063), so that what
/// pads a range is never taken; still under 0x7C00 after a step.
constexpr unsigned kInfinite = 0x2000;
constexpr unsigned kInfinitePair = 0x20002000;

__device__ __forceinline__ unsigned pair_of(unsigned value)
{
    return value * 0x00010001U;
}

__device__ __forceinline__ unsigned swapped(unsigned pair)
{
    return __byte_perm(pair, pair, 0x1032);
}

/// The lesser of each half.
__device__ __forceinline__ unsigned lesser(unsigned a, unsigned b)
{
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800 && __CUDA_ARCH__ < 900
    unsigned result;
    asm("min.f16x2 %0, %1, %2;" : "=r"(result) : "r"(a), "r"(b));
    return result;
#else
    return __vminu2(a, b);
#endif
}

__device__ __forceinline__ unsigned lesser(unsigned a, unsigned b, unsigned c)
{
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ < 900
    return lesser(lesser(a, b), c);
#else
    return __vimin3_u16x2(a, b, c);
#endif
}

/// The greater of each half.
__device__ __forceinline__ unsigned most(unsigned a, unsigned b)
{
    return __vmaxu2(a, b);
}

/// Two words of pairs, all under 256, as four bytes, and back.
__device__ __forceinline__ unsigned to_bytes(unsigned first, unsigned second)
{
    return __byte_perm(first, second, 0x6420);
}
__device__ __forceinline__ unsigned first_of_bytes(unsigned bytes)
{
    return __byte_perm(bytes, 0, 0x4140);
}
__device__ __forceinline__ unsigned second_of_bytes(unsigned bytes)
{
    return __byte_perm(bytes, 0, 0x4342);
}

} // namespace hsgm::matcher::cuda
