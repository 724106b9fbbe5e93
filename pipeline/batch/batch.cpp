#include "pipeline/batch/batch.h"

#include "io/config.h"
#include "io/error.h"
#include "io/pending_file.h"
#include "pipeline/batch/child_process.h"
#include "pipeline/batch/csv.h"
#include "pipeline/budget.h"
#include "pipeline/configuration.h"
#include "pipeline/error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/info.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <list>
#include <thread>

namespace hsgm::pipeline {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::string quoted(const std::string& path)
{
    std::string text = "'";
    for (const char c : path) {
        text += c == '\'' ? std::string("''") : std::string(1, c);
    }
    return text + "'";
}

// "pair.left" where the configuration names a file there, else "pair.left.path", which leaves
// band, nodata and mask to it.
std::string key_of_image(const io::ConfigDocument& document, const std::string& side)
{
    return document.is_scalar("pair." + side) ? "pair." + side : "pair." + side + ".path";
}

/// The `--set` words of a pair, in the order in which they apply.
std::vector<std::string> settings_of(const BatchPair& pair, const BatchOptions& options)
{
    const auto base = io::ConfigDocument::load(options.config);
    std::vector<std::string> settings = options.overrides;
    settings.push_back(key_of_image(base, "left") + "=" + quoted(pair.left));
    settings.push_back(key_of_image(base, "right") + "=" + quoted(pair.right));
    for (const auto& [key, value] : pair.overrides) {
        settings.push_back(key + "=" + value);
    }
    return settings;
}

// What the pair's run will read, read now.
void check_configuration(const BatchPair& pair, const BatchOptions& options)
{
    try {
        auto document = io::ConfigDocument::load(options.config);
        for (const std::string& setting : settings_of(pair, options)) {
            document.set(setting);
        }
        document.set("output.folder", quoted((options.folder / pair.name).string()));
        read_configuration(document);
    } catch (const io::ConfigError& error) {
        throw io::ConfigError(fmt::format("pair '{}': {}", pair.name, error.what()));
    }
}

/// The share of the machine that each of several jobs takes, where nothing is said.
std::vector<std::string> share(const BatchOptions& options)
{
    if (options.jobs == 1) {
        return {};
    }
    auto document = io::ConfigDocument::load(options.config);
    for (const std::string& setting : options.overrides) {
        document.set(setting);
    }
    std::vector<std::string> words;
    if (!document.is_scalar("run.threads")) {
        const int threads = std::max(tbb::info::default_concurrency() / options.jobs, 1);
        words.insert(words.end(), {"--threads", std::to_string(threads)});
    }
    if (!document.is_scalar("run.memory")) {
        const std::uint64_t bytes =
            available_memory_bytes() / 5 * 4 / static_cast<std::uint64_t>(options.jobs);
        words.insert(words.end(), {"--memory", std::to_string(bytes)});
    }
    return words;
}

std::vector<std::string> command_of(const BatchPair& pair, const BatchOptions& options)
{
    std::vector<std::string> command{this_program(),
                                     "--log-level",
                                     options.log_level,
                                     "run",
                                     options.config.string(),
                                     "-o",
                                     (options.folder / pair.name).string()};
    const auto shared = share(options);
    command.insert(command.end(), shared.begin(), shared.end());
    for (const std::string& setting : settings_of(pair, options)) {
        command.insert(command.end(), {"--set", setting});
    }
    if (options.resume) {
        command.emplace_back("--resume");
    }
    if (options.restart) {
        command.emplace_back("--restart");
    }
    return command;
}

std::string last_error_in(const fs::path& log)
{
    std::ifstream file(log);
    std::string found;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("error: ")) {
            found = line.substr(7);
        }
    }
    return found;
}

// What the finished run says of itself; nothing where it did not get so far.
void read_record(const fs::path& path, BatchResult& result)
{
    std::ifstream file(path);
    const auto record =
        file ? nlohmann::json::parse(file, nullptr, false) : nlohmann::json(nullptr);
    if (!record.is_object()) {
        return;
    }
    result.tiles_done = record["tiles"]["done"].get<int>();
    result.tiles_failed = record["tiles"]["failed"].get<int>();
    result.complete_percent = record["result"]["complete_percent"].get<double>();
    const auto& ratio = record["seams"]["window"]["ratio"];
    if (ratio.is_number()) {
        result.seam_ratio = ratio.get<double>();
    }
}

template <typename T>
std::string cell(const std::optional<T>& value)
{
    return value ? fmt::format("{}", *value) : "";
}

