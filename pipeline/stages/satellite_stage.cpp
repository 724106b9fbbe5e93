#include "pipeline/stages/satellite_stage.h"

#include "io/hillshade.h"
#include "io/raster_source.h"
#include "matcher/profile.h"
#include "pipeline/dsm/dsm_grid.h"
#include "pipeline/error.h"
#include "pipeline/geometry/map_projection.h"
#include "pipeline/geometry/pair_geometry.h"
#include "pipeline/stages/region_stage.h"
#include "pipeline/stages/stored_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace hsgm::pipeline {

namespace {

using geometry::MapProjection;
using geometry::PairGeometry;

/// Of a degree of latitude: what a cell given in metres is in a map of degrees.
constexpr double kMetresPerDegree = 111319.49;

double cell_m(const Job& job)
{
    const double asked = job.satellite->dsm_gsd_m;
    return asked > 0 ? asked : dsm::cell_for(job.satellite->pair->frame.images_gsd_m);
}

/// Reads the reference DEM where the images lie; what is to be said of it.
std::string take_dem(Job& job)
{
    SatelliteOptions& options = *job.satellite;
    if (!options.dem || options.search.dem) {
        return "";
    }
    constexpr double kSpareDeg = 0.002; // some 200 m, and a tenth of the sides
    geometry::MapBox box = ground_box({job.left, {}}, {job.right, {}}, options.search);
    box = box.grown(kSpareDeg + std::max(box.width(), box.height()) / 10);
    Elevation elevation = read_elevation(*options.dem, box);
    options.search.dem = elevation.grid;
    if (options.search.ortho) {
        options.search.ortho->dem = elevation.grid;
    }
    return elevation.warning;
}

/// A geometry of before likeness was measured leaves the penalties as they are, and so does
/// one that saw too little.
void fit_penalties(Job& job)
{
    constexpr int kEnoughWindows = 500;
    const auto& likeness = job.satellite->pair->likeness;
    if (job.satellite->search.likeness && likeness && likeness->windows >= kEnoughWindows) {
        matcher::fit_penalties(job.matcher, likeness->unlike_share());
    }
}

} // namespace

void plan_satellite(Job& job)
{
    SatelliteOptions& satellite = *job.satellite;
    const std::string warning = take_dem(job);
    if (satellite.stored.empty()) {
        SensorImage left{job.left, {}};
        SensorImage right{job.right, {}};
        if (!satellite.pointing_from.empty()) {
            std::tie(left.correction, right.correction) =
                read_corrections(satellite.pointing_from, job);
        }
        PairGeometry pair = find_pair_geometry(left, right, satellite.search);
        if (!warning.empty()) {
            pair.warnings.push_back(warning);
        }
        satellite.pair = std::make_shared<PairGeometry>(std::move(pair));
    } else {
        satellite.pair = std::make_shared<PairGeometry>(read_geometry(satellite.stored, job));
    }
    job.disparity = satellite.pair->disparity;
    fit_penalties(job);
}

DsmOptions dsm_options(const Job& job)
{
    const MapProjection map = MapProjection::from_text(job.satellite->pair->output_map);
    DsmOptions options;
    options.cells.cell_m = cell_m(job);
    options.cells.map_units_per_m = map.in_metres() ? 1 : 1 / kMetresPerDegree;
    options.cells.min_confidence = job.satellite->dsm_min_confidence;
    if (const RegionOptions& region = job.satellite->search.region; !region.empty()) {
        options.cells.region = region_on(region_deg(region, map), map);
    }
    options.map_wkt = map.wkt();
    options.metadata = provenance(job);
    options.metadata["HSGM_DSM_MIN_CONFIDENCE"] = std::to_string(options.cells.min_confidence);
    options.metadata["HSGM_MAP"] = map.name();
    options.metadata["HSGM_HEIGHTS"] = map.height_name();
    options.creation_options = job.outputs.creation_options;
    return options;
}

MatchedPair matched_pair(const Job& job)
{
    const PairGeometry& pair = *job.satellite->pair;
    const OutputPaths& o = job.outputs;
    const auto size = [](const geometry::SensorModel& model, const io::ImageSpec& image) {
        return model.ortho() == nullptr ? io::RasterSource(image).size()
                                        : model.ortho()->levelled_size();
    };
    return {o.disparity,
            o.confidence,
            o.reasons,
            &pair.ground,
            {&pair.frame, size(pair.left, job.left), size(pair.right, job.right)},
            pair.frame.gsd_m};
}

DsmSummary write_satellite_heights(const Job& job)
{
    const OutputPaths& o = job.outputs;
    return write_dsm(matched_pair(job), dsm_options(job),
                     {o.height,
                      o.residual,
                      o.dsm,
                      o.dsm_confidence,
                      o.dsm_points,
                      o.dsm_spread,
                      o.dsm_reasons,
                      {}});
}

std::int64_t held_bytes(const Job& job)
{
    const PairGeometry& pair = *job.satellite->pair;
    const auto bytes_of = [](const geometry::Lattice& lattice) {
        return static_cast<std::int64_t>(lattice.values().size() * sizeof(double));
    };
    const auto& dem = job.satellite->search.dem;
    return bytes_of(pair.frame.map) + bytes_of(pair.frame.left) + bytes_of(pair.frame.right) +
           bytes_of(pair.ground.nodes()) +
           (dem ? dem->posts().size().area() * std::int64_t{sizeof(float)} : 0);
}

std::int64_t satellite_bytes(const Job& job, int threads)
{
    const geometry::EpipolarFrame& frame = job.satellite->pair->frame;
    // However the frame lies on the map, the DSM's sides are not longer than its diagonal.
    const double side =
        std::hypot(frame.size.rows, frame.size.cols) * frame.gsd_m / cell_m(job);
    const int cells = static_cast<int>(std::min(side, 1e9)) + 1;
    return std::max({dsm_bytes(frame.gsd_m, cell_m(job), threads),
                     job.outputs.hillshade.empty() ? 0 : io::hillshade_bytes({cells, cells})});
}

std::int64_t satellite_output_bytes(const Job& job)
{
    const geometry::EpipolarFrame& frame = job.satellite->pair->frame;
    constexpr double kCellBytes = 4 + 4 + 1 + 1 + 1 + 1;
    // The DSM of a frame that lies aslant on the map is at most twice as large; and the
    // cloud-optimized one is made beside the plain one, with overviews.
    const double cells =
        static_cast<double>(frame.size.area()) * 2 * std::pow(frame.gsd_m / cell_m(job), 2);
    return frame.size.area() * 8 +
           static_cast<std::int64_t>(cells * (kCellBytes + (4 + 1) * 4.0 / 3));
}

} // namespace hsgm::pipeline
