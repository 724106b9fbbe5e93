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

/// Two planes, each `plane` long, of candidates with even and with odd numbers.
struct CandidatePlanes {
    int plane = 0;
    std::uint16_t* sums = nullptr;
    std::uint16_t* pixels = nullptr;
};

/// Candidates of the right view that one row of left pixels brings: for right pixel number j,
/// counted from the right end, the least sum and which left pixel it is from. Pixel i with
/// disparity index d meets number cols - 1 - i + d. Even and odd numbers lie apart, as the
/// sums do.
class RightCandidates {
public:
    static constexpr std::uint16_t kNobody = 0xFFFF;

    /// Forgets everything; room for rows of this shape.
    void clear(int cols, int stride);
    /// The pixels of `row` for which `valid` is not 0; once after `clear`. Of equal sums the
    /// left-most pixel's stays, which has the lowest disparity.
    void merge(const SumsRow& row, const std::uint8_t* valid);

    /// Lowers right-view keys (docs/algorithm.md, section 5) by the candidates with the
    /// numbers [begin, end): number j meets keys[-(j - begin)], and its disparity is
    /// j + its pixel + `offset` above the least asked one.
    void lower_keys(int begin, int end, int offset, std::uint32_t* keys) const;

private:
    Buffer<std::uint16_t> sums_;
    Buffer<std::uint16_t> pixels_;
    CandidatePlanes left_;  ///< of the row's left half, then of all
    CandidatePlanes right_; ///< of its right half
};

} // namespace hsgm::matcher::host
