#include "pipeline/stages/owned_ledger.h"

#include "io/error.h"
#include "pipeline/error.h"
#include "pipeline/ledger/succession.h"
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

std::string words_of(const ledger::Owner& owner)
{
    return fmt::format("process {} on {}", owner.pid, owner.host);
}

[[noreturn]] void refuse_held(const std::filesystem::path& ledger)
{
    throw io::StorageError(
        fmt::format("{} is at work on {}; wait for it, stop it, or name another output folder",
                    FileLock::holder(RunLayout::lock_of(ledger)),
                    ledger.parent_path().parent_path().string()));
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
    OwnedLedger owned;
    owned.owner_ = this_process();
    const std::filesystem::path lock_path = RunLayout::lock_of(path);
    owned.lock_ = FileLock::take(lock_path, words_of(owned.owner_));
    if (!owned.lock_ && manner.when_held == WhenHeld::give_way) {
        return std::nullopt;
    }
    if (!owned.lock_ && manner.when_held == WhenHeld::wait) {
        owned.lock_ = wait_for_lock(lock_path, words_of(owned.owner_));
    }
    if (!owned.lock_) {
        if (manner.when_held != WhenHeld::take_over && !is_requeue_of(owned.owner_, path)) {
            refuse_held(path);
        }
        owned.take_over(path, manner);
        return owned;
    }
    if (manner.once_locked) {
        manner.once_locked();
    }
    owned.ledger_ = open_ledger(path, manner.fleeting);
    owned.owner_ = owned.ledger_->take(owned.owner_, false);
    return owned;
}

// The holder may be frozen in the midst of a commit, with the file locked for good: so its file
// is left to it, and this process goes on in a copy.
void OwnedLedger::take_over(const std::filesystem::path& path, const Manner& manner)
{
    const std::filesystem::path successor = ledger::successor_of(path);
    lock_ = FileLock::take(RunLayout::lock_of(successor), words_of(owner_));
    if (!lock_) {
        refuse_held(successor);
    }
    if (manner.once_locked) {
        manner.once_locked();
    }
    const std::filesystem::path copy =
        successor.string() + ".part-" + std::to_string(owner_.pid);
    try {
        ledger::copy_ledger(path, copy);
        if (!ledger::publish_successor(copy, successor)) {
            refuse_held(successor);
        }
    } catch (const ledger::DamagedError& error) {
        spdlog::warn("{} What it told of is done again.", error.what());
    }
    spdlog::warn("taking over from {}", FileLock::holder(RunLayout::lock_of(path)));
    ledger_ = open_ledger(successor, manner.fleeting);
    owner_.part = ledger::number_of_successions(successor);
    owner_ = ledger_->take(owner_, true);
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
