#include "matcher/host/window_range.h"

#include <algorithm>
#include <array>
#include <vector>

namespace hsgm::matcher::host {

namespace {

using tiling::Rect;

constexpr int kFootprintMargin = 1;
constexpr std::size_t kDropped = 2;
constexpr int kMargin = 4;

// Of every column's three values: sorted, as three rows of `count`.
struct SortedColumns {
    explicit SortedColumns(int count)
        : low(std::size_t(count)), middle(std::size_t(count)), high(std::size_t(count))
    {
    }
    void sort(const std::int16_t* a, const std::int16_t* b, const std::int16_t* c)
    {
        for (std::size_t i = 0; i < low.size(); ++i) {
            const std::int16_t least = std::min(a[i], b[i]);
            const std::int16_t most = std::max(a[i], b[i]);
            low[i] = std::min(least, c[i]);
            high[i] = std::max(most, c[i]);
            middle[i] = std::max(least, std::min(most, c[i]));
        }
    }

    std::vector<std::int16_t> low;
    std::vector<std::int16_t> middle;
    std::vector<std::int16_t> high;
};

std::int16_t middle_of(std::int16_t a, std::int16_t b, std::int16_t c)
{
    return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

// The median of nine is the middle one of the greatest low, the middle middle and the least
// high of three sorted columns (Paeth, Graphics Gems 1990). No branches, so that the
// compiler makes vectors of it.
void medians_of_columns(const SortedColumns& s, std::size_t begin, std::size_t end,
                        std::int16_t* out)
{
    for (std::size_t i = begin; i < end; ++i) {
        const std::int16_t low = std::max(std::max(s.low[i - 1], s.low[i]), s.low[i + 1]);
        const std::int16_t high = std::min(std::min(s.high[i - 1], s.high[i]), s.high[i + 1]);
        out[i - begin] =
            middle_of(low, middle_of(s.middle[i - 1], s.middle[i], s.middle[i + 1]), high);
    }
}

std::int16_t median_at(const SortedColumns& s, std::size_t before, std::size_t at,
                       std::size_t after)
{
    const std::int16_t low = std::max(std::max(s.low[before], s.low[at]), s.low[after]);
    const std::int16_t high = std::min(std::min(s.high[before], s.high[at]), s.high[after]);
    return middle_of(low, middle_of(s.middle[before], s.middle[at], s.middle[after]), high);
}

tiling::DisparityRange rounded_range(tiling::DisparityRange needed,
                                     tiling::DisparityRange level)
{
    const int count = (needed.count() + 15) / 16 * 16;
    if (count >= level.count()) {
        return level;
    }
    const int low =
        std::clamp(needed.min - (count - needed.count()) / 2, level.min, level.max - count + 1);
    return {low, low + count - 1};
}

// The kDropped + 1 least and greatest values met so far.
class Extremes {
public:
    void meet(std::int16_t value)
    {
        if (count_ <= kDropped || value < lowest_.back()) {
            insert(lowest_, value, [](auto a, auto b) { return a < b; });
        }
        if (count_ <= kDropped || value > highest_.back()) {
            insert(highest_, value, [](auto a, auto b) { return a > b; });
        }
        ++count_;
    }
    // Without the kDropped most extreme on either side, if there are enough.
    std::size_t dropped() const { return count_ >= 2 * kDropped + 1 ? kDropped : 0; }
    int lowest() const { return lowest_[dropped()]; }
    int highest() const { return highest_[dropped()]; }

private:
    using Sorted = std::array<std::int16_t, kDropped + 1>;

    template <typename Before>
    void insert(Sorted& sorted, std::int16_t value, Before before) const
    {
        std::size_t i = std::min(count_, kDropped);
        for (; i > 0 && before(value, sorted[i - 1]); --i) {
            sorted[i] = sorted[i - 1];
        }
        sorted[i] = value;
    }

    std::size_t count_ = 0;
    Sorted lowest_{};
    Sorted highest_{};
};

} // namespace

tiling::Patch<std::int16_t> winner_medians(const tiling::Patch<std::int16_t>& winners,
                                           tiling::Size size)
{
    const Rect& all = winners.rect;
    const int top = all.row > 0 ? all.row + 1 : 0;
    const int left = all.col > 0 ? all.col + 1 : 0;
    const int bottom = all.row_end() < size.rows ? all.row_end() - 1 : size.rows;
    const int right = all.col_end() < size.cols ? all.col_end() - 1 : size.cols;
    if (top >= bottom || left >= right) {
        return {};
    }
    tiling::Patch<std::int16_t> medians(tiling::rect_between(top, left, bottom, right));
    SortedColumns columns(all.cols);
    for (int row = top; row < bottom; ++row) {
        columns.sort(&winners.at(std::max(row - 1, 0), all.col), &winners.at(row, all.col),
                     &winners.at(std::min(row + 1, size.rows - 1), all.col));
        std::int16_t* out = &medians.at(row, left);
        const auto first = static_cast<std::size_t>(left - all.col);
        const auto last = static_cast<std::size_t>(right - 1 - all.col);
        const auto inner_begin = std::max<std::size_t>(first, 1);
        const auto inner_end = std::min<std::size_t>(last + 1, std::size_t(all.cols) - 1);
        if (inner_begin < inner_end) {
            medians_of_columns(columns, inner_begin, inner_end, out + (inner_begin - first));
        }
        if (first == 0) {
            out[0] =
                median_at(columns, 0, 0, std::min<std::size_t>(1, std::size_t(all.cols) - 1));
        }
        if (last + 1 == std::size_t(all.cols)) {
            out[last - first] = median_at(columns, last > 0 ? last - 1 : 0, last, last);
        }
    }
    return medians;
}

tiling::DisparityRange window_range(const tiling::Patch<std::int16_t>& coarse_medians,
                                    tiling::Size coarse_size, const tiling::Rect& core,
                                    tiling::DisparityRange level)
{
    const Rect footprint =
        intersect(expand(halve(core), kFootprintMargin), rect_of(coarse_size));
    Extremes extremes;
    for (int row = footprint.row; row < footprint.row_end(); ++row) {
        const std::int16_t* medians = &coarse_medians.at(row, footprint.col);
        for (int i = 0; i < footprint.cols; ++i) {
            extremes.meet(medians[i]);
        }
    }
    return rounded_range(
        {2 * extremes.lowest() - kMargin, 2 * extremes.highest() + 1 + kMargin}, level);
}

} // namespace hsgm::matcher::host
