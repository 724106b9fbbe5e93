#include "io/error.h"
#include "io/gdal_session.h"
#include "pipeline/budget.h"
#include "pipeline/commands/batch_command.h"
#include "pipeline/commands/bench_command.h"
#include "pipeline/commands/evaluate_command.h"
#include "pipeline/commands/fuse_command.h"
#include "pipeline/commands/info_command.h"
#include "pipeline/commands/match_command.h"
#include "pipeline/commands/status_command.h"
#include "pipeline/commands/submit_command.h"
#include "pipeline/commands/synth_command.h"
#include "pipeline/commands/usage.h"
#include "pipeline/error.h"
#include "pipeline/freed_memory.h"
#include "pipeline/run_log.h"

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include <csignal>
#include <exception>
#include <new>

namespace {

enum ExitCode {
    kDone = 0,
    kUnexpected = 1,
    kUsage = 2,
    kInput = 3,
    kBudget = 4,
    kFailedTiles = 5,
    kStorage = 6,
    kInterrupted = 130,
};

constexpr const char* kHelp = R"(A first result in two commands:
  hsgm synth configs/scene-city.yaml -o city
  hsgm match city/left.tif city/right.tif -o disparity.tif --disparity 0,63

Each command has its own help with examples: hsgm match --help
Exit codes: 0 done, 1 unexpected, 2 usage or configuration, 3 input data, 4 does not fit the
memory or the device is absent, 5 finished with failed tiles, 6 storage, 130 interrupted.
See docs/exit-codes.md.)";

// A second signal ends the program at once.
void on_signal(int signal)
{
    hsgm::pipeline::request_stop();
    std::signal(signal, SIG_DFL);
}

int fail(ExitCode code, const char* message)
{
    spdlog::error("{}", message);
    return code;
}

int run(CLI::App& app, int argc, char** argv)
{
    try {
        app.parse(argc, argv);
        return kDone;
    } catch (const CLI::Success& success) {
        return app.exit(success);
    } catch (const CLI::Error& error) {
        return fail(kUsage, hsgm::pipeline::usage_sentence(app, error).c_str());
    } catch (const hsgm::io::ConfigError& error) {
        return fail(kUsage, error.what());
    } catch (const hsgm::io::InputError& error) {
        return fail(kInput, error.what());
    } catch (const hsgm::pipeline::BudgetError& error) {
        return fail(kBudget, error.what());
    } catch (const hsgm::pipeline::FailedTiles& error) {
        return fail(kFailedTiles, error.what());
    } catch (const hsgm::io::StorageError& error) {
        return fail(kStorage, error.what());
    } catch (const hsgm::pipeline::Interrupted& error) {
        return fail(kInterrupted, error.what());
    } catch (const std::bad_alloc&) {
        return fail(kBudget, "the machine gave no more memory: allow less with --memory");
    } catch (const std::exception& error) {
        return fail(kUnexpected, error.what());
    }
}

} // namespace

int main(int argc, char** argv)
{
    hsgm::pipeline::keep_freed_memory();
    // Results go to standard output, everything about them to standard error.
    std::string log_level = "info";
    bool log_json = false;
    hsgm::pipeline::start_logging(log_level, log_json);
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    hsgm::io::initialise_gdal(hsgm::pipeline::gdal_cache_bytes());

    CLI::App app{
        "hsgm: large-scale dense matching of stereo pairs, the same bits for every tiling"};
    app.footer(kHelp);
    app.set_version_flag("--version", std::string("hsgm ") + HSGM_VERSION);
    app.require_subcommand(1);
    app.add_option("--log-level", log_level, "debug, info, warn, error or off")
        ->check(CLI::IsMember({"debug", "info", "warn", "error", "off"}));
    app.add_flag("--log-json", log_json, "say everything as JSON, one object a line");
    // Before any command, which runs when all of the line is read.
    app.parse_complete_callback([&] { hsgm::pipeline::start_logging(log_level, log_json); });
    hsgm::pipeline::add_match_command(app);
    hsgm::pipeline::add_run_command(app);
    hsgm::pipeline::add_plan_command(app);
    hsgm::pipeline::add_batch_command(app);
    hsgm::pipeline::add_fuse_command(app);
    hsgm::pipeline::add_status_command(app);
    hsgm::pipeline::add_submit_command(app);
    hsgm::pipeline::add_report_command(app);
    hsgm::pipeline::add_evaluate_command(app);
    hsgm::pipeline::add_synth_command(app);
    hsgm::pipeline::add_info_command(app);
    hsgm::pipeline::add_bench_command(app);
    return run(app, argc, argv);
}
