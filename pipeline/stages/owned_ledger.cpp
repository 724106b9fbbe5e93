#include "pipeline/stages/owned_ledger.h"

#include "io/error.h"
#include "pipeline/error.h"
#include "pipeline/run_log.h"
#include "pipeline/stages/run_layout.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <thread>

namespace hsgm::pipeline {

namespace {

using ledger::FileLock;
using ledger::TileState;

double wall_clock_s()
{
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch())
        .count();
}

std::string environment(const char* name)
{
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
}

// This process. A Slurm job that is requeued keeps its number and counts its restarts.
ledger::Owner this_process()
{
    ledger::Owner owner;
    std::array<char, 256> host{};
    ::gethostname(host.data(), host.size() - 1);
    owner.host = host.data();
    owner.pid = ::getpid();
    const std::string job = environment("SLURM_JOB_ID");
    owner.job = job.empty() ? "" : "slurm " + job;
    owner.restarts = std::atoi(environment("SLURM_RESTART_COUNT").c_str());
    owner.program = "hsgm " HSGM_VERSION;
    owner.started_s = wall_clock_s();
    return owner;
}

// Slurm starts a job again only once it has given up its earlier self.
bool is_requeue_of(const ledger::Owner& owner, const std::filesystem::path& path)
{
    if (owner.job.empty() || owner.restarts == 0) {
        return false;
    }
    const auto owners = ledger::read_ledger(path).owners;
    return !owners.empty() && owners.back().job == owner.job &&
           owners.back().restarts < owner.restarts;
}

std::optional<FileLock> wait_for_lock(const std::filesystem::path& path, const std::string& me)
{
    spdlog::info("waiting for {}", FileLock::holder(path));
    while (true) {
        check_stop();
        if (auto lock = FileLock::take(path, me)) {
            return lock;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
}

std::unique_ptr<ledger::Ledger> open_ledger(const std::filesystem::path& path, bool fleeting)
{
    try {
        return std::make_unique<ledger::Ledger>(path, fleeting);
    } catch (const ledger::DamagedError& error) {
        std::filesystem::path aside = path;
        aside += ".damaged";
        std::filesystem::rename(path, aside);
        std::error_code none;
        std::filesystem::remove(path.string() + "-journal", none);
        spdlog::warn("{} It is set aside as {}; what it told of is done again.", error.what(),
                     aside.filename().string());
        return std::make_unique<ledger::Ledger>(path, fleeting);
    }
}

ledger::TileEvent event(const std::string& stage, const tiling::Rect& whole, TileState state)
{
    ledger::TileEvent event;
    event.stage = stage;
    event.rect = whole;
    event.state = state;
    event.worker = "main";
    return event;
}

} // namespace

std::optional<OwnedLedger> OwnedLedger::take(const std::filesystem::path& path,
                                             const Manner& manner)
{
    const WhenHeld when_held = manner.when_held;
    OwnedLedger owned;
    owned.owner_ = this_process();
    const std::string me = fmt::format("process {} on {}", owned.owner_.pid, owned.owner_.host);
    const std::filesystem::path lock_path = RunLayout::lock_of(path);
    owned.lock_ = FileLock::take(lock_path, me);
    if (!owned.lock_ && when_held == WhenHeld::give_way) {
        return std::nullopt;
    }
    if (!owned.lock_ && when_held == WhenHeld::wait) {
        owned.lock_ = wait_for_lock(lock_path, me);
    }
    const bool take_over =
        !owned.lock_ && (when_held == WhenHeld::take_over || is_requeue_of(owned.owner_, path));
    if (!owned.lock_ && !take_over) {
        throw io::StorageError(fmt::format(
            "{} is at work on {}; wait for it, stop it, or name another output folder",
            FileLock::holder(lock_path), path.parent_path().parent_path().string()));
    }
    if (manner.once_locked) {
        manner.once_locked();
    }
    owned.ledger_ = open_ledger(path, manner.fleeting);
    owned.owner_ = owned.ledger_->take(owned.owner_, take_over);
    if (take_over) {
        spdlog::warn("taking over from {}", FileLock::holder(lock_path));
    }
    return owned;
}

void OwnedLedger::record(const std::string& stage, const tiling::Rect& whole,
                         const std::function<void()>& work) const
{
    ledger_->plan(stage, std::vector{whole});
    auto running = event(stage, whole, TileState::running);
    running.started_s = wall_clock_s();
    ledger_->commit(std::vector{running});
    const auto start = std::chrono::steady_clock::now();
    const auto end = [&](TileState state, const std::string& reason) {
        auto ended = event(stage, whole, state);
        ended.started_s = running.started_s;
        ended.seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        ended.reason = reason;
        ledger_->commit(std::vector{ended});
        log_event("stage", {{"stage", stage},
                            {"state", ledger::name(state)},
                            {"seconds", ended.seconds},
                            {"reason", reason}});
    };
    const auto end_in_peace = [&](const std::string& reason) {
        try {
            end(TileState::pending, reason);
        } catch (const io::StorageError& error) {
            // What ended the work says more; a full disk often ends both.
            spdlog::debug("{}", error.what());
        }
    };
    try {
        work();
    } catch (const Interrupted&) {
        end_in_peace("");
        throw;
    } catch (const std::exception& error) {
        end_in_peace(error.what());
        throw;
    }
    end(TileState::done, "");
}

bool OwnedLedger::is_done(const std::string& stage) const
{
    const auto rows = ledger_->tiles(stage);
    return !rows.empty() && rows.front().state == TileState::done;
}

} // namespace hsgm::pipeline
