#include "pipeline/stages/satellite_stage.h"

#include "io/hillshade.h"
#include "pipeline/dsm/dsm_grid.h"
#include "pipeline/geometry/map_projection.h"
#include "pipeline/geometry/pair_geometry.h"
#include "pipeline/stages/stored_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

DsmOptions dsm_options(const Job& job, const MapProjection& map)
{
    DsmOptions options;
    options.cell_m = cell_m(job);
    options.map_wkt = map.wkt();
    options.map_units_per_m = map.in_metres() ? 1 : 1 / kMetresPerDegree;
    options.metadata = provenance(job);
    options.metadata["HSGM_MAP"] = map.name();
    options.metadata["HSGM_HEIGHTS"] = map.height_name();
    options.creation_options = job.outputs.creation_options;
    return options;
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

} // namespace

void plan_satellite(Job& job)
{
    const std::string warning = take_dem(job);
    const std::string& stored = job.satellite->stored;
    PairGeometry pair = stored.empty() ? find_pair_geometry({job.left, {}}, {job.right, {}},
                                                            job.satellite->search)
                                       : read_geometry(stored, job);
    if (stored.empty() && !warning.empty()) {
        pair.warnings.push_back(warning);
    }
    job.satellite->pair = std::make_shared<PairGeometry>(std::move(pair));
    job.disparity = job.satellite->pair->disparity;
}

DsmSummary write_satellite_heights(const Job& job)
{
    const PairGeometry& pair = *job.satellite->pair;
    const MapProjection map = MapProjection::from_text(pair.output_map);
    const OutputPaths& o = job.outputs;
    return write_dsm(
        {o.disparity, o.confidence, &pair.ground, pair.frame.gsd_m}, dsm_options(job, map),
        {o.height, o.residual, o.dsm, o.dsm_confidence, o.dsm_points, o.dsm_spread});
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
    return std::max(dsm_bytes(frame.gsd_m, cell_m(job), threads),
                    job.outputs.hillshade.empty() ? 0 : io::hillshade_bytes({cells, cells}));
}

std::int64_t satellite_output_bytes(const Job& job)
{
    const geometry::EpipolarFrame& frame = job.satellite->pair->frame;
    constexpr double kCellBytes = 4 + 4 + 1 + 1 + 1;
    // The DSM of a frame that lies aslant on the map is at most twice as large; and the
    // cloud-optimized one is made beside the plain one, with overviews.
    const double cells =
        static_cast<double>(frame.size.area()) * 2 * std::pow(frame.gsd_m / cell_m(job), 2);
    return frame.size.area() * 8 +
           static_cast<std::int64_t>(cells * (kCellBytes + 4 * 4.0 / 3));
}

} // namespace hsgm::pipeline
