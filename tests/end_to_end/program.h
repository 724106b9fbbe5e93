#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <sys/types.h>

namespace hsgm::tests {

/// What came of a program: its exit code (or minus the signal that ended it), its words, and
/// the most memory that was resident, as /usr/bin/time has it.
struct Outcome {
    int code = 0;
    std::string out;
    std::string err;
    std::int64_t peak_bytes = 0;
};

/// A child process; what it says goes to files, so it never waits for a reader.
class RunningProgram {
public:
    /// `command` begins with a program, looked for in PATH where it names no folder.
    explicit RunningProgram(const std::vector<std::string>& command);
    /// Ends the child if it still runs.
    ~RunningProgram();
    RunningProgram(const RunningProgram&) = delete;
    RunningProgram& operator=(const RunningProgram&) = delete;

    /// What it has written to standard error so far.
    std::string err() const;
    void signal(int number) const;
    bool has_ended() const;
    Outcome wait();

private:
    std::string folder_;
    pid_t child_ = -1;
};

Outcome run_program(const std::vector<std::string>& command);

/// Path of the `hsgm` of this build.
std::string hsgm_program();
Outcome run_hsgm(const std::vector<std::string>& arguments);

/// Every file below a folder, hidden ones too, and its bytes. Folders have a slash at the end.
using Snapshot = std::map<std::string, std::string>;
Snapshot snapshot(const std::string& folder);
/// Those of it that are rasters: all that a run promises to be the same.
Snapshot rasters_in(const std::string& folder);
/// The names alone.
std::vector<std::string> names_in(const Snapshot& files);

} // namespace hsgm::tests
