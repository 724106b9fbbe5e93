#include "pipeline/satellite_configuration.h"

#include "io/error.h"
#include "pipeline/geometry/map_projection.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <vector>

namespace hsgm::pipeline {

namespace {

using geometry::PointingModel;
using io::ConfigSection;

constexpr double kLowestM = -1000;
constexpr double kHighestM = 10000;

std::optional<PointingModel> read_pointing(ConfigSection& section)
{
    static const std::map<std::string, std::optional<PointingModel>> kModels{
        {"auto", PointingModel::automatic},
        {"shift", PointingModel::shift},
        {"affine", PointingModel::affine},
        {"none", std::nullopt}};
    return kModels.at(section.choice("pointing", "auto", {"auto", "shift", "affine", "none"}));
}

std::optional<geometry::HeightSpan> read_heights(ConfigSection& section)
{
    if (!section.has("heights_m")) {
        return std::nullopt;
    }
    const auto heights = section.numbers("heights_m", 2);
    if (!(heights[0] < heights[1]) || heights[0] < kLowestM || heights[1] > kHighestM) {
        section.fail("heights_m",
                     fmt::format("is [{:g}, {:g}]; it must be [lowest, highest] ground above "
                                 "the WGS84 ellipsoid, within {:g} to {:g} m",
                                 heights[0], heights[1], kLowestM, kHighestM));
    }
    return geometry::HeightSpan{heights[0], heights[1]};
}

/// The reference DEM, and how high above it the ground may be.
void read_dem(ConfigSection& section, SatelliteOptions& options)
{
    const auto path = section.optional_path("reference_dem");
    const std::string vertical = section.text("reference_dem_vertical", "auto");
    const auto above =
        section.has("above_dem_m") ? section.numbers("above_dem_m", 2) : std::vector<double>{};
    if (path) {
        options.dem = ElevationSpec{*path, vertical == "auto" ? "" : vertical};
    } else if (vertical != "auto" || !above.empty()) {
        section.fail(above.empty() ? "reference_dem_vertical" : "above_dem_m",
                     "has no meaning without reference_dem");
    }
    if (!above.empty()) {
        if (!(above[0] < above[1]) || above[0] < kLowestM || above[1] > kHighestM) {
            section.fail("above_dem_m",
                         fmt::format("is [{:g}, {:g}]; it must be [lowest, highest] ground "
                                     "over the reference DEM, within {:g} to {:g} m",
                                     above[0], above[1], kLowestM, kHighestM));
        }
        options.search.above_dem = geometry::HeightSpan{above[0], above[1]};
    }
    try {
        check_vertical(vertical == "auto" ? "" : vertical);
    } catch (const std::invalid_argument& error) {
        section.fail("reference_dem_vertical", std::string("cannot be used: ") + error.what());
    }
}

void check_map(ConfigSection& section, const PairGeometryOptions& search)
{
    // The automatic map is right wherever the images lie; with it, any zone shows whether the
    // vertical system can be had.
    const char* key = search.crs.empty() ? "vertical" : "crs";
    try {
        geometry::MapProjection::from_text(search.crs.empty() ? "EPSG:32631" : search.crs,
                                           search.vertical);
    } catch (const std::invalid_argument& error) {
        section.fail(key, std::string("cannot be used: ") + error.what());
    }
}

// The first of the section's keys that says something else than its default; empty: none does.
std::string first_given(const std::vector<std::string>& keys, const SatelliteOptions& given)
{
    const SatelliteOptions defaults;
    const auto& a = given.search;
    const auto& b = defaults.search;
    const std::map<std::string, bool> differs{
        {"heights_m", a.heights.has_value()},
        {"pointing", a.pointing != b.pointing},
        {"largest_pointing_px", a.largest_pointing_px != b.largest_pointing_px},
        {"epipolar_gsd_m", a.gsd_m != b.gsd_m},
        {"stored", !given.stored.empty()},
        {"pointing_from", !given.pointing_from.empty()},
        {"bounds", a.region.bounds.has_value()},
        {"region", !a.region.file.empty()},
        {"reference_dem", given.dem.has_value()},
        {"above_dem_m", a.above_dem.has_value()},
        {"gsd_m", given.dsm_gsd_m != defaults.dsm_gsd_m},
        {"min_confidence", given.dsm_min_confidence != defaults.dsm_min_confidence},
        {"crs", a.crs != b.crs},
        {"vertical", a.vertical != b.vertical}};
    const auto found = std::find_if(keys.begin(), keys.end(),
                                    [&](const std::string& key) { return differs.at(key); });
    return found == keys.end() ? "" : *found;
}

void refuse(const ConfigSection& section, const std::string& key, const char* why)
{
    if (!key.empty()) {
        section.fail(key, why);
    }
}

} // namespace

std::optional<SatelliteOptions> read_satellite(ConfigSection geometry, ConfigSection dsm,
                                               const std::string& kind)
{
    constexpr double kLeastM = 1e-3;
    constexpr double kMostM = 1000;
    const SatelliteOptions defaults;
    SatelliteOptions options;
    options.search.heights = read_heights(geometry);
    options.search.pointing = read_pointing(geometry);
    read_dem(geometry, options);
    options.search.largest_pointing_px =
        geometry.number("largest_pointing_px", defaults.search.largest_pointing_px, 1, 1000);
    options.search.gsd_m =
        geometry.number_or("epipolar_gsd_m", "auto", std::nullopt, kLeastM, kMostM).value_or(0);
    options.dsm_gsd_m =
        dsm.number_or("gsd_m", "auto", std::nullopt, kLeastM, kMostM).value_or(0);
    options.dsm_min_confidence =
        dsm.integer("min_confidence", defaults.dsm_min_confidence, 0, 255);
    options.stored = geometry.optional_path("stored").value_or("");
    options.pointing_from = geometry.optional_path("pointing_from").value_or("");
    options.search.region = read_region(dsm);
    const std::string crs = dsm.text("crs", "auto");
    options.search.crs = crs == "auto" ? "" : crs;
    const std::string vertical = dsm.text("vertical", "ellipsoid");
    options.search.vertical = vertical == "ellipsoid" ? "" : vertical;
    if (kind != "rpc" && kind != "ortho") {
        constexpr const char* kWhy = "is for geometry kind rpc or ortho only: leave it out";
        refuse(geometry,
               first_given({"heights_m", "pointing", "largest_pointing_px", "epipolar_gsd_m",
                            "stored", "pointing_from", "reference_dem", "above_dem_m"},
                           options),
               kWhy);
        refuse(dsm,
               first_given({"gsd_m", "min_confidence", "crs", "vertical", "bounds", "region"},
                           options),
               kWhy);
        return std::nullopt;
    }
    if (kind == "ortho") {
        options.search.ortho.emplace().plane_m =
            geometry.optional_number("reference_height_m", kLowestM, kHighestM);
    }
    if (options.dem && options.search.heights) {
        geometry.fail("heights_m", "and reference_dem say both where the ground is: give "
                                   "above_dem_m, heights over the DEM, instead");
    }
    if (!options.stored.empty()) {
        constexpr const char* kWhy = "is what geometry.stored says already: leave one of the "
                                     "two out";
        refuse(geometry,
               first_given({"heights_m", "pointing", "largest_pointing_px", "epipolar_gsd_m",
                            "pointing_from", "above_dem_m"},
                           options),
               kWhy);
        refuse(dsm, first_given({"crs", "vertical"}, options), kWhy);
    }
    if (!options.pointing_from.empty()) {
        refuse(geometry, first_given({"pointing", "largest_pointing_px"}, options),
               "is what geometry.pointing_from says already: leave one of the two out");
        options.search.pointing.reset();
    }
    check_map(dsm, options.search);
    return options;
}

} // namespace hsgm::pipeline
