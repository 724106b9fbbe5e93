#pragma once

#include "matcher/cuda/device.cuh"
#include "matcher/cuda/features.h"

// Kernels that make features take the pixels of an area one after the other.
namespace hsgm::matcher::cuda::features {

constexpr int kThreads = 256;

/// Pixel number `i` of an area.
struct Pixel {
    int row;
    int col;
};
__device__ inline Pixel pixel_of(const Area& area, std::size_t i)
{
    const auto cols = static_cast<std::size_t>(area.cols);
    return {area.row + static_cast<int>(i / cols), area.col + static_cast<int>(i % cols)};
}
__device__ inline std::size_t first_pixel()
{
    return std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
}
__device__ inline std::size_t pixel_step()
{
    return std::size_t{gridDim.x} * blockDim.x;
}

/// Bits in order: 32 in `low`, then those in `high`.
struct Bits {
    unsigned low = 0;
    unsigned high = 0;
    int count = 0;

    __device__ void add(bool bit)
    {
        if (count < 32) {
            low |= (bit ? 1U : 0U) << count;
        } else {
            high |= (bit ? 1U : 0U) << (count - 32);
        }
        ++count;
    }
};

inline int blocks_for(const Area& area)
{
    return static_cast<int>(
        least_of<std::size_t>((area.pixels() + kThreads - 1) / kThreads, 2048));
}

} // namespace hsgm::matcher::cuda::features
