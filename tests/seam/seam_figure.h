#pragma once

#include "matcher/options.h"
#include "pipeline/evaluate/seam_score.h"
#include "pipeline/synth/scene.h"
#include "tests/seam/stereo.h"

#include <string>
#include <vector>

namespace hsgm::seam {

/// Jumps at the borders of 64 px cells of a pair's match, of errors against the truth, on
/// pixels that both images show.
struct SeamFigures {
    evaluate::SeamScore raw;     ///< the matcher's winners, every pixel answered
    evaluate::SeamScore refined; ///< after left-right check and median
};
SeamFigures seam_figures(const StereoPair& pair, const matcher::Options& options);

/// One line a person can read.
std::string text(const SeamFigures& figures);

/// Slopes of all kinds and hardly a flat place.
synth::Scene ramps(tiling::Size size);

/// How a path starts at its window's border makes the seam, so all compete with the same
/// cost and the same penalties.
matcher::Options with_mode(matcher::Mode mode, int halo_px);

} // namespace hsgm::seam
