// sanitizer_probe FAULT: commits one fault that a sanitizer must report: race, bounds or
// overflow; or none (clean), in a small flow graph of the pipeline's kind.

#include <tbb/enumerable_thread_specific.h>
#include <tbb/flow_graph.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace {

using Tile = std::shared_ptr<std::vector<int>>;

// Tiles through read -> match -> write with three in flight; windows of a tile in parallel.
// With `race`, windows share a counter. Returns the sum of what was written.
long flow_of_tiles(bool race)
{
    constexpr int kTiles = 20;
    constexpr int kPixels = 2000;
    long written = 0;
    int next = 0;
    int shared = 0;
    tbb::enumerable_thread_specific<std::vector<int>> scratch;
    tbb::flow::graph graph;
    tbb::flow::input_node<Tile> read(graph, [&](tbb::flow_control& control) -> Tile {
        if (next == kTiles) {
            control.stop();
            return {};
        }
        return std::make_shared<std::vector<int>>(kPixels, next++);
    });
    tbb::flow::limiter_node<Tile> limit(graph, 3);
    tbb::flow::function_node<Tile, Tile> match(graph, tbb::flow::unlimited, [&](Tile tile) {
        tbb::parallel_for(0, kPixels, [&](int i) {
            std::vector<int>& mine = scratch.local();
            mine.assign(4, i);
            (*tile)[static_cast<std::size_t>(i)] += mine[2];
            if (race) {
                ++shared;
            }
        });
        return tile;
    });
    tbb::flow::function_node<Tile, tbb::flow::continue_msg> write(
        graph, tbb::flow::serial, [&](const Tile& tile) {
            for (const int value : *tile) {
                written += value;
            }
            return tbb::flow::continue_msg{};
        });
    tbb::flow::make_edge(read, limit);
    tbb::flow::make_edge(limit, match);
    tbb::flow::make_edge(match, write);
    tbb::flow::make_edge(write, limit.decrementer());
    read.activate();
    graph.wait_for_all();
    return written + shared;
}

} // namespace

int main(int argc, char** argv)
{
    const std::string fault = argc > 1 ? argv[1] : "clean";
    const std::vector<int> pixels(static_cast<std::size_t>(argc), 7);
    long result = 0;
    if (fault == "bounds") {
        const int* data = pixels.data();
        result = data[argc];
    } else if (fault == "overflow") {
        result = std::numeric_limits<int>::max() - 1 + argc;
    } else {
        tbb::task_arena arena(4);
        result = arena.execute([&] { return flow_of_tiles(fault == "race"); });
    }
    std::printf("%ld\n", result);
    return 0;
}
