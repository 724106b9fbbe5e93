#pragma once

#include "matcher/cuda/coarse_values.cuh"
#include "matcher/cuda/path_step.cuh"

namespace hsgm::matcher::cuda {

/// Hamming distance of census words (docs/algorithm.md, section 3).
struct CensusCost {
    unsigned scale;
    unsigned most;

    /// Of a left pixel and two right ones, in both halves.
    __device__ unsigned operator()(Feature left, Feature low, Feature high) const
    {
        const int low_bits = __popc(left.x ^ low.x) + __popc(left.y ^ low.y);
        const int high_bits = __popc(left.x ^ high.x) + __popc(left.y ^ high.y);
        return lesser(static_cast<unsigned>(high_bits * 0x10000 + low_bits) * scale,
                      pair_of(most));
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
        const std::uint8_t* const row = table + left.x * 256;
        return __ldg(row + low.x) | static_cast<unsigned>(__ldg(row + high.x)) << 16;
    }
};

/// Fills a strip of matching costs.
template <typename Cell, typename Group>
class StripCosts {
    static constexpr int kWords = Group::kWords;

public:
    __device__ StripCosts(const WindowFrame<Cell>& frame, const Strip& strip)
        : frame_(frame), job_(*frame.job), strip_(strip)
    {
    }

    /// C(p, d) of all pixels, without the prior. A thread takes a few pixels of a row and the
    /// words of one lane: from word to word, its right pixels move on by one. Holds a barrier.
    __device__ void fill()
    {
        const CostRule& rule = job_.cost;
        const CensusCost census{static_cast<unsigned>(rule.scale),
                                static_cast<unsigned>(rule.most)};
        const bool valid = __syncthreads_and(sees_valid_pixels() ? 1 : 0) != 0;
        if (rule.kind == CostKind::table) {
            fill_with<false>(TableCost{rule.table});
        } else if (rule.kind == CostKind::census_tone) {
            fill_with<false>(CensusToneCost{static_cast<unsigned>(rule.most)});
        } else if (valid) {
            fill_with<true>(census);
        } else {
            fill_with<false>(census);
        }
    }

    /// Adds the gated prior; a warp looks at one pixel at a time. After a barrier.
    __device__ void add_prior()
    {
        const int cols = frame_.end_col - frame_.first_col;
        const int warps = static_cast<int>(blockDim.x) / kWarp;
        for (int p = static_cast<int>(threadIdx.x) / kWarp; p < strip_.rows * cols;
             p += warps) {
            const int row = strip_.row + p / cols;
            const int col = frame_.first_col + p % cols;
            if (job_.low_texture.at(row, col) != 0) {
                add_prior_at(row, col);
            }
        }
    }

private:
    // An odd number of pixels: their costs then lie in different banks.
    static constexpr int kPixels = 5;

    // This thread's share of looking whether all pixels that the strip compares are valid.
    __device__ bool sees_valid_pixels() const
    {
        const int lefts = frame_.end_col - frame_.first_col;
        const int cols = 2 * lefts + frame_.window.count - 1;
        const int last = frame_.window.least + frame_.window.count - 1;
        unsigned valid = kValidFeature;
        for (int p = static_cast<int>(threadIdx.x); p < strip_.rows * cols;
             p += static_cast<int>(blockDim.x)) {
            const int row = strip_.row + p / cols;
            const int i = p % cols;
            valid &= i < lefts ? job_.left.at(row, frame_.first_col + i).y
                               : right_at(row, frame_.first_col - last + i - lefts).y;
        }
        return valid != 0;
    }

    template <bool kAllValid, typename Rule>
    __device__ void fill_with(const Rule& rule)
    {
        const int cols = frame_.end_col - frame_.first_col;
        const int across = (cols + kPixels - 1) / kPixels;
        const int lanes = Group::kWide ? frame_.words() : Group::kLanes;
        const int pieces = strip_.rows * across * lanes;
        for (int p = static_cast<int>(threadIdx.x); p < pieces;
             p += static_cast<int>(blockDim.x)) {
            const int block = p / lanes;
            fill_piece<kAllValid>(rule, strip_.row + block / across,
                                  frame_.first_col + block % across * kPixels, p % lanes);
        }
    }

