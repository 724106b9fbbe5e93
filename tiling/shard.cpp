#include "tiling/shard.h"

#include <stdexcept>
#include <string>
#include <vector>

namespace hsgm::tiling {

namespace {

constexpr int kPieceRows = 64;

// The up to four rectangles of `whole` outside `hole`.
void append_outside(const Rect& whole, const Rect& hole, std::vector<Rect>& parts)
{
    const Rect common = intersect(whole, hole);
    if (common.empty()) {
        parts.push_back(whole);
        return;
    }
    for (const Rect& part :
         {rect_between(whole.row, whole.col, common.row, whole.col_end()),
          rect_between(common.row_end(), whole.col, whole.row_end(), whole.col_end()),
          rect_between(common.row, whole.col, common.row_end(), common.col),
          rect_between(common.row, common.col_end(), common.row_end(), whole.col_end())}) {
        if (!part.empty()) {
            parts.push_back(part);
        }
    }
}

} // namespace

Rect band_of(Size raster, Shard shard)
{
    if (shard.index < 0 || shard.index >= shard.count) {
        throw std::invalid_argument("there is no shard " + std::to_string(shard.index) +
                                    " of " + std::to_string(shard.count) +
                                    "; they count from 0");
    }
    const std::int64_t pieces = ceil_div(raster.rows, kPieceRows);
    const auto first_row = [&](int index) {
        const std::int64_t row = pieces * index / shard.count * kPieceRows;
        return static_cast<int>(std::min<std::int64_t>(row, raster.rows));
    };
    return rect_between(first_row(shard.index), 0, first_row(shard.index + 1), raster.cols);
}

Rect bounds_of_rest(const Rect& wanted, std::span<const Rect> taken)
{
    std::vector<Rect> rest{wanted};
    for (const Rect& hole : taken) {
        std::vector<Rect> left;
        for (const Rect& part : rest) {
            append_outside(part, hole, left);
        }
        rest = std::move(left);
    }
    Rect bounds{wanted.row, wanted.col, 0, 0};
    for (const Rect& part : rest) {
        bounds = unite(bounds, part);
    }
    return bounds;
}

} // namespace hsgm::tiling
