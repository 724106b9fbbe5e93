#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <memory>
#include <string>

namespace hsgm::pipeline {

/// Sends everything that is said to standard error, at `level` and above: as plain lines, or as
/// JSON, one object a line, with time, level and message. Called once, at the start.
void start_logging(const std::string& level, bool json);

/// Whether standard error takes JSON.
bool logs_json();

/// Says something that happened in fields, for programs: `{"time": ..., "event": "tile", ...}`.
/// Goes to the log file of the run, and to standard error where that takes JSON. `fields` is an
/// object.
void log_event(const std::string& event, const nlohmann::ordered_json& fields);

/// While it lives, a file that takes every message and event as JSON, one object a line,
/// appended. A run keeps one in logs/. A log that cannot be written is no reason to stop.
class LogFile {
public:
    explicit LogFile(const std::filesystem::path& path);
    ~LogFile();
    LogFile(const LogFile&) = delete;
    LogFile& operator=(const LogFile&) = delete;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace hsgm::pipeline
