#pragma once

#include "matcher/cuda/path_step.cuh"
#include "matcher/cuda/strip_prior.cuh"

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
        return __ldg(table + (left.x << 8 | low.x)) |
               static_cast<unsigned>(__ldg(table + (left.x << 8 | high.x))) << 16;
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

    /// C(p, d) of all pixels. A thread takes a few pixels of a row and the words of one lane:
    /// from word to word, its right pixels move on by one. Holds a barrier.
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

private:
    // Two of them share a coarse pixel: strips begin at even columns.
    static constexpr int kPixels = 4;

    // Left and right pixels whose costs make up a word: those of the low and the high half.
    struct Features {
        Feature left[kPixels];
        Feature low[kPixels];
        Feature high[kPixels];
    };

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
                               : right_row(row).at(frame_.first_col - last + i - lefts).y;
        }
        return valid != 0;
    }

    template <bool kAllValid, typename Rule>
    __device__ __forceinline__ void fill_with(const Rule& rule)
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

    // A row of right pixels; those beyond its ends are not valid.
    struct RightRow {
        const Feature* first;
        int col;
        int cols;

        __device__ Feature at(int at_col) const
        {
            const auto i = static_cast<unsigned>(at_col - col);
            return i < static_cast<unsigned>(cols) ? first[i] : Feature{0, 0};
        }
    };
    __device__ RightRow right_row(int row) const
    {
        const Area& area = job_.right.area;
        return {&job_.right.at(row, area.col), area.col, area.cols};
    }

    // What lies outside the image, or is nodata, costs half of the most there is.
    template <bool kAllValid, typename Rule>
    __device__ unsigned cost(const Rule& rule, const Features& f, int k) const
    {
        const unsigned pair = rule(f.left[k], f.low[k], f.high[k]);
        if constexpr (kAllValid) {
            return pair;
        }
        const auto half = static_cast<unsigned>(job_.cost.most) / 2;
        const bool low_valid = (f.left[k].y & f.low[k].y & kValidFeature) != 0;
        const bool high_valid = (f.left[k].y & f.high[k].y & kValidFeature) != 0;
        return (low_valid ? pair & 0xFFFFU : half) |
               (high_valid ? pair & 0xFFFF0000U : half << 16);
    }

    __device__ Features first_features(const RightRow& right, int row, int col, int meets) const
    {
        Features f;
#pragma unroll
        for (int k = 0; k < kPixels; ++k) {
            f.left[k] = job_.left.at(row, least_of(col + k, frame_.end_col - 1));
            f.low[k] = right.at(meets + k);
            f.high[k] = right.at(meets - frame_.words() + k);
        }
        return f;
    }
    // To the next disparity, where the first pixel meets column `meets` of the right image.
    __device__ void move_on(Features& f, const RightRow& right, int meets) const
    {
#pragma unroll
        for (int k = kPixels - 1; k > 0; --k) {
            f.low[k] = f.low[k - 1];
            f.high[k] = f.high[k - 1];
        }
        f.low[0] = right.at(meets);
        f.high[0] = right.at(meets - frame_.words());
    }

    template <bool kAllValid, typename Rule>
    __device__ __forceinline__ void fill_piece(const Rule& rule, int row, int col, int lane)
    {
        const int meets = col - frame_.window.least - lane * kWords; // by the first word
        const RightRow right = right_row(row);
        Features f = first_features(right, row, col, meets);
        unsigned* const to = frame_.costs + (row - strip_.row) * job_.strips.cost_row +
                             (col - frame_.first_col) * job_.strips.cost_pixel;
        if constexpr (Group::kWide) {
            fill_word<kAllValid>(rule, f, row, col, lane, to);
        } else {
            fill_lane<kAllValid>(rule, f, right, row, col, lane, to + lane * Group::kCostWords);
        }
    }

    template <bool kAllValid, typename Rule>
    __device__ __forceinline__ void fill_word(const Rule& rule, const Features& f, int row,
                                              int col, int j, unsigned* to)
    {
#pragma unroll
        for (int k = 0; k < kPixels; ++k) {
            if (col + k >= frame_.end_col) {
                break;
            }
            const unsigned pair =
                cost<kAllValid>(rule, f, k) + prior_pair(frame_, row, col + k, j);
            reinterpret_cast<std::uint16_t*>(to + k * job_.strips.cost_pixel)[j] =
                static_cast<std::uint16_t>(stored_costs((pair | pair >> 8) & 0xFFFFU));
        }
    }

    template <bool kAllValid, typename Rule>
    __device__ __forceinline__ void fill_lane(const Rule& rule, Features& f,
                                              const RightRow& right, int row, int col, int lane,
                                              unsigned* to)
    {
        const int pixels = least_of(kPixels, frame_.end_col - col);
        int meets = col - frame_.window.least - lane * kWords;
        StripPrior<Cell, kPixels> prior(frame_, row, col, lane * kWords);
        // Two words at a time, that is four costs of each pixel.
#pragma unroll 1
        for (int i = 0; i < Group::kCostWords; ++i) {
            prior.next();
            unsigned first[kPixels];
#pragma unroll
            for (int k = 0; k < kPixels; ++k) {
                first[k] = cost<kAllValid>(rule, f, k);
            }
            move_on(f, right, --meets);
#pragma unroll
            for (int k = 0; k < kPixels; ++k) {
                const unsigned bytes = to_bytes(first[k], cost<kAllValid>(rule, f, k));
                if (k < pixels) {
                    to[k * job_.strips.cost_pixel + i] = stored_costs(bytes + prior.bytes(k));
                }
            }
            move_on(f, right, --meets);
        }
    }

    const WindowFrame<Cell>& frame_;
    const SolveJob<Cell>& job_;
    Strip strip_;
};

} // namespace hsgm::matcher::cuda
