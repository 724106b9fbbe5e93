#include "pipeline/bench/measure.h"

#include "pipeline/error.h"
#include "pipeline/evaluate/disparity_score.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <memory>

namespace hsgm::bench {

namespace {

/// What must stay free beside a contender.
constexpr std::int64_t kReserveBytes = std::int64_t{512} << 20;

/// Both images in 16 and in 8 bits, truth, what is visible, and what was found last.
constexpr std::int64_t kPairBytes = 2 * (2 + 1) + 4 + 1 + 7;

std::int64_t bytes_of(const Contender& c, const matcher::PairShape& shape, int tile_size_px)
{
    return c.peer ? peer_bytes(*c.peer, shape)
                  : memory_match_bytes(shape, c.options, tile_size_px, c.threads);
}

std::string gibibytes(std::int64_t bytes)
{
    return fmt::format("{:.1f} GiB", static_cast<double>(bytes) / (1 << 30));
}

// That so much more memory cannot be had, in words; nothing where it can.
std::optional<std::string> shortage(std::int64_t bytes)
{
    const std::int64_t needed = bytes + kReserveBytes;
    const std::int64_t free = free_memory_bytes();
    if (needed <= free) {
        return std::nullopt;
    }
    return fmt::format("needs {} of memory, and {} are free", gibibytes(needed),
                       gibibytes(free));
}

// Why a contender cannot run; nothing where it can.
std::optional<std::string> obstacle(const Contender& c, const matcher::PairShape& shape,
                                    int tile_size_px)
{
    if (c.peer) {
        if (const auto why = why_not(shape)) {
            return why;
        }
    }
    if (c.device) {
        if (const auto why = why_not(shape, c.options, tile_size_px, *c.device)) {
            return why;
        }
    }
    return shortage(bytes_of(c, shape, tile_size_px));
}

[[noreturn]] void refuse(const Contender& base, const std::string& why)
{
    throw pipeline::BudgetError(base.title + " " + why +
                                ": choose a smaller side, or tiles with --tile-size");
}

double bad_percent(const BenchPair& pair, const tiling::Image<float>& disparity_px)
{
    const ColumnRange cols = compared_columns(pair.shape());
    const auto count = static_cast<std::size_t>(cols.count());
    evaluate::DisparityScorer scorer({1.0});
    std::vector<float> values(count);
    for (int row = 0; row < disparity_px.rows(); ++row) {
        std::transform(disparity_px.row(row) + cols.first, disparity_px.row(row) + cols.end,
                       values.begin(), [](float value) {
                           return value == matcher::kNodataDisparity
                                      ? std::numeric_limits<float>::quiet_NaN()
                                      : value;
                       });
        scorer.add_row(values, {pair.truth_px.row(row) + cols.first, count},
                       {pair.visible.row(row) + cols.first, count});
    }
    return scorer.score().bad.front().bad_percent;
}

// Of one whole match.
struct Times {
    double seconds = 0;
    double cpu_seconds = 0;
};

// Runs contenders on one pair.
class Runner {
public:
    Runner(const BenchPair& pair, int tile_size_px) : pair_(pair), tile_size_px_(tile_size_px)
    {
    }

