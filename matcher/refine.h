#pragma once

#include "matcher/level_plan.h"
#include "matcher/options.h"
#include "tiling/image.h"

#include <cstdint>

namespace hsgm::matcher {

/// Pixels round a piece that its second pass reads: the reach of the median.
int refine_margin_px(const Options& options);

/// First-pass results for a piece of the left image grown by `refine_margin_px` and clipped
/// to the image, and the finished right-view keys of the same rows, for the columns
/// [col - asked.max, col_end - asked.min) of that grown rectangle, clipped to the right image.
struct RefineInput {
    tiling::Patch<std::int32_t> disparity_q8;
    tiling::Patch<std::uint8_t> confidence;
    tiling::Patch<std::uint16_t> reasons;
    tiling::Patch<std::uint32_t> right_keys;
};

/// Value of `Refined::disparity` where there is none.
constexpr float kNodataDisparity = -32768.0F;

struct Refined {
    tiling::Image<float> disparity_px;      ///< kNodataDisparity where a reason forbids a value
    tiling::Image<std::uint8_t> confidence; ///< 0 where there is no value
    tiling::Image<std::uint16_t> reasons;
};

/// The columns of the right image whose keys `refine` wants for the grown rectangle.
tiling::Rect keys_of(const tiling::Rect& grown, const PairShape& shape);

/// The second pass (docs/algorithm.md, section 6): left-right check, reasons, median.
Refined refine(const tiling::Rect& core, const RefineInput& input, const PairShape& shape,
               const Options& options);

} // namespace hsgm::matcher
