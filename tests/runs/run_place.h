#pragma once

#include "pipeline/ledger/ledger.h"
#include "pipeline/stages/match_stage.h"
#include "tests/end_to_end/pairs.h"
#include "tests/end_to_end/program.h"

#include <functional>
#include <string>
#include <vector>

namespace hsgm::tests {

/// A folder with a pair of many tiles and run.yaml for it, whose results go to result/.
class RunPlace {
public:
    /// A range of 256 disparities makes a run of more than a second, for others to come in
    /// between.
    explicit RunPlace(tiling::Size size = {300, 400}, int disparity_max = 31);
    /// Results go to `result` instead.
    RunPlace(const std::string& result, tiling::Size size, int disparity_max);

    const TemporaryFolder& folder() const { return folder_; }
    std::string operator/(const std::string& name) const { return folder_ / name; }
    std::string result() const { return result_.empty() ? folder_ / "result" : result_; }

    /// `hsgm run run.yaml` with tiles of 64 px and two threads, unless `more` says otherwise.
    std::vector<std::string> command(const std::vector<std::string>& more = {}) const;
    Outcome run(const std::vector<std::string>& more = {}) const;
    /// Runs, and expects this exit code.
    Outcome run_to(int code, const std::vector<std::string>& more = {}) const;

    /// Starts a run and kills it, without warning, as soon as so many tiles are done. Returns
    /// how many were then; all, where it came to its end before.
    int run_and_kill(int tiles_done, const std::vector<std::string>& more = {}) const;

    /// What an undisturbed run elsewhere gives; made once.
    const Snapshot& undisturbed() const;
    bool has_begun() const { return std::filesystem::exists(result()); }
    Snapshot rasters() const { return rasters_in(result()); }

    /// The ledger of a shard, and its rows for tiles.
    ledger::Contents ledger(tiling::Shard shard = {}) const;
    std::vector<ledger::TileRow> tiles(tiling::Shard shard = {}) const;
    int done(tiling::Shard shard = {}) const;

    /// The same run in this process.
    pipeline::PlannedJob planned() const;
    pipeline::RunManner manner() const;

private:
    TemporaryFolder folder_;
    std::string result_;
    mutable Snapshot undisturbed_;
};

/// A place whose run takes its time.
inline RunPlace slow_place()
{
    return RunPlace({600, 800}, 255);
}

/// Waits for something, half a minute at most.
bool comes_true(const std::function<bool()>& condition);

} // namespace hsgm::tests
