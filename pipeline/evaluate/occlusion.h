#pragma once

#include <cstdint>
#include <span>

namespace hsgm::evaluate {

/// Which pixels of the left truth also show in the right image. Both rules write 255 for
/// non-occluded and 0 for occluded or unknown, work on one row (epipolar geometry), take
/// NaN as unknown, and round a position to the nearest pixel, halves up.

/// Where both truths are at hand: pixel x of disparity d is non-occluded where
/// x_right = round(x - d) lies in the right image, its truth is known, and
/// |d - truth_right(x_right)| <= tolerance_px.
void nonoccluded_by_cross_check(std::span<const float> truth_left_px,
                                std::span<const float> truth_right_px,
                                std::span<std::uint8_t> nonoccluded, double tolerance_px = 1.0);

/// Where only the left truth is at hand, a z-buffer: each known pixel lands on column
/// round(x - d) of the right image, of `right_cols` columns. It is occluded where it lands
/// outside, or where another pixel lands on the same column with a disparity larger by more
/// than `tolerance_px`. The tolerance keeps slopes whole, whose neighbours may share a
/// column. Holes in the truth hide nothing, so sparse truth leaves some occluded pixels in.
void nonoccluded_by_zbuffer(std::span<const float> truth_left_px, int right_cols,
                            std::span<std::uint8_t> nonoccluded, double tolerance_px = 1.0);

} // namespace hsgm::evaluate
