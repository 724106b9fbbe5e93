#include "pipeline/stages/first_pass.h"

#include "matcher/kernel.h"
#include "matcher/reasons.h"
#include "pipeline/ledger/checksum.h"

#include <algorithm>
#include <utility>

namespace hsgm::pipeline {

namespace {

using tiling::Patch;
using tiling::Rect;

// Pixels of a tile, hashed as they lie in memory.
std::string sum_of(const tiling::Image<std::int32_t>& disparity_q8,
                   const tiling::Image<std::uint8_t>& confidence,
                   const tiling::Image<std::uint16_t>& reasons)
{
    ledger::Checksum sum;
    sum.add_values(disparity_q8.pixels());
    sum.add_values(confidence.pixels());
    sum.add_values(reasons.pixels());
    return sum.hex();
}

template <typename T>
tiling::Image<T> read_image(const io::ScratchRaster<T>& raster, const Rect& part)
{
    tiling::Image<T> image(part.size());
    raster.read(part, image.view());
    return image;
}

} // namespace

FirstPassPart::FirstPassPart(const matcher::PairShape& shape, const Rect& band,
                             const std::filesystem::path& folder, io::ScratchLife life)
    : shape_(shape), band_(band), disparity_q8_(folder, "disparity.raw", band.size(), 0, life),
      confidence_(folder, "confidence.raw", band.size(), 0, life),
      reasons_(folder, "reasons.raw", band.size(), 0, life),
      right_keys_(folder, "right_keys.raw", {band.rows, shape.right.cols}, 0, life)
{
}

Rect FirstPassPart::in_band(const Rect& rect) const
{
    return {rect.row - band_.row, rect.col, rect.rows, rect.cols};
}

void FirstPassPart::store(const matcher::TileMatch& tile)
{
    const Rect core = in_band(tile.core);
    disparity_q8_.write(core, tile.disparity_q8.view());
    confidence_.write(core, tile.confidence.view());
    reasons_.write(core, tile.reasons.view());
    const Rect seen = in_band(tile.right_keys.rect);
    if (seen.empty()) {
        return;
    }
    auto keys = read_image(right_keys_, seen);
    const auto theirs = tile.right_keys.pixels.pixels();
    std::transform(theirs.begin(), theirs.end(), keys.data(), keys.data(),
                   [](std::uint32_t a, std::uint32_t b) { return std::max(~a, b); });
    right_keys_.write(seen, keys.view());
}

void FirstPassPart::sync()
{
    disparity_q8_.sync();
    confidence_.sync();
    reasons_.sync();
    right_keys_.sync();
}

std::string FirstPassPart::checksum(const Rect& core) const
{
    const Rect part = in_band(core);
    return sum_of(read_image(disparity_q8_, part), read_image(confidence_, part),
                  read_image(reasons_, part));
}

std::string checksum(const matcher::TileMatch& tile)
{
    return sum_of(tile.disparity_q8, tile.confidence, tile.reasons);
}

void FirstPass::add(std::shared_ptr<const FirstPassPart> part, std::vector<Rect> done)
{
    sources_.push_back({std::move(part), std::move(done)});
}

matcher::RefineInput FirstPass::read(const matcher::RefineSupport& support) const
{
    matcher::RefineInput input;
    input.disparity_q8 = Patch<std::int32_t>(support.first_pass);
    input.confidence = Patch<std::uint8_t>(support.first_pass);
    input.reasons = Patch<std::uint16_t>(support.first_pass, matcher::kFailedTile);
    input.right_keys = Patch<std::uint32_t>(support.right_keys);
    for (const Source& source : sources_) {
        for (const Rect& done : source.done) {
            read_done(*source.part, intersect(done, support.first_pass), input);
        }
        merge_keys(*source.part, input.right_keys);
    }
    auto& keys = input.right_keys.pixels;
    std::transform(keys.pixels().begin(), keys.pixels().end(), keys.data(),
                   [](std::uint32_t key) { return ~key; });
    return input;
}

void FirstPass::read_done(const FirstPassPart& part, const Rect& done,
                          matcher::RefineInput& input) const
{
    if (done.empty()) {
        return;
    }
    const Rect stored = part.in_band(done);
    part.disparity_q8_.read(stored, input.disparity_q8.view_of(done));
    part.confidence_.read(stored, input.confidence.view_of(done));
    part.reasons_.read(stored, input.reasons.view_of(done));
}

void FirstPass::merge_keys(const FirstPassPart& part, Patch<std::uint32_t>& merged) const
{
    const Rect rows{part.band_.row, 0, part.band_.rows, shape_.right.cols};
    const Rect seen = intersect(merged.rect, rows);
    if (seen.empty()) {
        return;
    }
    const auto keys = read_image(part.right_keys_, part.in_band(seen));
    for (int row = seen.row; row < seen.row_end(); ++row) {
        const std::uint32_t* theirs = keys.row(row - seen.row);
        std::uint32_t* all = &merged.at(row, seen.col);
        std::transform(theirs, theirs + seen.cols, all, all,
                       [](std::uint32_t a, std::uint32_t b) { return std::max(a, b); });
    }
}

std::int64_t FirstPass::disk_bytes(const matcher::PairShape& shape, std::int64_t rows)
{
    return rows *
           (std::int64_t{shape.left.cols} * (4 + 1 + 2) + std::int64_t{shape.right.cols} * 4);
}

} // namespace hsgm::pipeline
