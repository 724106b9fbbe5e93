#pragma once

#include "matcher/cuda/cost_rules.cuh"
#include "matcher/cuda/path_step.cuh"
#include "matcher/cuda/right_row.cuh"
#include "matcher/cuda/strip_prior.cuh"

namespace hsgm::matcher::cuda {

/// Fills a strip with costs that are sums over the 3 x 3 pixels round the left one, at the same
/// disparity: birchfield_tomasi.
///
/// A thread goes down a few columns with one word of disparities. Of every row it adds up the
/// differences of three columns, and keeps these sums for three rows.
template <typename Cell, typename Group>
class BlockCosts {
    static constexpr int kPixels = 4;
    static constexpr int kCols = kPixels + 2;

public:
    __device__ BlockCosts(const WindowFrame<Cell>& frame, const Strip& strip)
        : frame_(frame), job_(*frame.job), strip_(strip)
    {
    }

    __device__ void fill()
    {
        const int across = (frame_.end_col - frame_.first_col + kPixels - 1) / kPixels;
        const int words = frame_.words();
        for (int p = static_cast<int>(threadIdx.x); p < across * words;
             p += static_cast<int>(blockDim.x)) {
            fill_columns(frame_.first_col + p / words * kPixels, p % words);
        }
    }

private:
    // Two costs, or sums of differences, of some pixels of a row.
    struct Pairs {
        unsigned of[kPixels];
    };

    __device__ void fill_columns(int col, int word)
    {
        Pairs above = columns_of(strip_.row - 1, col, word);
        Pairs here = columns_of(strip_.row, col, word);
#pragma unroll 1
        for (int row = strip_.row; row < strip_.row_end(); ++row) {
            const Pairs below = columns_of(row + 1, col, word);
#pragma unroll
            for (int k = 0; k < kPixels; ++k) {
                if (col + k < frame_.end_col) {
                    const unsigned sum = above.of[k] + here.of[k] + below.of[k];
                    store(sum >> 2 & 0x003F003FU, row, col + k, word);
                }
            }
            above = here;
            here = below;
        }
    }

    // Differences of the pixels of a row and of those beside them. Beyond the image are the
    // pixels of its border; what lies beyond the features for other reasons is not asked for.
    __device__ __forceinline__ Pairs columns_of(int row_wanted, int col, int word) const
    {
        const Area& area = job_.left.area;
        const int row = clamped(row_wanted, area.row, area.row_end() - 1);
        const RightRow<Feature> right(job_.right, row);
        Pairs sums{};
#pragma unroll 1 // registers are scarce
        for (int i = 0; i < kCols; ++i) {
            const int at = clamped(col - 1 + i, area.col, area.col_end() - 1);
            const SampleDifference difference(job_.left.at(row, at));
            const int meets = at - frame_.window.least - word;
            const unsigned pair = difference(right.at(meets)) |
                                  difference(right.at(meets - frame_.words())) << 16;
#pragma unroll
            for (int k = 0; k < kPixels; ++k) {
                sums.of[k] += k <= i && i <= k + 2 ? pair : 0;
            }
        }
        return sums;
    }

    // As StripCosts does, where the four costs of two words share 32 bits.
    __device__ void store(unsigned pair, int row, int col, int word)
    {
        const RightRow<Feature> right(job_.right, row);
        const int meets = col - frame_.window.least - word;
        const unsigned cost = where_valid(pair, job_.left.at(row, col).y, right.at(meets).y,
                                          right.at(meets - frame_.words()).y,
                                          static_cast<unsigned>(job_.cost.most) / 2) +
                              prior_pair(frame_, row, col, word);
        unsigned* const to = frame_.costs + (row - strip_.row) * job_.strips.cost_row +
                             (col - frame_.first_col) * job_.strips.cost_pixel;
        reinterpret_cast<std::uint16_t*>(to)[word] =
            static_cast<std::uint16_t>(stored_costs((cost | cost >> 8) & 0xFFFFU));
    }

    const WindowFrame<Cell>& frame_;
    const SolveJob<Cell>& job_;
    Strip strip_;
};

} // namespace hsgm::matcher::cuda
