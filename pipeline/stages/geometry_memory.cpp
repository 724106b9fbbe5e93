// What the search for a pair's geometry takes.

#include "pipeline/stages/geometry_search.h"
#include "pipeline/stages/sensor_view.h"

#include <algorithm>

namespace hsgm::pipeline {

std::int64_t geometry_search_bytes(tiling::Size left, tiling::Size right)
{
    // Features of two patches at full resolution: SIFT's pyramids of images twice as wide.
    constexpr std::int64_t kPatchBytes = std::int64_t{120} << 20;
    // The reduced images as they are and drawn into a frame, which may lie aslant, and their
    // match: 60 bytes of each image's pixels were measured at 1, 4.7 and 19 Mpx.
    constexpr std::int64_t kPixelBytes = 100;
    const int factor = std::max(reduction_of(left), reduction_of(right));
    const auto reduced = [&](tiling::Size size) {
        return std::int64_t{tiling::ceil_div(size.rows, factor)} *
               tiling::ceil_div(size.cols, factor);
    };
    return kPatchBytes + kPixelBytes * (reduced(left) + reduced(right));
}

} // namespace hsgm::pipeline
