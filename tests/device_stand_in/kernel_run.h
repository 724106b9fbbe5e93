#pragma once

#include "tests/device_stand_in/control.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <source_location>
#include <string>

// How a kernel runs on the stand-in: a fiber for every thread of a block, warps of 32 that
// meet in collectives, blocks that meet at barriers.
namespace hsgm::stand_in {

struct Index3 {
    unsigned x = 0;
    unsigned y = 0;
    unsigned z = 0;
};

/// Of the running thread.
struct Place {
    Index3 thread;
    Index3 block;
    Index3 block_size;
    Index3 grid_size;
};
extern Place place;

using Here = std::source_location;

enum class Collective { sync, shuffle, any, all, ballot, minimum };
enum class Barrier { plain, any, all, count };

/// Waits for all lanes of `mask` at the same source line; the collective's result for the
/// calling lane. `lane` is the source lane of a shuffle.
std::uint64_t meet_lanes(Collective what, unsigned mask, std::uint64_t value, int lane,
                         const Here& here);
/// Waits for all threads of the block at the same source line.
int meet_threads(Barrier what, int predicate, const Here& here);
/// Where a random schedule may switch to another thread.
void maybe_switch();

/// The running block's dynamic shared memory.
std::byte* dynamic_shared();
/// Declares bytes of it that no thread may touch in this run.
void forbid_shared(std::byte* begin, std::size_t bytes);

/// Whether the caller is a thread of a kernel.
bool in_kernel();

/// Runs all blocks; an empty string, or the sentence that ended the kernel.
std::string run_kernel(Index3 grid, Index3 block, std::size_t shared_bytes,
                       const Schedule& schedule, const std::function<void()>& body);

} // namespace hsgm::stand_in
