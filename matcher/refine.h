#pragma once

#include "matcher/level_plan.h"
#include "matcher/options.h"
#include "tiling/image.h"

#include <cstdint>

namespace hsgm::matcher {

/// What the second pass of a piece depends on, in global pixels, clipped to the images.
struct RefineSupport {
    tiling::Rect first_pass;  ///< of the left image: disparity, confidence, reasons
    tiling::Rect right_keys;  ///< of the right image
    tiling::Rect left_image;  ///< pixels; empty without `subpixel: census`
    tiling::Rect right_image; ///< likewise
};

/// The support of the piece `core` of the left image. It grows with what the options look at:
/// speckles by their size, holes by `fill_px`.
RefineSupport refine_support(const tiling::Rect& core, const PairShape& shape,
                             const Options& options);

/// First-pass results and full-resolution pixels of at least a piece's support.
struct RefineInput {
    tiling::Patch<std::int32_t> disparity_q8;
    tiling::Patch<std::uint8_t> confidence; ///< how clearly the winner won
    tiling::Patch<std::uint16_t> reasons;
    tiling::Patch<std::uint32_t> right_keys; ///< finished: of all tiles
    tiling::Patch<std::uint16_t> left;       ///< 65535 = nodata
    tiling::Patch<std::uint16_t> right;
};

/// Value of `Refined::disparity` where there is none.
constexpr float kNodataDisparity = -32768.0F;

struct Refined {
    tiling::Image<float> disparity_px;      ///< kNodataDisparity where a reason forbids a value
    tiling::Image<std::uint8_t> confidence; ///< 0 where there is no value
    tiling::Image<std::uint16_t> reasons;
};

/// The second pass (docs/algorithm.md, section 6): left-right check, speckles, fractions,
/// confidence, median, holes. The same for every cut of the image into pieces. Throws
/// std::invalid_argument where the input is smaller than the support.
Refined refine(const tiling::Rect& core, const RefineInput& input, const PairShape& shape,
               const Options& options);

/// Upper bound of what `refine` takes for this piece, its input and result included.
std::int64_t refine_bytes(const tiling::Rect& core, const PairShape& shape,
                          const Options& options);

} // namespace hsgm::matcher
