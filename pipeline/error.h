#pragma once

#include <stdexcept>

namespace hsgm::pipeline {

/// What was asked does not fit the memory, or the device is not there. Exit code 4.
class BudgetError : public std::runtime_error {
    using runtime_error::runtime_error;
};

/// The run was told to stop (SIGINT, SIGTERM). Exit code 130.
class Interrupted : public std::runtime_error {
    using runtime_error::runtime_error;
};

/// The run went to its end, but some tiles could not be matched. Exit code 5.
class FailedTiles : public std::runtime_error {
    using runtime_error::runtime_error;
};

/// Asks the stages of this process to stop soon; safe in a signal handler.
void request_stop() noexcept;

/// Throws Interrupted once `request_stop` was called. Stages call it between pieces of work.
void check_stop();

/// Whether `request_stop` was called.
bool stop_is_requested() noexcept;

} // namespace hsgm::pipeline
