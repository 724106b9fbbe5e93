#pragma once

#include "tests/device_stand_in/device_thread.h"

#include <string>

namespace hsgm::stand_in {

/// What is known of a meeting: everybody is there, or somebody is still missing, or it can
/// never take place.
struct Meeting {
    bool complete = false;
    std::string complaint; ///< empty, or why it can never take place
};

/// The collective that `thread` has just reached. When complete, all lanes of its mask have
/// their results, and wait no longer.
Meeting meet_at_collective(DeviceThread& thread);

/// The barrier that `thread` has just reached; likewise.
Meeting meet_at_barrier(DeviceThread& thread);

/// File and line, without folders.
std::string name(const Here& here);

} // namespace hsgm::stand_in
