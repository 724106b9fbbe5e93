#pragma once

#include "pipeline/evaluate/coregistration.h"
#include "pipeline/evaluate/surface_score.h"
#include "pipeline/stages/surface_rows.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace hsgm::pipeline {

/// What is taken out before surfaces are compared.
enum class Alignment {
    shift, ///< east, north and up
    up,    ///< the height alone
    none,
};

struct SurfaceQuestion {
    SurfaceInputs inputs;
    std::vector<double> thresholds_m{0.5, 1, 2};
    Alignment alignment = Alignment::shift;
    std::vector<int> aligned_on; ///< classes that the shift is found on; empty: all cells
    std::string difference;      ///< GeoTIFF of test - reference to write, or empty
};

struct SurfaceAnswer {
    evaluate::SurfaceShift shift; ///< of the test against the reference; zero without alignment
    bool horizontal = false;      ///< whether the ground showed it; if not, only `up` was found
    double weakest_slope = 0;     ///< of the ground where it is flattest (`ShiftFit`)
    std::int64_t aligned_cells = 0; ///< that the last fit was made of
    int rounds = 0;
    evaluate::SurfaceScore all;
    std::vector<std::pair<int, evaluate::SurfaceScore>> classes; ///< those that occur
};

/// A surface model against a reference, files in, figures out: co-registration by Nuth and
/// Kaeaeb (2011) in rounds, each fitted to the differences within three NMAD of their median
/// on cells whose neighbours count, too, and slope by 45 degrees at most; then the scores. A
/// horizontal shift that passes a quarter of the reference's shorter side is none.
/// Throws io::ConfigError for what cannot be asked, io::InputError for what cannot be read.
SurfaceAnswer score_surface(const SurfaceQuestion& question);

} // namespace hsgm::pipeline
