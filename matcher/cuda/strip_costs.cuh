#pragma once

#include "matcher/cuda/coarse_values.cuh"
#include "matcher/cuda/window_frame.cuh"

namespace hsgm::matcher::cuda {

/// Hamming distance of census words (docs/algorithm.md, section 3).
struct CensusCost {
    unsigned scale;
    unsigned most;

    __device__ unsigned operator()(Feature left, Feature right) const
    {
        const int bits = __popc(left.x ^ right.x) + __popc(left.y ^ right.y);
        return least_of(static_cast<unsigned>(bits) * scale, most);
    }
};

/// A table by the tones of both pixels: HMI.
struct TableCost {
    const std::uint8_t* table;

    __device__ unsigned operator()(Feature left, Feature right) const
    {
        return __ldg(table + left.x * 256 + right.x);
    }
};

/// Fills a strip of matching costs.
template <typename Cell, int kGroup, int kWords>
class StripCosts {
public:
    __device__ StripCosts(const WindowFrame<Cell>& frame, const Strip& strip)
        : frame_(frame), job_(*frame.job), strip_(strip)
    {
    }

    /// C(p, d) of all pixels, without the prior. A thread takes a few pixels of a row and the
    /// words of one lane: from word to word, its right pixels move on by one.
    __device__ void fill()
    {
        const CostRule& rule = job_.cost;
        if (rule.kind == CostKind::census) {
            fill_with(CensusCost{static_cast<unsigned>(rule.scale),
                                 static_cast<unsigned>(rule.most)});
        } else {
            fill_with(TableCost{rule.table});
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

    template <typename Rule>
    __device__ void fill_with(const Rule& rule)
    {
        const int cols = frame_.end_col - frame_.first_col;
        const int across = (cols + kPixels - 1) / kPixels;
        const int pieces = strip_.rows * across * kGroup;
        for (int p = static_cast<int>(threadIdx.x); p < pieces;
             p += static_cast<int>(blockDim.x)) {
            const int block = p / kGroup;
            fill_piece(rule, strip_.row + block / across,
                       frame_.first_col + block % across * kPixels, p % kGroup);
        }
    }

    __device__ Feature right_at(int row, int col) const
    {
        const Area& area = job_.right.area;
        return col >= area.col && col < area.col_end() ? job_.right.at(row, col)
                                                       : Feature{0, 0};
    }

    template <typename Rule>
    __device__ unsigned cost(const Rule& rule, Feature left, Feature right) const
    {
        const bool valid = (left.y & right.y & kValidFeature) != 0;
        return valid ? rule(left, right) : static_cast<unsigned>(job_.cost.most) / 2;
    }

    template <typename Rule>
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
                unsigned pair = cost(rule, left[k], low[k]) | cost(rule, left[k], high[k])
                                                                  << 16;
                if (frame_.is_padded()) {
                    pair = padded(pair, first + i);
                }
                if (k < pixels) {
                    to[k * job_.strips.pixel_stride] = pair;
                }
            }
            to += kGroup;
#pragma unroll
            for (int k = kPixels - 1; k > 0; --k) {
                low[k] = low[k - 1];
                high[k] = high[k - 1];
            }
            low[0] = right_at(row, meets - i - 1);
            high[0] = right_at(row, meets - half - i - 1);
        }
    }

    __device__ unsigned padded(unsigned pair, int word) const
    {
        const int count = frame_.window.count;
        if (word >= count) {
            return kInfinitePair;
        }
        return word + frame_.words() >= count ? (pair & 0xFFFFU) | kInfinite << 16 : pair;
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
            costs[j % kWords * kGroup + j / kWords] +=
                static_cast<unsigned>(low) | static_cast<unsigned>(high) << 16;
        }
    }

    const WindowFrame<Cell>& frame_;
    const SolveJob<Cell>& job_;
    Strip strip_;
};

} // namespace hsgm::matcher::cuda
