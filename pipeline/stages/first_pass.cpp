#include "pipeline/stages/first_pass.h"

#include "matcher/kernel.h"

#include <algorithm>

namespace hsgm::pipeline {

namespace {

template <typename T>
tiling::Patch<T> read_part(const io::ScratchRaster<T>& raster, const tiling::Rect& part)
{
    tiling::Patch<T> patch(part);
    raster.read(part, patch.pixels.view());
    return patch;
}

} // namespace

FirstPass::FirstPass(const matcher::PairShape& shape,
                     const std::filesystem::path& scratch_folder)
    : shape_(shape), disparity_q8_(scratch_folder, "disparity.raw", shape.left),
      confidence_(scratch_folder, "confidence.raw", shape.left),
      reasons_(scratch_folder, "reasons.raw", shape.left),
      right_keys_(scratch_folder, "right_keys.raw", shape.right, matcher::kNoKey)
{
}

void FirstPass::store(const matcher::TileMatch& tile)
{
    disparity_q8_.write(tile.core, tile.disparity_q8.view());
    confidence_.write(tile.core, tile.confidence.view());
    reasons_.write(tile.core, tile.reasons.view());
    if (tile.right_keys.rect.empty()) {
        return;
    }
    auto keys = read_part(right_keys_, tile.right_keys.rect);
    const auto theirs = tile.right_keys.pixels.pixels();
    std::transform(theirs.begin(), theirs.end(), keys.pixels.data(), keys.pixels.data(),
                   [](std::uint32_t a, std::uint32_t b) { return std::min(a, b); });
    right_keys_.write(keys.rect, keys.pixels.view());
}

matcher::RefineInput FirstPass::read(const matcher::RefineSupport& support) const
{
    matcher::RefineInput input;
    input.disparity_q8 = read_part(disparity_q8_, support.first_pass);
    input.confidence = read_part(confidence_, support.first_pass);
    input.reasons = read_part(reasons_, support.first_pass);
    input.right_keys = read_part(right_keys_, support.right_keys);
    return input;
}

std::int64_t FirstPass::disk_bytes(const matcher::PairShape& shape)
{
    return shape.left.area() * (4 + 1 + 2) + shape.right.area() * 4;
}

} // namespace hsgm::pipeline
