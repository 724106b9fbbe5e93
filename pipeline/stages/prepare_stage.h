#pragma once

#include "io/geo_reference.h"
#include "io/scratch_raster.h"
#include "matcher/level_plan.h"
#include "matcher/matcher.h"
#include "pipeline/job.h"
#include "pipeline/stages/pixel_source.h"

#include <filesystem>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// Tones of a pair's images, which need a pass over all pixels.
struct PairTones {
    matcher::Tone left;
    matcher::Tone right;
};

/// Checksums of all pixels of a pair's sources, as read.
struct PairChecksums {
    std::string left;
    std::string right;
};

/// Both images of a pair as the matcher wants them, every pyramid level, on scratch disk, where
/// they stay. Reads are thread-safe.
class PreparedPair {
public:
    /// Streams both sources through once (twice for float sources), tells their checksums on
    /// the way and reduces them level by level; memory does not grow with the images. Throws
    /// InputError for an image without a single valid pixel.
    PreparedPair(PixelSource& left, PixelSource& right, int levels,
                 const std::filesystem::path& scratch_folder, PairChecksums& checksums);
    /// Opens what another process has prepared. Throws StorageError where it is not whole.
    PreparedPair(const matcher::PairShape& shape, int levels, const PairTones& tones,
                 const std::filesystem::path& scratch_folder);

    /// Returns when all of it is on the disk.
    void sync();

    PairTones tones() const { return {left_.tone, right_.tone}; }

    /// The parts of level `level` that a tile's support names.
    matcher::LevelImages read(int level, const tiling::LevelSupport& support) const;
    /// The whole images of a level.
    matcher::LevelImages read_whole(int level) const;

    /// Bytes of scratch disk that a pair takes.
    static std::int64_t disk_bytes(const matcher::PairShape& shape, int levels);

private:
    struct Pyramid {
        std::vector<io::ScratchRaster<std::uint16_t>> levels;
        matcher::Tone tone;
    };
    Pyramid left_;
    Pyramid right_;
};

} // namespace hsgm::pipeline
