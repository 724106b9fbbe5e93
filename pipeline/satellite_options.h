#pragma once

#include "pipeline/stages/geometry_search.h"

#include <memory>
#include <string>

namespace hsgm::pipeline {

/// How a raw pair with RPCs, or one of orthoimages, becomes a DSM.
struct SatelliteOptions {
    PairGeometryOptions search;
    std::optional<ElevationSpec> dem; ///< read into `search` by planning
    double dsm_gsd_m = 0; ///< side of a cell of the DSM; 0: a round number near the images'
    int dsm_min_confidence = 180; ///< cells of less have no value
    /// A geometry whose corrections of both images are taken; empty: they are to be found.
    std::string pointing_from;
    std::string stored; ///< a geometry that an earlier run found; empty: it is to be found
    /// What planning found; every stage reads it and none changes it.
    std::shared_ptr<const geometry::PairGeometry> pair;
};

} // namespace hsgm::pipeline
