#pragma once

#include <cstdint>
#include <span>

namespace hsgm::matcher::host {

/// The lowest index of the least sum; ties go to the lowest disparity.
struct Winner {
    int index;
    int sum;
};
Winner find_winner(std::span<const std::uint16_t> sums);

/// The least sum at least two disparities away from the winner; -1 if there is none.
int rival_sum(std::span<const std::uint16_t> sums, int winner);

/// keys[i] = min(keys[i], sums[i] << 16 | (first + i)): the right view's candidates.
void merge_keys(std::span<const std::uint16_t> sums, std::uint32_t first, std::uint32_t* keys);

/// q of every disparity (docs/algorithm.md, section 3) from the sums of a pixel.
void prior_from_sums(std::span<const std::uint16_t> sums, int least, int paths,
                     std::uint8_t* prior);

} // namespace hsgm::matcher::host
