#pragma once

#include "matcher/cuda/device.h"
#include "matcher/matcher.h"
#include "matcher/refine.h"
#include "pipeline/bench/bench_pair.h"

#include <optional>
#include <string>

namespace hsgm::bench {

/// Where the time of a whole match goes, in seconds.
struct StageSeconds {
    double pyramid = 0;
    double table = 0;   ///< cost `hmi` alone: learning its table
    double coarse = 0;  ///< the coarsest level, solved whole; and getting a device ready
    double windows = 0; ///< every finer level of every tile, right-view keys included
    double second = 0;  ///< left-right check, reasons, median
};

/// A whole match: what came of it, and what it took.
struct MemoryMatch {
    matcher::Refined result;
    matcher::MatchStatistics work; ///< without the level that `hmi` learns from
    StageSeconds seconds;
};

/// Matches a pair from its pixels to its checked disparities without any file, on the
/// threads of the caller's arena: what `hsgm match` computes, with the same bits. Tiles
/// (0: one for the whole image) are matched as many at once as there are threads, or on
/// two streams of `device`.
/// Throws std::invalid_argument where options or shape are impossible, and
/// matcher::cuda::DeviceError where the device fails.
MemoryMatch match_in_memory(const BenchPair& pair, const matcher::Options& options,
                            int tile_size_px,
                            const matcher::cuda::DeviceInfo* device = nullptr);

/// Why a device cannot match tiles of such a pair; nothing where it can.
std::optional<std::string> why_not(const matcher::PairShape& shape,
                                   const matcher::Options& options, int tile_size_px,
                                   const matcher::cuda::DeviceInfo& device);

/// Upper bound of the memory that it takes, in bytes, with so many threads.
std::int64_t memory_match_bytes(const matcher::PairShape& shape,
                                const matcher::Options& options, int tile_size_px, int threads);

} // namespace hsgm::bench
