#pragma once

#include "pipeline/bench/contenders.h"
#include "pipeline/bench/file_match.h"
#include "pipeline/bench/memory_match.h"
#include "pipeline/bench/peak_memory.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace hsgm::bench {

/// The median of a list that is not empty; the mean of the two middles of an even one.
double median(std::vector<double> values);

/// Seconds that all threads of this process have computed so far.
double cpu_clock_s();

/// What was measured of one contender.
struct Measured {
    Contender contender;
    std::vector<double> seconds;     ///< of every timed run
    std::vector<double> cpu_seconds; ///< likewise, of all threads: steadier on a busy machine
    std::vector<double> over_base;   ///< of each run right after one of its base: their ratio
    StageSeconds stages;             ///< of the run of median time; hsgm alone
    matcher::MatchStatistics work;   ///< hsgm alone
    std::optional<PeakBytes> memory;
    std::optional<double> bad_percent; ///< pixels off by more than 1 px, or without a value,
                                       ///< of those that show in both images, in the compared
                                       ///< columns; nothing without a truth

    double median_s() const { return median(seconds); }
    /// The median of the ratios; 1 for the first contender, which has none.
    double time_over_base() const { return over_base.empty() ? 1 : median(over_base); }
};

/// A contender that could not be measured.
struct LeftOut {
    Contender contender;
    std::string why;
};

/// Everything measured on one pair.
struct PairResult {
    std::string source;
    matcher::PairShape shape;
    ContentSpan span;
    bool span_of_truth = false; ///< else of what the base found
    std::vector<Measured> measured;
    std::vector<LeftOut> left_out;
    std::optional<FileMatch> whole;

    /// Pixels x disparities asked for, searched or not.
    std::int64_t nominal_cells() const;
    /// The same of the columns that all evaluate: OpenCV leaves some out.
    std::int64_t compared_cells() const;
    /// Pixels x disparities that a contender went through, halos and coarser levels included.
    std::int64_t evaluated_cells(const Measured& m) const;
};

/// Throws BudgetError where the base of `settings` does not fit the free memory beside a pair
/// of this shape that is yet to be made; for before the first pixel.
void check_memory(const matcher::PairShape& shape, const BenchSettings& settings);

/// Told about every step of a benchmark, which takes its time.
using Log = std::function<void(const std::string&)>;

/// Measures all contenders on a pair. First each runs once, to warm up and for its memory,
/// work and errors; then in each round every contender runs right after the one that it is
/// compared with, so that whatever disturbs the machine disturbs both alike. What does
/// not fit the free memory is left out; if that is the base, throws BudgetError.
PairResult measure_pair(const BenchPair& pair, const BenchSettings& settings, const Log& log);

/// Calls `work` on that many threads: a TBB arena, and a limit on all others.
void on_threads(int threads, const std::function<void()>& work);

} // namespace hsgm::bench
