#pragma once

#include "pipeline/dsm/cell_area.h"
#include "pipeline/geometry/footprint.h"
#include "pipeline/geometry/map_projection.h"
#include "pipeline/region.h"

#include <memory>
#include <vector>

namespace hsgm::pipeline {

/// The rings of a region of interest, x longitude and y latitude in degrees; sides are cut into
/// pieces so short that they stay straight on any map. Inside is what an odd number of rings
/// surrounds. `map` is what bounds without a reference system are in. Throws InputError for a
/// file that cannot be read, has no polygon or does not name its reference system, and for
/// places that the reference system does not reach.
std::vector<geometry::Polygon> region_deg(const RegionOptions& region,
                                          const geometry::MapProjection& map);

/// The same on a map, for its cells.
std::shared_ptr<const dsm::CellArea> region_on(const std::vector<geometry::Polygon>& region_deg,
                                               const geometry::MapProjection& map);

/// The least convex polygon round all corners, with `margin` beyond on each side.
geometry::Polygon convex_hull(std::vector<geometry::MapPoint> corners, double margin);

} // namespace hsgm::pipeline
