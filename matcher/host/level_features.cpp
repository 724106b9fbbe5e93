#include "matcher/host/level_features.h"

#include "matcher/host/birchfield_tomasi.h"
#include "matcher/host/census.h"
#include "matcher/host/gradient.h"
#include "matcher/host/texture.h"

#include <algorithm>
#include <atomic>
#include <vector>

namespace hsgm::matcher::host {

namespace {

// Tells features apart that follow each other in the same place of memory.
std::atomic<std::uint64_t> features_made{0};

using tiling::Patch;
using tiling::Rect;
using tiling::Size;

void write_validity(const Patch<std::uint16_t>& image, FeaturePlanes& planes)
{
    const Rect& rect = planes.rect();
    std::vector<std::uint8_t> valid(static_cast<std::size_t>(rect.cols));
    for (int row = rect.row; row < rect.row_end(); ++row) {
        std::transform(&image.at(row, rect.col), &image.at(row, rect.col) + rect.cols,
                       valid.begin(),
                       [](std::uint16_t pixel) { return is_valid(pixel) ? 255 : 0; });
        planes.write_validity(row, valid.data());
    }
}

void write_tones(const Patch<std::uint16_t>& image, Tone tone, int plane, FeaturePlanes& planes)
{
    const Rect& rect = planes.rect();
    std::vector<std::uint8_t> values(static_cast<std::size_t>(rect.cols));
    for (int row = rect.row; row < rect.row_end(); ++row) {
        tone_run(tone, &image.at(row, rect.col), rect.cols, values.data());
        planes.write(plane, row, values.data());
    }
}

int census_planes(Cost cost)
{
    return (static_cast<int>(census_bits(cost).size()) + 7) / 8;
}

FeaturePlanes cost_planes(const Patch<std::uint16_t>& image, Size full, const Rect& rect,
                          Tone tone, Cost cost, bool mirrored)
{
    FeaturePlanes planes(rect, feature_bytes(cost), mirrored);
    if (rect.empty()) {
        return planes;
    }
    const auto bits = census_bits(cost);
    if (!bits.empty()) {
        census(image, full, bits, cost == Cost::ternary5x5 ? tone.tolerance() : 0, planes);
    }
    if (cost == Cost::hmi || cost == Cost::census_ad) {
        write_tones(image, tone, census_planes(cost), planes);
    }
    if (cost == Cost::pairs_bt || cost == Cost::birchfield_tomasi) {
        gradients(image, full, tone, census_planes(cost), cost == Cost::birchfield_tomasi,
                  planes);
    }
    write_validity(image, planes);
    return planes;
}

} // namespace

int feature_bytes(Cost cost)
{
    const int census = census_planes(cost);
    switch (cost) {
    case Cost::census_ad:
    case Cost::hmi:
        return census + 1;
    case Cost::pairs_bt:
        return census + 3;
    case Cost::birchfield_tomasi:
        return census + 6;
    default:
        return census;
    }
}

LevelFeatures level_features(const LevelImages& images, const LevelPlan& plan, int level,
                             const Rect& aggregation, const PairTraits& pair,
                             const Options& options)
{
    const auto k = static_cast<std::size_t>(level);
    LevelFeatures f;
    f.left_size = plan.left_sizes[k];
    f.right_size = plan.right_sizes[k];
    f.images = &images;
    f.left_tone = tones(images.left, pair.left_tone);
    f.low_texture = low_texture(images.left, f.left_tone, aggregation);
    // A cost that looks at its neighbours' differences needs features of these, too.
    const Rect left =
        intersect(expand(aggregation, cost_block_radius(options.cost)), rect_of(f.left_size));
    const Rect right = intersect(right_reach(left, plan.ranges[k]), rect_of(f.right_size));
    f.left = cost_planes(images.left, f.left_size, left, pair.left_tone, options.cost, false);
    f.right =
        cost_planes(images.right, f.right_size, right, pair.right_tone, options.cost, true);
    f.number = ++features_made;
    return f;
}

} // namespace hsgm::matcher::host
