#pragma once

#include "matcher/options.h"
#include "pipeline/bench/bench_pair.h"
#include "pipeline/bench/peak_memory.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hsgm::bench {

/// `hsgm match` as a whole, from two files to three.
struct FileMatch {
    int threads = 1;
    int tile_size_px = 0; ///< that the memory budget chose
    std::vector<double> seconds;
    std::optional<PeakBytes> memory;
};

/// Writes a rendered pair, which has 8 bits, to left.tif and right.tif of a folder.
void write_pair(const BenchPair& pair, const std::filesystem::path& folder);

/// Runs the stage behind `hsgm match` on a pair of files, a first time to warm up and for its
/// memory, then `repeats` times: reading, preparing on scratch disk, matching by tiles of the
/// default size, checks, compressed outputs. All is written to `folder` and stays there.
FileMatch match_files(const std::string& left, const std::string& right,
                      tiling::DisparityRange asked, const matcher::Options& options,
                      int threads, int repeats, const std::filesystem::path& folder);

} // namespace hsgm::bench
