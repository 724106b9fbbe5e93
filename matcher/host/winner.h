#pragma once

#include "matcher/host/aligned.h"

#include <cstdint>

namespace hsgm::matcher::host {

/// A row of pixels' sums, laid out as in sums.h; `count` of `stride` disparities are searched.
struct SumsRow {
    const std::uint16_t* sums = nullptr;
    int cols = 0;
    int stride = 0;
    int count = 0;

    const std::uint16_t* at(int col) const
    {
        return sums + static_cast<std::ptrdiff_t>(col) * stride;
    }
};

/// The lowest index of the least sum, and the least sum two or more disparities away from it
/// (-1 if there is none that far).
struct Winner {
    int index;
    int sum;
    int rival;
};

/// The winner of every pixel of the row.
void find_winners(const SumsRow& row, Winner* winners);

/// q of every disparity (docs/algorithm.md, section 3), `stride` in natural order a pixel.
void prior_row(const SumsRow& row, const Winner* winners, int paths, std::uint8_t* prior);

/// Candidates of the right view that one row of left pixels brings: for right pixel number j,
/// counted from the right end, the least sum and which left pixel it is from. Pixel i with
/// disparity index d meets number cols - 1 - i + d. Even and odd numbers lie apart, as the
/// sums do.
class RightCandidates {
public:
    static constexpr std::uint16_t kNobody = 0xFFFF;

    /// Forgets everything; room for rows of this shape.
    void clear(int cols, int stride);
    /// The pixels of `row` for which `valid` is not 0, from left to right: of equal sums the
    /// first stays, which has the lower disparity.
    void merge(const SumsRow& row, const std::uint8_t* valid);

    std::uint16_t sum(int number) const { return sums_[index(number)]; }
    /// The left pixel, or kNobody.
    std::uint16_t pixel(int number) const { return pixels_[index(number)]; }

private:
    std::size_t index(int number) const
    {
        return static_cast<std::size_t>((number % 2 != 0 ? half_ : 0) + number / 2);
    }

    int half_ = 0;
    Buffer<std::uint16_t> sums_buffer_;
    Buffer<std::uint16_t> pixels_buffer_;
    std::uint16_t* sums_ = nullptr;
    std::uint16_t* pixels_ = nullptr;
};

} // namespace hsgm::matcher::host
