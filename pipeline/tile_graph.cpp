#include "pipeline/tile_graph.h"

#include "pipeline/error.h"

#include <tbb/concurrent_queue.h>
#include <tbb/flow_graph.h>

#include <stdexcept>

namespace hsgm::pipeline {

namespace flow = tbb::flow;

namespace {

// Tiles travel as pointers: flow graph messages are copied.
using TaskPointer = std::shared_ptr<TileTask>;
struct Finished {
    int tile;
    matcher::TileMatch match;
};
using FinishedPointer = std::shared_ptr<Finished>;

// The workers that wait for a tile. There are as many match slots as workers, so one is
// always free when a slot asks.
class FreeWorkers {
public:
    explicit FreeWorkers(std::span<const std::unique_ptr<MatchWorker>> workers)
    {
        for (const auto& worker : workers) {
            free_.push(worker.get());
        }
    }
    FinishedPointer match(const TileTask& task)
    {
        MatchWorker* worker = nullptr;
        if (!free_.try_pop(worker)) {
            throw std::logic_error("tile graph: more matching slots than workers");
        }
        auto finished = std::make_shared<Finished>(Finished{task.index, worker->match(task)});
        free_.push(worker);
        return finished;
    }

private:
    tbb::concurrent_queue<MatchWorker*> free_;
};

} // namespace

void run_tiles(std::span<const int> sequence, const TileSteps& steps,
               std::span<const std::unique_ptr<MatchWorker>> workers, int tiles_in_flight)
{
    flow::graph graph;
    FreeWorkers free_workers(workers);
    std::size_t next = 0;
    flow::input_node<int> tiles(graph, [&](tbb::flow_control& control) {
        check_stop();
        if (next == sequence.size()) {
            control.stop();
            return 0;
        }
        return sequence[next++];
    });
    flow::limiter_node<int> limiter(graph, static_cast<std::size_t>(tiles_in_flight));
    flow::function_node<int, TaskPointer> read(graph, flow::unlimited, [&](int tile) {
        return std::make_shared<TileTask>(steps.read(tile));
    });
    flow::function_node<TaskPointer, FinishedPointer> match(
        graph, workers.size(),
        [&](const TaskPointer& task) { return free_workers.match(*task); });
    flow::function_node<FinishedPointer, flow::continue_msg> write(
        graph, flow::serial, [&](const FinishedPointer& finished) {
            check_stop();
            steps.write(finished->tile, std::move(finished->match));
            return flow::continue_msg();
        });
    flow::make_edge(tiles, limiter);
    flow::make_edge(limiter, read);
    flow::make_edge(read, match);
    flow::make_edge(match, write);
    flow::make_edge(write, limiter.decrementer());
    tiles.activate();
    graph.wait_for_all();
}

} // namespace hsgm::pipeline
