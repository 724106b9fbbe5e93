#pragma once

#include "io/scratch_raster.h"
#include "matcher/matcher.h"
#include "matcher/refine.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// First-pass results of some rows of the left image, on scratch disk, by one writer. Storing a
/// tile again gives the same, also where an earlier attempt at it was cut off half way.
class FirstPassPart {
public:
    /// The rows of `band`, all columns. Makes the files, or opens those that an earlier process
    /// kept. Throws StorageError.
    FirstPassPart(const matcher::PairShape& shape, const tiling::Rect& band,
                  const std::filesystem::path& folder, io::ScratchLife life);

    /// Stores a tile whose core lies in the band. Right-view keys of neighbouring tiles overlap
    /// and merge by minimum, so tiles may come in any order, but one at a time.
    void store(const matcher::TileMatch& tile);
    /// Returns when everything stored is on the disk.
    void sync();

    /// Checksum of what is stored for these pixels, keys apart: the same as that of the tile
    /// that was stored, if nothing happened to it.
    std::string checksum(const tiling::Rect& core) const;

private:
    friend class FirstPass;
    tiling::Rect in_band(const tiling::Rect& rect) const;

    matcher::PairShape shape_;
    tiling::Rect band_;
    io::ScratchRaster<std::int32_t> disparity_q8_;
    io::ScratchRaster<std::uint8_t> confidence_;
    io::ScratchRaster<std::uint16_t> reasons_;
    // Complements, and so merged by maximum: the zeros of a new file mean "no key", also after
    // a power cut.
    io::ScratchRaster<std::uint32_t> right_keys_;
};

/// Checksum of a tile's results, as FirstPassPart::checksum finds it once they are stored.
std::string checksum(const matcher::TileMatch& tile);

/// First-pass results of the whole image: what the second pass reads, from all shards.
class FirstPass {
public:
    explicit FirstPass(const matcher::PairShape& shape) : shape_(shape) {}

    /// Takes results into view: `part` has those of the pixels in `done`.
    void add(std::shared_ptr<const FirstPassPart> part, std::vector<tiling::Rect> done);

    /// What `refine` needs of the first pass; its images stay empty. Pixels that nobody has
    /// results of carry the reason failed_tile.
    matcher::RefineInput read(const matcher::RefineSupport& support) const;

    /// Bytes of scratch disk for so many rows of a pair.
    static std::int64_t disk_bytes(const matcher::PairShape& shape, std::int64_t rows);

private:
    struct Source {
        std::shared_ptr<const FirstPassPart> part;
        std::vector<tiling::Rect> done;
    };
    // Both of pixels that are in the part.
    void read_done(const FirstPassPart& part, const tiling::Rect& done,
                   matcher::RefineInput& input) const;
    void merge_keys(const FirstPassPart& part, tiling::Patch<std::uint32_t>& merged) const;

    matcher::PairShape shape_;
    std::vector<Source> sources_;
};

} // namespace hsgm::pipeline
