#include "pipeline/stages/satellite_stage.h"

#include "io/hillshade.h"
#include "io/raster_source.h"
#include "pipeline/dsm/dsm_grid.h"
#include "pipeline/error.h"
#include "pipeline/geometry/map_projection.h"
#include "pipeline/geometry/pair_geometry.h"
#include "pipeline/stages/region_stage.h"
#include "pipeline/stages/stored_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

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

/// The program itself and its libraries.
constexpr std::int64_t kProgramBytes = std::int64_t{64} << 20;

std::int64_t search_bytes(const Job& job)
{
    return job.satellite->stored.empty()
               ? geometry_search_bytes(io::RasterSource(job.left).size(),
                                       io::RasterSource(job.right).size())
               : 0;
}

/// The search comes before the plan, which needs what it finds.
void require_memory_for_search(const Job& job)
{
    constexpr std::int64_t kMiB = std::int64_t{1} << 20;
    const std::int64_t needed = kProgramBytes + search_bytes(job);
    const auto allowed = static_cast<std::int64_t>(
        job.run.memory_bytes.value_or(std::numeric_limits<std::int64_t>::max()));
    if (needed > allowed) {
        throw BudgetError(fmt::format(
            "to find the geometry of {} and {} takes {} MiB of memory, but the run may take {} "
            "MiB: allow more with --memory, or name the geometry.json of an earlier run as "
            "geometry.stored",
            job.left.path, job.right.path, needed / kMiB, allowed / kMiB));
    }
}

} // namespace

void plan_satellite(Job& job)
{
    SatelliteOptions& satellite = *job.satellite;
    if (satellite.stored.empty()) {
        require_memory_for_search(job);
        SensorImage left{job.left, {}};
        SensorImage right{job.right, {}};
        if (!satellite.pointing_from.empty()) {
            std::tie(left.correction, right.correction) =
                read_corrections(satellite.pointing_from, job);
        }
        satellite.pair =
            std::make_shared<PairGeometry>(find_pair_geometry(left, right, satellite.search));
    } else {
        satellite.pair = std::make_shared<PairGeometry>(read_geometry(satellite.stored, job));
    }
    job.disparity = satellite.pair->disparity;
}

DsmOptions dsm_options(const Job& job)
{
    const MapProjection map = MapProjection::from_text(job.satellite->pair->output_map);
    DsmOptions options;
    options.cells.cell_m = cell_m(job);
    options.cells.map_units_per_m = map.in_metres() ? 1 : 1 / kMetresPerDegree;
    if (const RegionOptions& region = job.satellite->search.region; !region.empty()) {
        options.cells.region = region_on(region_deg(region, map), map);
    }
    options.map_wkt = map.wkt();
    options.metadata = provenance(job);
    options.metadata["HSGM_MAP"] = map.name();
    options.metadata["HSGM_HEIGHTS"] = map.height_name();
    options.creation_options = job.outputs.creation_options;
    return options;
}

MatchedPair matched_pair(const Job& job)
{
    const PairGeometry& pair = *job.satellite->pair;
    const OutputPaths& o = job.outputs;
    return {
        o.disparity,
        o.confidence,
        o.reasons,
        &pair.ground,
        {&pair.frame, io::RasterSource(job.left).size(), io::RasterSource(job.right).size()},
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

std::int64_t satellite_bytes(const Job& job, int threads)
{
    const geometry::EpipolarFrame& frame = job.satellite->pair->frame;
    // However the frame lies on the map, the DSM's sides are not longer than its diagonal.
    const double side =
        std::hypot(frame.size.rows, frame.size.cols) * frame.gsd_m / cell_m(job);
    const int cells = static_cast<int>(std::min(side, 1e9)) + 1;
    return std::max({dsm_bytes(frame.gsd_m, cell_m(job), threads),
                     job.outputs.hillshade.empty() ? 0 : io::hillshade_bytes({cells, cells}),
                     search_bytes(job)});
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
