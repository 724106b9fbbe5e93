#pragma once

#include "pipeline/bench/contenders.h"

#include <CLI/App.hpp>

#include <string>
#include <vector>

namespace hsgm::pipeline {

/// The command line of `hsgm bench` as it is written. Lists that are empty have defaults,
/// which --quick changes.
struct BenchArguments {
    std::string left;
    std::string right;
    std::string disparity;
    std::string scene = "town";
    std::vector<int> sides;
    std::vector<int> disparities;
    std::vector<std::string> costs;
    std::vector<std::string> instructions;
    std::vector<std::string> threads;
    std::vector<std::string> peers;
    std::string device = "auto";
    std::vector<std::string> overrides;
    int repeats = 3;
    int tile_size_px = 0;
    bool quick = false;
    bool whole = false;
    bool json = false;
};

/// Adds the options to a command; `arguments` must outlive the parsing.
void add_bench_options(CLI::App& command, BenchArguments& arguments);

/// What they ask for. Throws io::ConfigError for what is not allowed or does not go together,
/// and BudgetError for a device that is not there.
bench::BenchSettings bench_settings(const BenchArguments& arguments);

} // namespace hsgm::pipeline