    Times run(const Contender& c)
    {
        pipeline::check_stop();
        forget();
        if (!c.peer) {
            matcher::use_instructions(c.instructions);
        }
        const auto start = std::chrono::steady_clock::now();
        const double cpu_start_s = cpu_clock_s();
        if (c.peer) {
            on_threads(c.threads, [&] { peer_pair_->match(*c.peer, c.threads); });
        } else {
            on_threads(c.threads, [&] {
                found_ = match_in_memory(pair_, c.options, tile_size_px_,
                                         c.device ? &*c.device : nullptr);
            });
        }
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        return {time.count(), cpu_clock_s() - cpu_start_s};
    }
    // Gives back the memory of the last result.
    void forget() { found_ = {}; }
    // What the last run found.
    const MemoryMatch& found() const { return found_; }
    tiling::Image<float> disparity_px(const Contender& c) const
    {
        return c.peer ? peer_pair_->disparity_px() : found_.result.disparity_px;
    }
    // OpenCV's own images are part of the pair, not of a peer's memory.
    void prepare_peers() { peer_pair_ = std::make_unique<PeerPair>(pair_); }

private:
    const BenchPair& pair_;
    int tile_size_px_;
    std::unique_ptr<PeerPair> peer_pair_;
    MemoryMatch found_;
};

// The contenders that fit, their bases renumbered, and those that do not. One whose base
// does not fit is compared with that one's base.
void sort_out(std::vector<Contender> all, const matcher::PairShape& shape, int tile_size_px,
              PairResult& result)
{
    std::vector<std::size_t> place(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        all[i].base = place[all[i].base];
        const auto why = obstacle(all[i], shape, tile_size_px);
        if (!why) {
            place[i] = result.measured.size();
            result.measured.emplace_back().contender = all[i];
        } else if (i == 0) {
            refuse(all[i], *why);
        } else {
            place[i] = all[i].base;
            result.left_out.push_back({all[i], *why});
        }
    }
}

void warm_up(Runner& runner, const BenchPair& pair, PairResult& result, const Log& log)
{
    for (Measured& m : result.measured) {
        log(fmt::format("warming up: {}, {} thread{}", m.contender.title, m.contender.threads,
                        m.contender.threads == 1 ? "" : "s"));
        runner.forget();
        const PeakMemoryWatch watch;
        runner.run(m.contender);
        m.memory = watch.peak();
        m.work = runner.found().work;
        if (pair.has_truth()) {
            m.bad_percent = bad_percent(pair, runner.disparity_px(m.contender));
        }
        if (&m == &result.measured.front() && !pair.has_truth()) {
            result.span = content_span(runner.found().result.disparity_px, pair.asked);
        }
    }
}

// Stages of every run, of which the one of median time is kept.
using StageRuns = std::vector<std::vector<StageSeconds>>;

double timed_run(Runner& runner, std::size_t i, PairResult& result, StageRuns& stages)
{
    const Times times = runner.run(result.measured[i].contender);
    result.measured[i].seconds.push_back(times.seconds);
    result.measured[i].cpu_seconds.push_back(times.cpu_seconds);
    stages[i].push_back(runner.found().seconds);
    return times.seconds;
}

void run_round(Runner& runner, PairResult& result, StageRuns& stages)
{
    if (result.measured.size() == 1) {
        timed_run(runner, 0, result, stages);
    }
    for (std::size_t i = 1; i < result.measured.size(); ++i) {
        const std::size_t base = result.measured[i].contender.base;
        const double base_seconds = timed_run(runner, base, result, stages);
        const double seconds = timed_run(runner, i, result, stages);
        result.measured[i].over_base.push_back(seconds / base_seconds);
    }
}

StageSeconds stages_of_median(const Measured& m, const std::vector<StageSeconds>& runs)
{
    const double middle = m.median_s();
    const auto nearest =
        std::min_element(m.seconds.begin(), m.seconds.end(), [middle](double a, double b) {
            return std::abs(a - middle) < std::abs(b - middle);
        });
    return runs[static_cast<std::size_t>(nearest - m.seconds.begin())];
}

} // namespace

double cpu_clock_s()
{
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double median(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 != 0 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

std::int64_t PairResult::nominal_cells() const
{
    return shape.left.area() * shape.asked.count();
}

std::int64_t PairResult::compared_cells() const
{
    return std::int64_t{shape.left.rows} * compared_columns(shape).count() *
           shape.asked.count();
}

std::int64_t PairResult::evaluated_cells(const Measured& m) const
{
    return m.contender.peer ? compared_cells() : m.work.cells;
}

void check_memory(const matcher::PairShape& shape, const BenchSettings& settings)
{
    const Contender base = contenders(settings).front();
    if (const auto why = shortage(kPairBytes * shape.left.area() +
                                  bytes_of(base, shape, settings.tile_size_px))) {
        refuse(base, *why);
    }
}

PairResult measure_pair(const BenchPair& pair, const BenchSettings& settings, const Log& log)
{
    PairResult result;
    result.source = pair.source;
    result.shape = pair.shape();
    if (pair.has_truth()) {
        result.span = content_span(pair.truth_px, pair.asked);
        result.span_of_truth = true;
    }
    sort_out(contenders(settings), result.shape, settings.tile_size_px, result);
    Runner runner(pair, settings.tile_size_px);
    if (std::any_of(result.measured.begin(), result.measured.end(),
                    [](const Measured& m) { return m.contender.peer.has_value(); })) {
        runner.prepare_peers();
    }
    warm_up(runner, pair, result, log);
    StageRuns stages(result.measured.size());
    for (int round = 0; round < settings.repeats; ++round) {
        log(fmt::format("round {} of {}", round + 1, settings.repeats));
        run_round(runner, result, stages);
    }
    for (std::size_t i = 0; i < result.measured.size(); ++i) {
        result.measured[i].stages = stages_of_median(result.measured[i], stages[i]);
    }
    matcher::use_instructions(std::nullopt);
    return result;
}

void on_threads(int threads, const std::function<void()>& work)
{
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    arena.execute(work);
}

} // namespace hsgm::bench
