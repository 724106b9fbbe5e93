#pragma once

#include "matcher/options.h"
#include "pipeline/evaluate/seam_score.h"
#include "pipeline/synth/scene.h"
#include "tests/seam/stereo.h"

#include <string>
#include <vector>

namespace hsgm::seam {

/// Jumps at the borders of 64 px cells of matches, of errors against the truth, on pixels
/// that both images show.
struct SeamFigures {
    evaluate::SeamScore raw;     ///< the matcher's winners, every pixel answered
    evaluate::SeamScore refined; ///< after left-right check and median
};

/// The figures of several pairs as one: in a single scene of a megapixel the houses that
/// happen to stand on a border move the ratio by a tenth, even that of `sgm`, which has no
/// windows.
SeamFigures seam_figures(const std::vector<StereoPair>& pairs, const matcher::Options& options);

/// One line a person can read.
std::string text(const SeamFigures& figures);

/// Slopes of all kinds and hardly a flat place.
synth::Scene ramps(tiling::Size size, std::uint64_t seed);

/// Scenes of `make` with the seeds 1, 2, ...
std::vector<StereoPair> render_series(synth::Scene (*make)(tiling::Size, std::uint64_t),
                                      tiling::Size size, int count);

/// How a path starts at its window's border makes the seam, so all compete with the same
/// cost and the same penalties.
matcher::Options with_mode(matcher::Mode mode, int halo_px);

} // namespace hsgm::seam
