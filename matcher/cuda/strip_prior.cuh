#pragma once

#include "matcher/cuda/coarse_values.cuh"
#include "matcher/cuda/window_frame.cuh"

namespace hsgm::matcher::cuda {

/// What the prior adds to word `j` of a pixel (docs/algorithm.md, section 3).
template <typename Cell>
__device__ unsigned prior_pair(const WindowFrame<Cell>& frame, int row, int col, int j)
{
    const SolveJob<Cell>& job = *frame.job;
    if (!job.add_prior) {
        return 0;
    }
    const Window& coarse = job.coarser.window_at(row / 2, col / 2);
    const CoarseValues<std::uint8_t> prior{job.coarser.prior_at(row / 2, col / 2), coarse.least,
                                           coarse.count, kPriorCap};
    const int shift = job.low_texture.at(row, col) != 0 ? kPriorShift : kPriorShiftTextured;
    const int d = frame.window.least + j;
    return static_cast<unsigned>(prior.at(d) >> shift) |
           static_cast<unsigned>(prior.at(d + frame.words()) >> shift) << 16;
}

/// What the prior adds to `kPixels` pixels side by side, the first in an even column, two words
/// after two words.
///
/// Pixels that share a coarse one share its prior, but for how much of it they take. So the
/// prior is prepared once for two pixels: divided by four it is 0 .. 4, a digit of a selector,
/// with which a byte permutation looks up four additions at once in the table of the pixel.
template <typename Cell, int kPixels>
class StripPrior {
    static constexpr int kPairs = kPixels / 2;
    static_assert(kPriorMax == 4 && kPriorCap >> kPriorShiftTextured == 1);

public:
    /// Stands before word `word`, which is even.
    __device__ StripPrior(const WindowFrame<Cell>& frame, int row, int col, int word)
        : adds_(frame.job->add_prior), half_(frame.words() / 2)
    {
        const SolveJob<Cell>& job = *frame.job;
        const int last = frame.end_col - 1;
        const int first = frame.window.least + word;
        odd_ = (first & 1) != 0;
#pragma unroll
        for (int k = 0; k < kPixels; ++k) {
            const bool flat = adds_ && job.low_texture.at(row, least_of(col + k, last)) != 0;
            table_[k] = flat ? 0x03020100U : 0;
        }
#pragma unroll
        for (int pair = 0; pair < kPairs; ++pair) {
            selector_[pair] = 0;
            if (adds_) {
                const int coarse_col = least_of(col + 2 * pair, last) / 2;
                const Window& coarse = job.coarser.window_at(row / 2, coarse_col);
                values_[pair] = job.coarser.prior_at(row / 2, coarse_col);
                index_[pair] = floor_divided(first, 2) - coarse.least;
                count_[pair] = coarse.count;
                here_[pair] = values_at(pair);
            }
        }
    }

    /// Goes to the next two words, which lie between two coarse disparities and the next ones.
    __device__ void next()
    {
        if (!adds_) {
            return;
        }
#pragma unroll
        for (int pair = 0; pair < kPairs; ++pair) {
            const unsigned before = here_[pair];
            ++index_[pair];
            here_[pair] = values_at(pair);
            const unsigned own = digits(odd_ ? here_[pair] : before, kPriorShift);
            const unsigned mean = digits(before + here_[pair] + 0x00010001U, kPriorShift + 1);
            const unsigned both = (odd_ ? mean : own) + (odd_ ? own : mean) * 0x100U;
            selector_[pair] = both | both >> 12;
        }
    }

    /// For pixel `k`, two bytes for each of the two words.
    __device__ unsigned bytes(int k) const
    {
        return __byte_perm(table_[k], (table_[k] >> 24) + 1, selector_[k / 2]);
    }

private:
    // Of a coarse disparity of either half of a word.
    __device__ unsigned values_at(int pair) const
    {
        return value_at(pair, index_[pair]) + value_at(pair, index_[pair] + half_) * 0x10000U;
    }
    __device__ unsigned value_at(int pair, int index) const
    {
        return static_cast<unsigned>(index) < static_cast<unsigned>(count_[pair])
                   ? values_[pair][index]
                   : unsigned{kPriorCap};
    }
    __device__ static unsigned digits(unsigned pair, int shift)
    {
        return pair >> shift & 0x00070007U;
    }

    bool adds_;
    bool odd_;
    int half_;
    unsigned table_[kPixels]; ///< additions for 0 .. 3; for 4, one more than the last
    const std::uint8_t* values_[kPairs];
    int index_[kPairs];
    int count_[kPairs];
    unsigned here_[kPairs];
    unsigned selector_[kPairs];
};

} // namespace hsgm::matcher::cuda
