#include "matcher/noise.h"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <vector>

namespace hsgm::matcher {

namespace {

// Of the 8 rows that blocks share, column by column.
struct ColumnSums {
    std::vector<std::uint32_t> difference; // |L| over the 6 inner rows
    std::vector<std::uint16_t> largest;

    explicit ColumnSums(std::size_t cols) : difference(cols), largest(cols) {}
};

// Adds |L| of a row, L = the image convolved with 1 -2 1 across and 1 -2 1 down.
void add_differences(const std::uint16_t* above, const std::uint16_t* here,
                     const std::uint16_t* below, int cols, std::uint32_t* sums)
{
    for (int c = 1; c + 1 < cols; ++c) {
        const int before = above[c - 1] - 2 * here[c - 1] + below[c - 1];
        const int at = above[c] - 2 * here[c] + below[c];
        const int after = above[c + 1] - 2 * here[c + 1] + below[c + 1];
        sums[c] += static_cast<std::uint32_t>(std::abs(before - 2 * at + after));
    }
}

void sum_columns(tiling::ImageView<const std::uint16_t> strip, int row, ColumnSums& sums)
{
    std::fill(sums.difference.begin(), sums.difference.end(), 0U);
    std::fill(sums.largest.begin(), sums.largest.end(), std::uint16_t{0});
    const int cols = strip.cols();
    for (int r = row; r < row + kNoiseBlock; ++r) {
        for (int c = 0; c < cols; ++c) {
            auto& largest = sums.largest[static_cast<std::size_t>(c)];
            largest = std::max(largest, strip.row(r)[c]);
        }
        if (r > row && r + 1 < row + kNoiseBlock) {
            add_differences(strip.row(r - 1), strip.row(r), strip.row(r + 1), cols,
                            sums.difference.data());
        }
    }
}

// sqrt(pi / 2) / 6 of the mean of 36 |L|, in 1/65536: 380.27.
constexpr std::int64_t kNoiseOfSum = 380;

} // namespace

void NoiseCounts::add(tiling::ImageView<const std::uint16_t> strip)
{
    ColumnSums sums(static_cast<std::size_t>(strip.cols()));
    for (int row = 0; row + kNoiseBlock <= strip.rows(); row += kNoiseBlock) {
        sum_columns(strip, row, sums);
        for (int col = 0; col + kNoiseBlock <= strip.cols(); col += kNoiseBlock) {
            std::int64_t sum = 0;
            for (int c = col + 1; c + 1 < col + kNoiseBlock; ++c) {
                sum += sums.difference[static_cast<std::size_t>(c)];
            }
            const auto begin = sums.largest.begin() + col;
            if (sum > 0 && is_valid(*std::max_element(begin, begin + kNoiseBlock))) {
                const std::int64_t noise = (sum * kNoiseOfSum + 32768) >> 16;
                ++(*counts_)[static_cast<std::size_t>(
                    std::min<std::int64_t>(noise, kMostNoise))];
            }
        }
    }
}

void NoiseCounts::add(const NoiseCounts& part)
{
    std::transform(counts_->begin(), counts_->end(), part.counts_->begin(), counts_->begin(),
                   std::plus<>());
}

int NoiseCounts::noise() const
{
    std::uint64_t all = 0;
    for (const std::uint64_t count : *counts_) {
        all += count;
    }
    std::uint64_t calmer = 0;
    for (std::size_t noise = 0; noise < counts_->size() && all > 0; ++noise) {
        calmer += (*counts_)[noise];
        if (10 * calmer >= all) {
            return static_cast<int>(noise);
        }
    }
    return 0;
}

int noise_of(tiling::ImageView<const std::uint16_t> image)
{
    NoiseCounts counts;
    counts.add(image);
    return counts.noise();
}

void agree_on_noise(Tone& left, Tone& right)
{
    if (left.noise == 0 || right.noise == 0) {
        left.noise = right.noise = 0;
    }
}

} // namespace hsgm::matcher