void write_summary(const fs::path& folder, const std::vector<BatchResult>& results)
{
    std::string text = csv_row({"name", "state", "exit_code", "seconds", "tiles_done",
                                "tiles_failed", "complete_percent", "seam_ratio", "message"});
    for (const BatchResult& r : results) {
        text +=
            csv_row({r.name, state_of(r), r.exit_code < 0 ? "" : std::to_string(r.exit_code),
                     fmt::format("{:.1f}", r.seconds), cell(r.tiles_done), cell(r.tiles_failed),
                     r.complete_percent ? fmt::format("{:.2f}", *r.complete_percent) : "",
                     r.seam_ratio ? fmt::format("{:.4f}", *r.seam_ratio) : "", r.message});
    }
    io::write_text_file((folder / "summary.csv").string(), text);
}

struct Job {
    std::size_t pair = 0;
    ChildProcess process;
    Clock::time_point start;
};

/// The jobs of an archive, a few at a time.
class Batch {
public:
    Batch(const std::vector<BatchPair>& pairs, const BatchOptions& options,
          const std::function<void(const BatchResult&)>& told)
        : pairs_(pairs), options_(options), told_(told)
    {
        for (const BatchPair& pair : pairs) {
            results_.emplace_back();
            results_.back().name = pair.name;
        }
    }

    std::vector<BatchResult> carry_out()
    {
        bool stopping = false;
        while (next_ < pairs_.size() || !jobs_.empty()) {
            if (stop_is_requested() && !std::exchange(stopping, true)) {
                next_ = pairs_.size();
                for (const Job& job : jobs_) {
                    job.process.stop();
                }
            }
            while (next_ < pairs_.size() && static_cast<int>(jobs_.size()) < options_.jobs) {
                begin(next_++);
            }
            collect();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        check_stop();
        return std::move(results_);
    }

private:
    fs::path log_of(const BatchPair& pair) const
    {
        return options_.folder / pair.name / "logs" / "job.log";
    }

    void begin(std::size_t number)
    {
        const BatchPair& pair = pairs_[number];
        std::error_code error;
        fs::create_directories(log_of(pair).parent_path(), error);
        if (error) {
            throw io::StorageError(fmt::format("cannot make the folder {}: {}",
                                               log_of(pair).parent_path().string(),
                                               error.message()));
        }
        jobs_.push_back(
            {number, ChildProcess(command_of(pair, options_), log_of(pair)), Clock::now()});
    }

    void collect()
    {
        for (auto job = jobs_.begin(); job != jobs_.end();) {
            if (!job->process.has_ended()) {
                ++job;
                continue;
            }
            BatchResult& result = results_[job->pair];
            result.exit_code = job->process.exit_code();
            result.seconds = std::chrono::duration<double>(Clock::now() - job->start).count();
            result.message = last_error_in(log_of(pairs_[job->pair]));
            if (result.exit_code == 0 || result.exit_code == 5) {
                read_record(options_.folder / result.name / "run.json", result);
            }
            job = jobs_.erase(job);
            write_summary(options_.folder, results_);
            told_(result);
        }
    }

    const std::vector<BatchPair>& pairs_;
    const BatchOptions& options_;
    const std::function<void(const BatchResult&)>& told_;
    std::vector<BatchResult> results_;
    std::list<Job> jobs_;
    std::size_t next_ = 0;
};

} // namespace

std::string state_of(const BatchResult& result)
{
    switch (result.exit_code) {
    case -1:
        return "not begun";
    case 0:
        return "done";
    case 2:
        return "configuration";
    case 3:
        return "input";
    case 4:
        return "budget";
    case 5:
        return "failed tiles";
    case 6:
        return "storage";
    case 130:
    case 128 + 15:
        return "interrupted";
    default:
        return result.exit_code > 128
                   ? fmt::format("killed by signal {}", result.exit_code - 128)
                   : "unexpected";
    }
}

std::vector<BatchResult> run_batch(const std::vector<BatchPair>& pairs,
                                   const BatchOptions& options,
                                   const std::function<void(const BatchResult&)>& told)
{
    for (const BatchPair& pair : pairs) {
        check_configuration(pair, options);
    }
    std::error_code error;
    fs::create_directories(options.folder, error);
    if (error) {
        throw io::StorageError(fmt::format("cannot make the folder {}: {}",
                                           options.folder.string(), error.message()));
    }
    return Batch(pairs, options, told).carry_out();
}

} // namespace hsgm::pipeline
