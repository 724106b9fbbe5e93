#include "pipeline/stages/satellite_record.h"

#include "pipeline/geometry/map_projection.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace hsgm::pipeline {

std::string describe_geometry(const geometry::PairGeometry& pair)
{
    std::string pointing = "pointing as given";
    if (pair.pointing) {
        const geometry::Pointing& p = *pair.pointing;
        pointing =
            fmt::format("pointing mended by {:.2f} px{} from {} of {} tie points ({:.2f} "
                        "-> {:.2f} px rms)",
                        p.shift_px, p.affine ? " and a slope" : "", p.inliers, p.points,
                        p.rms_before_px, p.rms_after_px);
    }
    std::string likeness;
    if (pair.likeness) {
        likeness =
            fmt::format("; {:.1f} % of windows unlike", 100 * pair.likeness->unlike_share());
    }
    return fmt::format(
        "{}; heights {:.0f} to {:.0f} m above the ellipsoid; frame of {} x {} px "
        "of {:.3f} m, {:.2f} px per metre of height{}",
        pointing, pair.heights.low_m, pair.heights.high_m, pair.frame.size.cols,
        pair.frame.size.rows, pair.frame.gsd_m, pair.frame.px_per_m, likeness);
}

nlohmann::ordered_json geometry_json(const geometry::PairGeometry& pair)
{
    nlohmann::ordered_json json{
        {"heights_m", {pair.heights.low_m, pair.heights.high_m}},
        {"disparity_px", {pair.disparity.min, pair.disparity.max}},
        {"frame",
         {{"rows", pair.frame.size.rows},
          {"cols", pair.frame.size.cols},
          {"gsd_m", pair.frame.gsd_m},
          {"images_gsd_m", pair.frame.images_gsd_m},
          {"px_per_m", pair.frame.px_per_m}}},
        {"map", geometry::MapProjection::from_text(pair.output_map).name()},
        {"warnings", pair.warnings}};
    if (pair.pointing) {
        const geometry::Pointing& p = *pair.pointing;
        json["pointing"] = {
            {"shift_px", p.shift_px},           {"affine", p.affine},
            {"tie_points", p.points},           {"inliers", p.inliers},
            {"rms_before_px", p.rms_before_px}, {"rms_after_px", p.rms_after_px}};
    }
    if (pair.likeness) {
        json["likeness"] = {{"windows", pair.likeness->windows},
                            {"unlike_share", pair.likeness->unlike_share()}};
    }
    return json;
}

nlohmann::ordered_json dsm_json(const DsmSummary& dsm)
{
    nlohmann::ordered_json reasons;
    for (const auto& [reason, name] : dsm::kMissingNames) {
        if (reason != dsm::Missing::none) {
            reasons[std::string(name)] = dsm.with_reason[static_cast<std::size_t>(reason)];
        }
    }
    return {{"rows", dsm.grid.size.rows}, {"cols", dsm.grid.size.cols},
            {"cell", dsm.grid.cell},      {"west", dsm.grid.west()},
            {"north", dsm.grid.north()},  {"cells_with_value", dsm.cells_with_value},
            {"reasons", reasons}};
}

} // namespace hsgm::pipeline
