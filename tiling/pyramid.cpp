#include "tiling/pyramid.h"

namespace hsgm::tiling {

std::vector<Size> pyramid_sizes(Size full, int levels)
{
    std::vector<Size> sizes{full};
    while (static_cast<int>(sizes.size()) < levels) {
        sizes.push_back(halve(sizes.back()));
    }
    return sizes;
}

Rect pyramid_taps(const Rect& coarse)
{
    return rect_between(2 * coarse.row - 1, 2 * coarse.col - 1, 2 * coarse.row_end() + 1,
                        2 * coarse.col_end() + 1);
}

std::vector<DisparityRange> pyramid_ranges(DisparityRange asked, int levels)
{
    std::vector<DisparityRange> ranges{asked};
    const int step = 1 << (levels - 1);
    const int lowest = floor_div(asked.min, step) * step;
    const int highest = floor_div(asked.max, step) * step + step - 1;
    for (int level = 1; level < levels; ++level) {
        const int scale = 1 << level;
        ranges.push_back({lowest / scale, floor_div(highest, scale)});
    }
    return ranges;
}

} // namespace hsgm::tiling
