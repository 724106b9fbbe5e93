#include "pipeline/job.h"

#include <fmt/format.h>

namespace hsgm::pipeline {

std::vector<std::filesystem::path> OutputPaths::files() const
{
    std::vector<std::filesystem::path> asked;
    for (const auto& path : {disparity, confidence, reasons, height, depth, residual, dsm,
                             dsm_confidence, dsm_points, dsm_spread, dsm_reasons, dsm_pairs,
                             hillshade, disparity_picture, hillshade_picture}) {
        if (!path.empty()) {
            asked.push_back(path);
        }
    }
    return asked;
}

std::map<std::string, std::string> provenance(const Job& job)
{
    const matcher::Options m = job.matcher.resolved();
    return {
        {"HSGM_MODE", std::string(name(m.mode))},
        {"HSGM_COST", std::string(name(m.cost))},
        {"HSGM_DISPARITY", fmt::format("{}..{} px", job.disparity.min, job.disparity.max)},
        {"HSGM_PATHS", std::to_string(m.paths)},
        {"HSGM_LEVELS", m.levels == 0 ? "auto" : std::to_string(m.levels)},
        {"HSGM_WINDOW", fmt::format("{} px, halo {} px", m.window_px, m.halo_px)},
        {"HSGM_PENALTIES",
         fmt::format("p1 {}, p2 {}, half at tone step {}", m.p1, m.p2, m.p2_half_tone)},
        {"HSGM_PRIOR", m.prior ? "on" : "off"},
        {"HSGM_PRUNE", m.prune ? "on" : "off"},
        {"HSGM_LEFT_RIGHT",
         m.left_right_px < 0 ? "off" : fmt::format("{} px", m.left_right_px)},
        {"HSGM_SPECKLE", m.speckle_px == 0 ? "off"
                                           : fmt::format("below {} px, range {} px",
                                                         m.speckle_px, m.speckle_range_px)},
        {"HSGM_SUBPIXEL", std::string(name(m.subpixel))},
        {"HSGM_MIN_CONFIDENCE", std::to_string(m.min_confidence)},
        {"HSGM_MEDIAN", std::to_string(m.median)},
        {"HSGM_SMOOTH", std::to_string(m.smooth)},
        {"HSGM_FILL", m.fill == matcher::Fill::none
                          ? "none"
                          : fmt::format("{}, up to {} px", name(m.fill), m.fill_px)},
    };
}

} // namespace hsgm::pipeline
