#include "pipeline/dsm/reason_block.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hsgm::dsm {

namespace {

constexpr int kMostMargin = 8;

} // namespace

ReasonBlock::ReasonBlock(const DsmGrid& grid, const tiling::Rect& cells, double radius)
    : grid_(grid),
      margin_(std::clamp(static_cast<int>(std::ceil(radius / grid.cell)), 1, kMostMargin)),
      bins_(expand(cells, margin_)), reach_(grid.bounds(bins_))
{
}

void ReasonBlock::add(double x, double y, Missing reason)
{
    const double col =
        std::floor(x / grid_.cell) - static_cast<double>(grid_.first_col + bins_.col);
    const double row =
        std::floor(-y / grid_.cell) - static_cast<double>(grid_.first_row + bins_.row);
    if (!(col >= 0 && row >= 0 && col < bins_.cols && row < bins_.rows)) {
        return;
    }
    if (counts_.empty()) {
        counts_.resize(static_cast<std::size_t>(bins_.area()) * kReasons);
    }
    const auto bin = static_cast<std::size_t>(row) * static_cast<std::size_t>(bins_.cols) +
                     static_cast<std::size_t>(col);
    std::uint16_t& count = counts_[bin * kReasons + static_cast<std::size_t>(reason)];
    if (count < std::numeric_limits<std::uint16_t>::max()) {
        ++count;
    }
}

void ReasonBlock::add_counts(int row, int col, Counts& counts) const
{
    const std::size_t bin =
        (static_cast<std::size_t>(row) * static_cast<std::size_t>(bins_.cols) +
         static_cast<std::size_t>(col)) *
        kReasons;
    for (std::size_t reason = 0; reason < kReasons; ++reason) {
        counts[reason] += counts_[bin + reason];
    }
}

Missing ReasonBlock::most(int row, int col) const
{
    if (counts_.empty()) {
        return Missing::none;
    }
    for (int distance = 0; distance <= margin_; ++distance) {
        Counts counts{};
        for (int r = row - distance; r <= row + distance; ++r) {
            const bool whole_row = r == row - distance || r == row + distance;
            const int step = whole_row ? 1 : std::max(2 * distance, 1);
            for (int c = col - distance; c <= col + distance; c += step) {
                add_counts(r + margin_, c + margin_, counts);
            }
        }
        const auto most = std::max_element(counts.begin(), counts.end());
        if (*most > 0) {
            return static_cast<Missing>(most - counts.begin());
        }
    }
    return Missing::none;
}

std::int64_t reason_block_bytes(tiling::Size cells)
{
    return expand(rect_of(cells), kMostMargin).area() *
           static_cast<std::int64_t>(kMissingNames.size() * sizeof(std::uint16_t));
}

} // namespace hsgm::dsm
