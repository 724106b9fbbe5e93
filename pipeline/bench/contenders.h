#pragma once

#include "matcher/cuda/device.h"
#include "matcher/instructions.h"
#include "matcher/options.h"
#include "pipeline/bench/peer.h"
#include "tiling/disparity_range.h"

#include <optional>
#include <string>
#include <vector>

namespace hsgm::bench {

/// What to measure. Of every list the first entry is the base; the others are measured one
/// at a time against it, everything else being as in the base.
struct BenchSettings {
    std::string scene = "town"; ///< see bench_scene
    std::vector<int> sides_px{2048};
    std::vector<int> disparities{128};
    std::string left; ///< given images instead of a scene; both or none
    std::string right;
    tiling::DisparityRange asked; ///< for given images

    matcher::Options options;
    std::vector<matcher::Cost> costs{matcher::Cost::ternary5x5};
    std::vector<matcher::Instructions> instructions; ///< empty: what the matcher chooses
    std::vector<int> threads{1};
    std::vector<matcher::cuda::DeviceInfo> devices; ///< to measure beside the processor
    std::vector<Peer> peers;
    int tile_size_px = 0; ///< of matches in memory; 0: untiled
    int repeats = 3;
    bool whole = false; ///< measure `hsgm match` from files to files, too
};

/// One thing whose time is taken.
struct Contender {
    std::string title;
    std::optional<Peer> peer; ///< nothing: hsgm itself, with the two below
    matcher::Options options;
    std::optional<matcher::Instructions> instructions;
    std::optional<matcher::cuda::DeviceInfo> device; ///< that matches the tiles
    int threads = 1;
    std::size_t base = 0; ///< index of the contender that it is compared with; 0 for the first
};

/// The contenders of a benchmark, in the order of the report: the base, the same without
/// pruning, with other instructions, with other costs; on devices with every cost, and without
/// pruning; the peers; and for every further
/// number of threads the base, compared with that of the first number, and the peers,
/// compared with hsgm on as many threads.
std::vector<Contender> contenders(const BenchSettings& settings);

} // namespace hsgm::bench
