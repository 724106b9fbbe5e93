#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace hsgm::pipeline {

/// Another process of ours, in a process group of its own so that a signal for us does not
/// reach it twice, and that is told to stop (SIGTERM) when we die. What it says goes to a file.
class ChildProcess {
public:
    /// `command` begins with the path of a program. Throws StorageError where the log cannot be
    /// written, std::runtime_error where no process can be made.
    ChildProcess(const std::vector<std::string>& command, const std::filesystem::path& log);
    /// Stops it, and waits for that.
    ~ChildProcess();
    ChildProcess(ChildProcess&& other) noexcept;
    ChildProcess& operator=(ChildProcess&&) = delete;

    /// Asks it to stop soon.
    void stop() const;
    /// Whether it has ended; then `exit_code()` is known.
    bool has_ended();
    /// Its exit code, or 128 and the signal that ended it.
    int exit_code() const { return exit_code_; }

private:
    pid_t pid_ = -1;
    int exit_code_ = -1;
};

/// Path of the program that is running.
std::string this_program();

} // namespace hsgm::pipeline
