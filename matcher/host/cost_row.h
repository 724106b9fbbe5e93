#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace hsgm::matcher::host {

/// One row of pixels to be compared: `cols` left ones, each with `count` right ones. Left
/// pixel i meets entry cols - 1 - i + j of the right runs at its disparity number j.
/// Right runs are readable 64 entries beyond the last one used.
struct CostRow {
    const std::uint8_t* left = nullptr; ///< planes of the left pixels
    std::size_t left_pitch = 0;         ///< from plane to plane
    const std::uint8_t* right = nullptr;
    std::size_t right_pitch = 0;
    const std::uint8_t* left_valid = nullptr;
    const std::uint8_t* right_valid = nullptr; ///< 255, or 0 without a valid counterpart
    const std::uint8_t* padding = nullptr;     ///< `stride` bytes: 0, from `count` on 255
    int cols = 0;
    int count = 0;
    int stride = 0;        ///< bytes of costs for a pixel, a multiple of 16
    std::uint8_t half = 0; ///< cost without a valid counterpart
    bool plain = false;    ///< all counterparts are valid, and count = stride

    /// Right entries that pixels of this row meet.
    int met() const { return cols + count - 1; }
};

} // namespace hsgm::matcher::host
