#pragma once

#include "pipeline/bench/inner_loops.h"
#include "pipeline/bench/measure.h"

#include <string>
#include <vector>

namespace hsgm::bench {

/// A finished benchmark.
struct BenchResult {
    BenchSettings settings;
    std::vector<InnerRate> inner;
    std::vector<PairResult> pairs;
};

/// For people: one table a pair, and what its columns mean.
std::string table(const BenchResult& result);

/// For programs: everything that was measured, every single time too. Figures that could not
/// be had are null. docs/benchmarks.md explains the keys.
std::string json(const BenchResult& result);

/// The machine in a few words: processor, threads, instructions, OpenCV.
std::string machine();

} // namespace hsgm::bench
