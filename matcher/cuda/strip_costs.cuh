#pragma once

#include "matcher/cuda/cost_rules.cuh"

namespace hsgm::matcher::cuda {

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
        const auto most = static_cast<unsigned>(rule.most);
        const bool valid = __syncthreads_and(sees_valid_pixels() ? 1 : 0) != 0;
        switch (rule.kind) {
        case CostKind::table:
            return fill_with<false>(TableCost{rule.table}, job_.left, job_.right);
        case CostKind::census_tone:
            return fill_with<false>(CensusToneCost{most}, job_.left, job_.right);
        case CostKind::pairs:
            return fill_with<false>(PairsCost{static_cast<unsigned>(rule.scale), most},
                                    job_.long_left, job_.long_right);
        case CostKind::census:
        case CostKind::block: // has kernels of its own
            break;
        }
        const CensusCost census{static_cast<unsigned>(rule.scale), most};
        if (valid) {
            fill_with<true>(census, job_.left, job_.right);
        } else {
            fill_with<false>(census, job_.left, job_.right);
        }
    }

private:
    // Pixels of a row that a thread takes at once: as many as its registers hold. Two of them
    // share a coarse pixel: strips begin at even columns.
    template <typename F>
    static constexpr int kPixels = sizeof(F) > sizeof(Feature) || sizeof(Cell) > 1 ? 2 : 4;

    // Left and right pixels whose costs make up a word: those of the low and the high half.
    template <typename F>
    struct Features {
        F left[kPixels<F>];
        F low[kPixels<F>];
        F high[kPixels<F>];
    };

    // This thread's share of looking whether all pixels that the strip compares are valid. Only
    // a census asks.
    __device__ bool sees_valid_pixels() const
    {
        if (job_.cost.kind != CostKind::census) {
            return false;
        }
        const int lefts = frame_.end_col - frame_.first_col;
        const int cols = 2 * lefts + frame_.window.count - 1;
        const int last = frame_.window.least + frame_.window.count - 1;
        unsigned valid = kValidFeature;
        for (int p = static_cast<int>(threadIdx.x); p < strip_.rows * cols;
             p += static_cast<int>(blockDim.x)) {
            const int row = strip_.row + p / cols;
            const int i = p % cols;
            valid &= i < lefts ? job_.left.at(row, frame_.first_col + i).y
                               : RightRow<Feature>(job_.right, row)
                                     .at(frame_.first_col - last + i - lefts)
                                     .y;
        }
        return valid != 0;
    }

    template <bool kAllValid, typename Rule, typename F>
    __device__ __forceinline__ void fill_with(const Rule& rule, const Plane<const F>& left,
                                              const Plane<const F>& right)
    {
        const int cols = frame_.end_col - frame_.first_col;
        const int across = (cols + kPixels<F> - 1) / kPixels<F>;
        const int lanes = Group::kWide ? frame_.words() : Group::kLanes;
        const int pieces = strip_.rows * across * lanes;
        for (int p = static_cast<int>(threadIdx.x); p < pieces;
             p += static_cast<int>(blockDim.x)) {
            const int block = p / lanes;
            const int row = strip_.row + block / across;
            fill_piece<kAllValid>(rule, left, RightRow<F>(right, row), row,
                                  frame_.first_col + block % across * kPixels<F>, p % lanes);
        }
    }

    // What lies outside the image, or is nodata, costs half of the most there is.
    template <bool kAllValid, typename Rule, typename F>
    __device__ unsigned cost(const Rule& rule, const Features<F>& f, int k) const
    {
        const unsigned pair = rule(f.left[k], f.low[k], f.high[k]);
        if constexpr (kAllValid) {
            return pair;
        }
        return where_valid(pair, validity_word(f.left[k]), validity_word(f.low[k]),
                           validity_word(f.high[k]), static_cast<unsigned>(job_.cost.most) / 2);
    }

    template <typename F>
    __device__ Features<F> first_features(const Plane<const F>& left, const RightRow<F>& right,
                                          int row, int col, int meets) const
    {
        Features<F> f;
#pragma unroll
        for (int k = 0; k < kPixels<F>; ++k) {
            f.left[k] = left.at(row, least_of(col + k, frame_.end_col - 1));
            f.low[k] = right.at(meets + k);
            f.high[k] = right.at(meets - frame_.words() + k);
        }
        return f;
    }
    // To the next disparity, where the first pixel meets column `meets` of the right image.
    template <typename F>
    __device__ void move_on(Features<F>& f, const RightRow<F>& right, int meets) const
    {
#pragma unroll
        for (int k = kPixels<F> - 1; k > 0; --k) {
            f.low[k] = f.low[k - 1];
            f.high[k] = f.high[k - 1];
        }
        f.low[0] = right.at(meets);
        f.high[0] = right.at(meets - frame_.words());
    }

    template <bool kAllValid, typename Rule, typename F>
    __device__ __forceinline__ void fill_piece(const Rule& rule, const Plane<const F>& left,
                                               const RightRow<F>& right, int row, int col,
                                               int lane)
    {
        const int meets = col - frame_.window.least - lane * kWords; // by the first word
        Features<F> f = first_features(left, right, row, col, meets);
        unsigned* const to = frame_.costs + (row - strip_.row) * job_.strips.cost_row +
                             (col - frame_.first_col) * job_.strips.cost_pixel;
        if constexpr (Group::kWide) {
            fill_word<kAllValid>(rule, f, row, col, lane, to);
        } else {
            fill_lane<kAllValid>(rule, f, right, row, col, lane, to + lane * Group::kCostWords);
        }
    }

    template <bool kAllValid, typename Rule, typename F>
    __device__ __forceinline__ void fill_word(const Rule& rule, const Features<F>& f, int row,
                                              int col, int j, unsigned* to)
    {
#pragma unroll
        for (int k = 0; k < kPixels<F>; ++k) {
            if (col + k >= frame_.end_col) {
                break;
            }
            const unsigned pair =
                cost<kAllValid>(rule, f, k) + prior_pair(frame_, row, col + k, j);
            reinterpret_cast<std::uint16_t*>(to + k * job_.strips.cost_pixel)[j] =
                static_cast<std::uint16_t>(stored_costs((pair | pair >> 8) & 0xFFFFU));
        }
    }

    template <bool kAllValid, typename Rule, typename F>
    __device__ __forceinline__ void fill_lane(const Rule& rule, Features<F>& f,
                                              const RightRow<F>& right, int row, int col,
                                              int lane, unsigned* to)
    {
        const int pixels = least_of(kPixels<F>, frame_.end_col - col);
        int meets = col - frame_.window.least - lane * kWords;
        StripPrior<Cell, kPixels<F>> prior(frame_, row, col, lane * kWords);
        // Two words at a time, that is four costs of each pixel.
#pragma unroll 1
        for (int i = 0; i < Group::kCostWords; ++i) {
            prior.next();
            unsigned first[kPixels<F>];
#pragma unroll
            for (int k = 0; k < kPixels<F>; ++k) {
                first[k] = cost<kAllValid>(rule, f, k);
            }
            move_on(f, right, --meets);
#pragma unroll
            for (int k = 0; k < kPixels<F>; ++k) {
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
