#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace hsgm::dsm {

/// Why a cell has no height.
enum class Missing : std::uint8_t {
    none = 0,           ///< it has one
    outside = 1,        ///< not in what both images show
    outside_region = 2, ///< not in the region that was asked for
    masked_left = 3,    ///< the left image has no value there: nodata or masked
    masked_right = 4,   ///< likewise the right image
    occluded = 5,       ///< seen by the left image, hidden from the right one
    hidden = 6,         ///< no pixel of the left image shows it
    inconsistent = 7, ///< both views disagree: a mismatch, or a patch too small to be believed
    uncertain = 8,    ///< less confident than was asked for
    failed_tile = 9,  ///< its tile could not be matched
};

/// Number and name of every reason, for metadata and documentation.
constexpr std::array<std::pair<Missing, std::string_view>, 10> kMissingNames{{
    {Missing::none, "none"},
    {Missing::outside, "outside"},
    {Missing::outside_region, "outside_region"},
    {Missing::masked_left, "masked_left"},
    {Missing::masked_right, "masked_right"},
    {Missing::occluded, "occluded"},
    {Missing::hidden, "hidden"},
    {Missing::inconsistent, "inconsistent"},
    {Missing::uncertain, "uncertain"},
    {Missing::failed_tile, "failed_tile"},
}};

} // namespace hsgm::dsm
