#pragma once

#include "io/scratch_raster.h"
#include "matcher/matcher.h"
#include "matcher/refine.h"

#include <filesystem>

namespace hsgm::pipeline {

/// First-pass results of all tiles, on scratch disk: what the second pass reads.
class FirstPass {
public:
    FirstPass(const matcher::PairShape& shape, const std::filesystem::path& scratch_folder);

    /// Stores a tile. Right-view keys of neighbouring tiles overlap and merge by minimum, so
    /// tiles may come in any order, but one at a time.
    void store(const matcher::TileMatch& tile);

    /// What `refine` needs of the first pass; its images stay empty. Only after every tile is
    /// stored.
    matcher::RefineInput read(const matcher::RefineSupport& support) const;

    /// Bytes of scratch disk for a pair of this shape.
    static std::int64_t disk_bytes(const matcher::PairShape& shape);

private:
    matcher::PairShape shape_;
    io::ScratchRaster<std::int32_t> disparity_q8_;
    io::ScratchRaster<std::uint8_t> confidence_;
    io::ScratchRaster<std::uint16_t> reasons_;
    io::ScratchRaster<std::uint32_t> right_keys_;
};

} // namespace hsgm::pipeline
