#pragma once

#include "matcher/cuda/solve_job.h"

namespace hsgm::matcher::cuda {

/// The word of a feature that says whether the pixel is valid, in its highest bit.
__device__ __forceinline__ unsigned validity_word(const Feature& f)
{
    return f.y;
}
__device__ __forceinline__ unsigned validity_word(const LongFeature& f)
{
    return f.w;
}

/// A row of right pixels; those beyond its ends are not valid.
template <typename F>
class RightRow {
public:
    __device__ RightRow(const Plane<const F>& right, int row)
        : first_(&right.at(row, right.area.col)), col_(right.area.col), cols_(right.area.cols)
    {
    }
    __device__ F at(int col) const
    {
        const auto i = static_cast<unsigned>(col - col_);
        return i < static_cast<unsigned>(cols_) ? first_[i] : F{};
    }

private:
    const F* first_;
    int col_;
    int cols_;
};

/// The costs of a word, but for those of pixels that are outside the image or nodata: `half`.
__device__ __forceinline__ unsigned where_valid(unsigned pair, unsigned left, unsigned low,
                                                unsigned high, unsigned half)
{
    const bool low_valid = (left & low & kValidFeature) != 0;
    const bool high_valid = (left & high & kValidFeature) != 0;
    return (low_valid ? pair & 0xFFFFU : half) | (high_valid ? pair & 0xFFFF0000U : half << 16);
}

} // namespace hsgm::matcher::cuda
