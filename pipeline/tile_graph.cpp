#include "pipeline/tile_graph.h"

#include "pipeline/error.h"

#include <tbb/flow_graph.h>

#include <utility>

namespace hsgm::pipeline {

namespace flow = tbb::flow;

namespace {

// Tiles travel as pointers: flow graph messages are copied.
struct ReadTile {
    std::shared_ptr<const TileTask> task;
    MatchOutcome failed; // where reading failed
};
using ReadPointer = std::shared_ptr<ReadTile>;
using OutcomePointer = std::shared_ptr<MatchOutcome>;
using MatchNode = flow::async_node<ReadPointer, OutcomePointer>;

ReadPointer read_tile(const TileSteps& steps, int tile)
{
    auto read = std::make_shared<ReadTile>();
    read->failed.tile = tile;
    read->failed.started = std::chrono::steady_clock::now();
    try {
        read->task = std::make_shared<const TileTask>(steps.read(tile));
    } catch (...) {
        read->failed.error = std::current_exception();
    }
    return read;
}

// The graph waits for what it gives away, and takes it back from the pool's threads.
void send_to_pool(const ReadPointer& read, MatchNode::gateway_type& gateway, WorkerPool& pool)
{
    if (read->failed.error) {
        gateway.try_put(std::make_shared<MatchOutcome>(std::move(read->failed)));
        return;
    }
    gateway.reserve_wait();
    pool.submit(std::move(read->task), [&gateway](MatchOutcome outcome) {
        gateway.try_put(std::make_shared<MatchOutcome>(std::move(outcome)));
        gateway.release_wait();
    });
}

// Whether a failure concerns more than its tile.
bool ends_the_run(const std::exception_ptr& error)
{
    try {
        std::rethrow_exception(error);
    } catch (const Interrupted&) {
        return true;
    } catch (const NoWorkerLeft&) {
        return true;
    } catch (...) {
        return false;
    }
}

void finish(const TileSteps& steps, MatchOutcome& outcome)
{
    check_stop();
    if (outcome.error && (!steps.ended || ends_the_run(outcome.error))) {
        std::rethrow_exception(outcome.error);
    }
    if (!outcome.error) {
        steps.write(outcome.tile, std::exchange(outcome.match, {}));
    }
    if (steps.ended) {
        steps.ended(outcome);
    }
}

} // namespace

void run_tiles(std::span<const int> sequence, const TileSteps& steps, WorkerPool& pool,
               int tiles_in_flight)
{
    flow::graph graph;
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
    flow::function_node<int, ReadPointer> read(
        graph, flow::unlimited, [&](int tile) { return read_tile(steps, tile); });
    MatchNode match(graph, flow::unlimited,
                    [&](const ReadPointer& tile, MatchNode::gateway_type& gateway) {
                        send_to_pool(tile, gateway, pool);
                    });
    flow::function_node<OutcomePointer, flow::continue_msg> write(
        graph, flow::serial, [&](const OutcomePointer& outcome) {
            finish(steps, *outcome);
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
