#include "tiling/tile_plan.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>

namespace hsgm::tiling {

TilePlan::TilePlan(Size raster, int tile_size_px) : raster_(raster)
{
    if (raster.rows <= 0 || raster.cols <= 0) {
        throw std::invalid_argument("a tile plan needs a raster of at least 1 x 1 px, not " +
                                    std::to_string(raster.rows) + " x " +
                                    std::to_string(raster.cols));
    }
    if (tile_size_px < 0) {
        throw std::invalid_argument("the tile size must be 0 (untiled) or more, not " +
                                    std::to_string(tile_size_px));
    }
    tile_.rows = tile_size_px == 0 ? raster.rows : std::min(tile_size_px, raster.rows);
    tile_.cols = tile_size_px == 0 ? raster.cols : std::min(tile_size_px, raster.cols);
    tile_rows_ = ceil_div(raster.rows, tile_.rows);
    tile_cols_ = ceil_div(raster.cols, tile_.cols);
}

Rect TilePlan::core(int index) const
{
    const int row = index / tile_cols_ * tile_.rows;
    const int col = index % tile_cols_ * tile_.cols;
    return intersect({row, col, tile_.rows, tile_.cols}, rect_of(raster_));
}

namespace {

std::vector<int> column_by_column(const TilePlan& plan)
{
    const int tile_cols = ceil_div(plan.raster().cols, plan.tile_size().cols);
    const int tile_rows = plan.count() / tile_cols;
    std::vector<int> sequence;
    sequence.reserve(static_cast<std::size_t>(plan.count()));
    for (int col = 0; col < tile_cols; ++col) {
        for (int row = 0; row < tile_rows; ++row) {
            sequence.push_back(row * tile_cols + col);
        }
    }
    return sequence;
}

// std::shuffle leaves its algorithm to the library; this Fisher-Yates does not.
void shuffle(std::vector<int>& sequence, std::uint32_t seed)
{
    std::mt19937 random(seed);
    for (std::size_t i = sequence.size(); i > 1; --i) {
        std::swap(sequence[i - 1], sequence[random() % i]);
    }
}

} // namespace

std::vector<int> tile_sequence(const TilePlan& plan, TileOrder order, std::uint32_t seed)
{
    if (order == TileOrder::columns) {
        return column_by_column(plan);
    }
    std::vector<int> sequence(static_cast<std::size_t>(plan.count()));
    std::iota(sequence.begin(), sequence.end(), 0);
    if (order == TileOrder::reversed) {
        std::reverse(sequence.begin(), sequence.end());
    }
    if (order == TileOrder::shuffled) {
        shuffle(sequence, seed);
    }
    return sequence;
}

} // namespace hsgm::tiling
