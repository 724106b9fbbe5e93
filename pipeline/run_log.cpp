#include "pipeline/run_log.h"

#include <nlohmann/json.hpp>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/dist_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <ctime>

namespace hsgm::pipeline {

namespace {

using nlohmann::ordered_json;

constexpr const char* kEvents = "events";

std::string utc(std::chrono::system_clock::time_point moment)
{
    const std::time_t seconds = std::chrono::system_clock::to_time_t(moment);
    const auto ms =
        std::chrono::duration_cast<std::chrono::milliseconds>(moment.time_since_epoch()) %
        std::chrono::seconds(1);
    std::tm parts{};
    ::gmtime_r(&seconds, &parts);
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", parts.tm_year + 1900,
                       parts.tm_mon + 1, parts.tm_mday, parts.tm_hour, parts.tm_min,
                       parts.tm_sec, ms.count());
}

// Messages become objects; events are some already.
class JsonLines final : public spdlog::formatter {
public:
    void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& to) override
    {
        const std::string text(message.payload.data(), message.payload.size());
        if (std::string_view(message.logger_name.data(), message.logger_name.size()) ==
            kEvents) {
            append(text, to);
            return;
        }
        const auto level = spdlog::level::to_string_view(message.level);
        const ordered_json line{{"time", utc(message.time)},
                                {"level", std::string(level.data(), level.size())},
                                {"message", text}};
        append(line.dump(-1, ' ', false, ordered_json::error_handler_t::replace), to);
    }
    std::unique_ptr<formatter> clone() const override { return std::make_unique<JsonLines>(); }

private:
    static void append(const std::string& text, spdlog::memory_buf_t& to)
    {
        to.append(text.data(), text.data() + text.size());
        to.push_back('\n');
    }
};

// The loggers of this process. Both write to the files; only messages, or with JSON both, to
// standard error.
struct Loggers {
    std::shared_ptr<spdlog::sinks::dist_sink_mt> files =
        std::make_shared<spdlog::sinks::dist_sink_mt>();
    std::shared_ptr<spdlog::logger> events;
    bool json = false;
};

Loggers& loggers()
{
    static Loggers the_ones;
    return the_ones;
}

} // namespace

void start_logging(const std::string& level, bool json)
{
    Loggers& all = loggers();
    all.json = json;
    auto console = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
    if (json) {
        console->set_formatter(std::make_unique<JsonLines>());
    } else {
        console->set_pattern("%^%l%$: %v");
    }
    console->set_level(spdlog::level::from_str(level));
    auto messages =
        std::make_shared<spdlog::logger>("hsgm", spdlog::sinks_init_list{console, all.files});
    messages->set_level(spdlog::level::debug);
    spdlog::set_default_logger(messages);
    all.events = std::make_shared<spdlog::logger>(kEvents, all.files);
    if (json) {
        all.events->sinks().push_back(console);
    }
}

bool logs_json()
{
    return loggers().json;
}

void log_event(const std::string& event, const ordered_json& fields)
{
    const auto& events = loggers().events;
    if (events == nullptr) {
        return;
    }
    ordered_json line{{"time", utc(std::chrono::system_clock::now())}, {"event", event}};
    line.update(fields);
    events->info("{}", line.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

struct LogFile::State {
    std::shared_ptr<spdlog::sinks::basic_file_sink_mt> sink;
};

LogFile::LogFile(const std::filesystem::path& path) : state_(std::make_unique<State>())
{
    try {
        std::filesystem::create_directories(path.parent_path());
        state_->sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(path.string());
        state_->sink->set_formatter(std::make_unique<JsonLines>());
        loggers().files->add_sink(state_->sink);
    } catch (const std::exception& error) {
        spdlog::warn("no log file: {}", error.what());
    }
}

LogFile::~LogFile()
{
    if (state_->sink == nullptr) {
        return;
    }
    loggers().files->remove_sink(state_->sink);
    try {
        state_->sink->flush();
    } catch (const std::exception& error) {
        spdlog::warn("the log is not whole: {}", error.what()); // a full disk, say
    }
}

} // namespace hsgm::pipeline
