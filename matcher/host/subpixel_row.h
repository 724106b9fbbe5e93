#pragma once

#include <array>
#include <cstdint>

namespace hsgm::matcher::host {

/// Disparities d - 2 .. d + 2 round a winner d.
constexpr int kComparisons = 5;

/// The winners of a row of pixels (kNoWinner: a hole), and how many bits of the sparse census
/// differ from the right pixel at each of the five disparities round the winner. Undefined for
/// holes. Readable 3 pixels before the first, and to the end of a vector that starts 3 behind
/// the last.
struct ComparedRow {
    const std::int16_t* winners;
    std::array<const std::uint16_t*, kComparisons> bits;
};

/// One row of words to compare, readable to the end of the last vector, as far as `right_count`
/// does not say otherwise.
struct WordsRow {
    const std::uint16_t* left;
    const std::uint16_t* right;       ///< of right columns right_begin..
    const std::uint16_t* right_valid; ///< 1, or 0 where there is no right pixel to compare
    int right_begin;
    int right_count; ///< at least kComparisons, and a vector beyond
    int first_col;   ///< global column of the first left pixel
    int cols;
};

/// Fills in the bits of `cols` pixels with these winners; `bits` may be written to the end of
/// the last vector.
void compare_words(const WordsRow& row, const std::int16_t* winners,
                   const std::array<std::uint16_t*, kComparisons>& bits);

/// Winners of disparities in 1/256 px, kNoWinner for kHole. Writes to the end of the last
/// vector.
void winners_of(const std::int32_t* disparity_q8, int cols, std::int16_t* winners);

/// New disparities of a row: `rows` are 3 px above, at, and 3 px below it. Winners at the ends
/// of the asked range, `asked_min` and `asked_max`, keep what they have.
struct FractionRow {
    std::array<ComparedRow, 3> rows;
    const std::int32_t* disparity_q8;
    int cols;
    int asked_min;
    int asked_max;
};
void fractions(const FractionRow& row, std::int32_t* result_q8);

} // namespace hsgm::matcher::host