    __device__ Feature right_at(int row, int col) const
    {
        const Area& area = job_.right.area;
        return col >= area.col && col < area.col_end() ? job_.right.at(row, col)
                                                       : Feature{0, 0};
    }

    // What lies outside the image, or is nodata, costs half of the most there is.
    template <bool kAllValid, typename Rule>
    __device__ unsigned cost(const Rule& rule, Feature left, Feature low, Feature high) const
    {
        const unsigned pair = rule(left, low, high);
        if constexpr (kAllValid) {
            return pair;
        }
        const auto half = static_cast<unsigned>(job_.cost.most) / 2;
        const bool low_valid = (left.y & low.y & kValidFeature) != 0;
        const bool high_valid = (left.y & high.y & kValidFeature) != 0;
        return (low_valid ? pair & 0xFFFFU : half) |
               (high_valid ? pair & 0xFFFF0000U : half << 16);
    }

    template <bool kAllValid, typename Rule>
    __device__ void fill_piece(const Rule& rule, int row, int col, int lane)
    {
        const int pixels = least_of(kPixels, frame_.end_col - col);
        const int half = frame_.words();
        Feature left[kPixels];
        Feature low[kPixels];
        Feature high[kPixels];
        const int first = lane * kWords;
        const int meets = col - frame_.window.least - first; // right column of the first word
#pragma unroll
        for (int k = 0; k < kPixels; ++k) {
            left[k] = job_.left.at(row, least_of(col + k, frame_.end_col - 1));
            low[k] = right_at(row, meets + k);
            high[k] = right_at(row, meets - half + k);
        }
        unsigned* to = frame_.costs + (row - strip_.row) * job_.strips.cost_row +
                       (col - frame_.first_col) * job_.strips.pixel_stride + lane;
#pragma unroll 1
        for (int i = 0; i < kWords; ++i) {
#pragma unroll
            for (int k = 0; k < kPixels; ++k) {
                unsigned pair = cost<kAllValid>(rule, left[k], low[k], high[k]);
                if (frame_.is_padded()) {
                    pair = padded_word(pair, first + i, half, frame_.window.count);
                }
                if (k < pixels) {
                    to[k * job_.strips.pixel_stride] = pair;
                }
            }
            to += Group::kLanes;
#pragma unroll
            for (int k = kPixels - 1; k > 0; --k) {
                low[k] = low[k - 1];
                high[k] = high[k - 1];
            }
            low[0] = right_at(row, meets - i - 1);
            high[0] = right_at(row, meets - half - i - 1);
        }
    }

    __device__ void add_prior_at(int row, int col)
    {
        const Window& coarse = job_.coarser.window_at(row / 2, col / 2);
        const CoarseValues<std::uint8_t> prior{job_.coarser.prior_at(row / 2, col / 2),
                                               coarse.least, coarse.count, kPriorCap};
        unsigned* const costs = frame_.costs + (row - strip_.row) * job_.strips.cost_row +
                                (col - frame_.first_col) * job_.strips.pixel_stride;
        const int half = frame_.words();
        for (int j = static_cast<int>(threadIdx.x) % kWarp; j < half; j += kWarp) {
            const int d = frame_.window.least + j;
            const int low = j < frame_.window.count ? prior.at(d) >> 2 : 0;
            const int high = j + half < frame_.window.count ? prior.at(d + half) >> 2 : 0;
            costs[Group::place(j)] += static_cast<unsigned>(low) | static_cast<unsigned>(high)
                                                                       << 16;
        }
    }

    const WindowFrame<Cell>& frame_;
    const SolveJob<Cell>& job_;
    Strip strip_;
};

} // namespace hsgm::matcher::cuda
