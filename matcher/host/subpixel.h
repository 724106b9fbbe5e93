#pragma once

#include "matcher/host/disparity_plane.h"
#include "matcher/level_plan.h"

namespace hsgm::matcher::host {

/// How far round a pixel its fraction looks for other pixels, in rows and columns.
constexpr int kSubpixelReach = 3;

/// What `refine_fractions` reads. The plane must hold the pixels asked for, grown by
/// `kSubpixelReach` and clipped to the image; the images what `subpixel_images` says.
struct SubpixelInput {
    const DisparityPlane& disparities;
    const tiling::Patch<std::uint16_t>& left;
    const tiling::Patch<std::uint16_t>& right;
    const PairShape& shape;
};

/// The parts of both images that are read for `wanted`.
struct SubpixelImages {
    tiling::Rect left;
    tiling::Rect right;
};
SubpixelImages subpixel_images(const tiling::Rect& wanted, const PairShape& shape);

/// New fractions for the disparities of `result`'s rectangle, by the sparse census
/// (docs/algorithm.md, section 6, step 6).
void refine_fractions(const SubpixelInput& input, DisparityPlane& result);

/// Upper bound of what `refine_fractions` takes for itself.
std::int64_t subpixel_bytes(const tiling::Rect& wanted, const PairShape& shape);

} // namespace hsgm::matcher::host
