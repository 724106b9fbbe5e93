#include "matcher/host/subpixel.h"

#include "matcher/host/sparse_census.h"
#include "matcher/host/subpixel_row.h"
#include "matcher/pixel.h"

#include <algorithm>
#include <array>
#include <vector>

namespace hsgm::matcher::host {

namespace {

using tiling::Rect;

constexpr int kRows = 2 * kSubpixelReach + 1; // from the one above to the one below
constexpr int kPad = 64;                      // pixels that vectors may touch on either side
constexpr int kRightPad = 2;                  // right pixels that are met beyond the winners

// The pixels that are compared: those asked for, and their neighbours.
Rect compared(const Rect& wanted, const PairShape& shape)
{
    return intersect(expand(wanted, kSubpixelReach), rect_of(shape.left));
}

// The columns of the right image that they meet.
Rect met(const Rect& wanted, const PairShape& shape)
{
    Rect reach = right_reach(compared(wanted, shape), shape.asked);
    reach.col -= kRightPad;
    reach.cols += 2 * kRightPad;
    return intersect(reach, rect_of(shape.right));
}

Rect census_pixels(const Rect& words, tiling::Size image)
{
    return words.empty() ? words
                         : intersect(expand(words, SparseCensus::kRadius), rect_of(image));
}

// Winners and bits of one row, with room for vectors.
class Row {
public:
    explicit Row(int cols) : winners_(std::size_t(cols + 2 * kPad), kNoWinner)
    {
        for (auto& one : bits_) {
            one.resize(winners_.size());
        }
    }
    std::int16_t* winners() { return winners_.data() + kPad; }
    std::array<std::uint16_t*, kComparisons> bits()
    {
        std::array<std::uint16_t*, kComparisons> result{};
        for (std::size_t k = 0; k < bits_.size(); ++k) {
            result[k] = bits_[k].data() + kPad;
        }
        return result;
    }
    // From column `skip` on.
    ComparedRow view(int skip)
    {
        ComparedRow result{winners() + skip, {}};
        for (std::size_t k = 0; k < bits_.size(); ++k) {
            result.bits[k] = bits_[k].data() + kPad + skip;
        }
        return result;
    }

private:
    std::vector<std::int16_t> winners_;
    std::array<std::vector<std::uint16_t>, kComparisons> bits_;
};

// The rows that one row of results looks at, made one after the other.
class Comparisons {
public:
    Comparisons(const SubpixelInput& input, const Rect& wanted)
        : input_(input), area_(compared(wanted, input.shape)), met_(met(wanted, input.shape)),
          left_(input.left, input.shape.left, area_.col, area_.col_end()),
          right_(input.right, input.shape.right, met_.col, met_.col_end()),
          left_words_(std::size_t(area_.cols + kPad)),
          right_words_(std::size_t(met_.cols + 2 * kPad)), right_valid_(right_words_.size()),
          rows_(kRows, Row(area_.cols)), none_(area_.cols)
    {
    }

    const Rect& area() const { return area_; }

    // Rows outside the image are all holes.
    Row& at(int row)
    {
        return row < area_.row || row >= area_.row_end()
                   ? none_
                   : rows_[static_cast<std::size_t>(row % kRows)];
    }

    void make(int row)
    {
        if (row < area_.row || row >= area_.row_end()) {
            return;
        }
        Row& out = at(row);
        winners_of(input_.disparities.at(row, area_.col), area_.cols, out.winners());
        std::fill_n(out.winners() + area_.cols, kPad, kNoWinner);
        left_.row(row, left_words_.data());
        if (!met_.empty()) {
            make_right(row);
        }
        const WordsRow words{left_words_.data(),
                             right_words_.data(),
                             right_valid_.data(),
                             met_.col - kPad,
                             static_cast<int>(right_words_.size()),
                             area_.col,
                             area_.cols};
        compare_words(words, out.winners(), out.bits());
    }

private:
    void make_right(int row)
    {
        right_.row(row, right_words_.data() + kPad);
        const std::uint16_t* pixels = &input_.right.at(row, met_.col);
        std::uint16_t* valid = right_valid_.data() + kPad;
        for (int i = 0; i < met_.cols; ++i) {
            valid[i] = is_valid(pixels[i]) ? 1 : 0;
        }
    }

    const SubpixelInput& input_;
    Rect area_;
    Rect met_;
    SparseCensus left_;
    SparseCensus right_;
    std::vector<std::uint16_t> left_words_;
    std::vector<std::uint16_t> right_words_;
    std::vector<std::uint16_t> right_valid_;
    std::vector<Row> rows_;
    Row none_;
};

} // namespace

SubpixelImages subpixel_images(const Rect& wanted, const PairShape& shape)
{
    return {census_pixels(compared(wanted, shape), shape.left),
            census_pixels(met(wanted, shape), shape.right)};
}

void refine_fractions(const SubpixelInput& input, DisparityPlane& result)
{
    const Rect& wanted = result.rect();
    if (wanted.empty()) {
        return;
    }
    Comparisons comparisons(input, wanted);
    const int skip = wanted.col - comparisons.area().col;
    for (int row = wanted.row - kSubpixelReach; row < wanted.row + kSubpixelReach; ++row) {
        comparisons.make(row);
    }
    for (int row = wanted.row; row < wanted.row_end(); ++row) {
        comparisons.make(row + kSubpixelReach);
        const FractionRow one{{comparisons.at(row - kSubpixelReach).view(skip),
                               comparisons.at(row).view(skip),
                               comparisons.at(row + kSubpixelReach).view(skip)},
                              input.disparities.at(row, wanted.col),
                              wanted.cols,
                              input.shape.asked.min,
                              input.shape.asked.max};
        fractions(one, result.at(row, wanted.col));
        result.close_row(row);
    }
}

std::int64_t subpixel_bytes(const Rect& wanted, const PairShape& shape)
{
    const std::int64_t row =
        2 * (1 + kComparisons) * (wanted.cols + 2 * kSubpixelReach + 2 * kPad);
    const std::int64_t words = 2 * 6 * (wanted.cols + 2 * kPad) +
                               2 * 7 * (std::int64_t{met(wanted, shape).cols} + 2 * kPad);
    return (kRows + 1) * row + words;
}

} // namespace hsgm::matcher::host
