#include "pipeline/error.h"

#include <atomic>

namespace hsgm::pipeline {

namespace {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "used in a signal handler");

} // namespace

void request_stop() noexcept
{
    stop_requested.store(true);
}

bool stop_is_requested() noexcept
{
    return stop_requested.load();
}

void check_stop()
{
    if (stop_is_requested()) {
        throw Interrupted("interrupted: every output is whole, or as it was before; --resume "
                          "goes on with a run");
    }
}

} // namespace hsgm::pipeline
