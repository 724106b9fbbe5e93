#pragma once

#include "pipeline/error.h"
#include "tiling/rect.h"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace hsgm::pipeline {

/// The pieces of a raster, row by row.
inline std::vector<tiling::Rect> pieces_of(tiling::Size raster, tiling::Size piece)
{
    std::vector<tiling::Rect> pieces;
    for (int row = 0; row < raster.rows; row += piece.rows) {
        for (int col = 0; col < raster.cols; col += piece.cols) {
            pieces.push_back(intersect({row, col, piece.rows, piece.cols}, rect_of(raster)));
        }
    }
    return pieces;
}

/// Pieces that are in memory at once with this many threads: one more than are computed, so
/// that writing need not wait.
inline int pieces_in_flight(int threads)
{
    return threads + 1;
}

/// Computes pieces side by side, on the threads of the arena that it is called in, and hands
/// them on one by one in their order: `write(index, compute(index))`.
template <typename Compute, typename Write>
void in_order(std::size_t count, const Compute& compute, const Write& write)
{
    using Result = decltype(compute(std::size_t{0}));
    struct Computed {
        std::size_t index;
        Result result;
    };
    std::size_t given = 0;
    const auto next = [&](tbb::flow_control& control) -> std::size_t {
        check_stop();
        if (given == count) {
            control.stop();
        }
        return given++;
    };
    tbb::parallel_pipeline(
        static_cast<std::size_t>(pieces_in_flight(tbb::this_task_arena::max_concurrency())),
        tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, next) &
            tbb::make_filter<std::size_t, std::shared_ptr<Computed>>(
                tbb::filter_mode::parallel,
                [&](std::size_t i) {
                    return std::make_shared<Computed>(Computed{i, compute(i)});
                }) &
            tbb::make_filter<std::shared_ptr<Computed>, void>(
                tbb::filter_mode::serial_in_order, [&](const std::shared_ptr<Computed>& done) {
                    write(done->index, done->result);
                }));
}

} // namespace hsgm::pipeline
