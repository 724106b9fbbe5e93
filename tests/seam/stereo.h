#pragma once

#include "matcher/matcher.h"
#include "matcher/refine.h"
#include "pipeline/synth/scene.h"
#include "tiling/tile_plan.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

// A pair, its pyramids, and the whole of it matched tile by tile, with nothing but the
// matcher's own interface: no files, no flow graph.
namespace hsgm::seam {

struct StereoPair {
    tiling::Image<std::uint16_t> left;
    tiling::Image<std::uint16_t> right;
    tiling::DisparityRange asked;
    tiling::Image<float> truth_px;       ///< empty where there is none; likewise below
    tiling::Image<std::uint8_t> visible; ///< 255: shows in both images

    matcher::PairShape shape() const { return {left.size(), right.size(), asked}; }
};

/// A city on hills with a little of everything: negative and positive disparities, plain
/// lots, holes and a border without data.
synth::Scene city(tiling::Size size, std::uint64_t seed);

/// The scene rendered; asks for the disparities that it has, and `margin_px` more.
StereoPair render(const synth::Scene& scene, int margin_px = 1);

/// Noise in both images, unrelated: every pixel and disparity has its own cost, and nothing
/// of a pixel's influence drowns in a clear winner.
StereoPair noise(tiling::Size left, int right_cols, tiling::DisparityRange asked,
                 std::uint64_t seed);

/// First-pass results of all tiles, merged.
struct Whole {
    tiling::Image<std::int32_t> disparity_q8;
    tiling::Image<std::uint8_t> confidence;
    tiling::Image<std::uint16_t> reasons;
    tiling::Image<std::uint32_t> right_keys;
};

/// Empty where both are the same, else which raster differs, where first and how often.
std::string difference(const Whole& a, const Whole& b);
std::string difference(const matcher::TileMatch& a, const matcher::TileMatch& b);
std::string difference(const matcher::Refined& a, const matcher::Refined& b);

class Match {
public:
    Match(const StereoPair& pair, const matcher::Options& options);

    const matcher::Matcher& matcher() const { return *matcher_; }

    /// The images of a tile's support, not a pixel more; or grown by `margin_px` beyond it
    /// on all sides, as far as the images go.
    std::vector<matcher::LevelImages> images(const tiling::Rect& core, int margin_px = 0) const;
    matcher::TileMatch match(const tiling::Rect& core,
                             const std::vector<matcher::LevelImages>& images) const;
    matcher::TileMatch match(const tiling::Rect& core) const
    {
        return match(core, images(core));
    }

    /// All tiles, each from its own support, in the given order. Size 0: untiled.
    Whole match_all(int tile_size_px, tiling::TileOrder order = tiling::TileOrder::rows) const;
    /// The second pass by pieces of this size; 0 = in one.
    matcher::Refined refine_all(const Whole& first_pass, int piece_size_px) const;

private:
    using Pyramid = std::vector<tiling::Image<std::uint16_t>>;

    Pyramid left_;
    Pyramid right_;
    std::unique_ptr<matcher::Matcher> matcher_;
    std::shared_ptr<const matcher::CoarseSolution> coarse_;
};

} // namespace hsgm::seam
