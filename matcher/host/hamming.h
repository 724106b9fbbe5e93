#pragma once

#include <cstddef>
#include <cstdint>

namespace hsgm::matcher::host {

/// One row of census words to be compared: `cols` left pixels, each with `count` right ones.
/// Left pixel i meets right[cols - 1 - i + j] at its disparity number j. Entries are readable
/// up to 16 beyond the last one used.
struct HammingRow {
    const std::uint64_t* left = nullptr;
    const std::uint8_t* left_valid = nullptr;
    const std::uint64_t* right = nullptr;
    const std::uint8_t* right_valid = nullptr;
    int cols = 0;
    int count = 0;
    int stride = 0;        ///< bytes of costs for a pixel, a multiple of 16
    bool doubled = false;  ///< a differing bit costs 2 instead of 1
    std::uint8_t most = 0; ///< costs are capped at this
    std::uint8_t half = 0; ///< cost without a valid counterpart
};

/// Costs of the row, padded with 255. Vector code, chosen for the processor at run time.
void hamming_costs(const HammingRow& row, std::uint8_t* costs);

} // namespace hsgm::matcher::host
