#pragma once

#include "matcher/cuda/device.cuh"
#include "matcher/cuda/views.h"

namespace hsgm::matcher::cuda {

/// One value a disparity of a coarser pixel, as the finer level reads them: its own for even
/// disparities, the rounded mean of two for odd ones, `fill` outside the stored range.
template <typename Cell>
struct CoarseValues {
    const Cell* values;
    int least; ///< stored range of the coarser window
    int count;
    int fill;

    __device__ int coarse(int disparity) const
    {
        const int i = disparity - least;
        return i >= 0 && i < count ? static_cast<int>(values[i]) : fill;
    }
    /// Of the finer disparity `d`.
    __device__ int at(int d) const
    {
        const int half = floor_divided(d, 2);
        const int lower = coarse(half);
        return d == 2 * half ? lower : between(lower, coarse(half + 1));
    }
};

} // namespace hsgm::matcher::cuda
