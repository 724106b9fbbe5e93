#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace hsgm::matcher {

/// Why a pixel has no value, or what to know about the one it has. Bits of a uint16 mask.
enum Reason : std::uint16_t {
    kOutside = 1 << 0,      ///< no counterpart inside the right image
    kNodataLeft = 1 << 1,   ///< the left pixel itself is nodata
    kNodataRight = 1 << 2,  ///< its counterpart is nodata
    kOccluded = 1 << 3,     ///< not seen in the right image (left-right check)
    kInconsistent = 1 << 4, ///< left and right view disagree (mismatch)
    kSpeckle = 1 << 5,      ///< part of a patch too small to be believed
    kUncertain = 1 << 6,    ///< less confident than was asked for
    kFailedTile = 1 << 7,   ///< its tile could not be matched; the run's ledger says why
    // Bits from 8 on inform about a pixel that may well have a value.
    kLowTexture = 1 << 8, ///< flat neighbourhood: the value leans on what lies around it
    kRangeEnd = 1 << 9,   ///< the first or last disparity asked for: the truth may lie beyond
    kInterpolated = 1 << 10, ///< not measured: made up from what lies round a hole
};

/// Bits that take a pixel's value away.
constexpr std::uint16_t kInvalidating = 0x00FF;

/// Bit and name of every reason, for metadata and documentation.
constexpr std::array<std::pair<Reason, std::string_view>, 11> kReasonNames{{
    {kOutside, "outside"},
    {kNodataLeft, "nodata_left"},
    {kNodataRight, "nodata_right"},
    {kOccluded, "occluded"},
    {kInconsistent, "inconsistent"},
    {kSpeckle, "speckle"},
    {kUncertain, "uncertain"},
    {kFailedTile, "failed_tile"},
    {kLowTexture, "low_texture"},
    {kRangeEnd, "range_end"},
    {kInterpolated, "interpolated"},
}};

} // namespace hsgm::matcher
