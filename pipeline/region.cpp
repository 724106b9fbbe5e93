#include "pipeline/region.h"

#include "pipeline/geometry/map_projection.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace hsgm::pipeline {

RegionOptions read_region(io::ConfigSection& section)
{
    RegionOptions region;
    const bool given = section.has("bounds");
    region.bounds_crs = section.optional_text("bounds_crs").value_or("");
    region.file = section.optional_path("region").value_or("");
    if (given) {
        const auto bounds = section.numbers("bounds", 4);
        region.bounds.emplace();
        std::copy_n(bounds.begin(), 4, region.bounds->begin());
        const auto [west, south, east, north] = *region.bounds;
        if (!(west < east && south < north)) {
            section.fail("bounds",
                         fmt::format("is [{:g}, {:g}, {:g}, {:g}]; it must be [west, south, "
                                     "east, north] with west < east and south < north",
                                     west, south, east, north));
        }
        if (!region.file.empty()) {
            section.fail("region",
                         "and bounds both say which part is wanted: give one of them");
        }
    }
    if (!region.bounds_crs.empty()) {
        if (!given) {
            section.fail("bounds_crs", "has no meaning without bounds: give both, or neither");
        }
        try {
            geometry::MapProjection::from_text(region.bounds_crs);
        } catch (const std::invalid_argument& error) {
            section.fail("bounds_crs", std::string("cannot be used: ") + error.what());
        }
    }
    return region;
}

} // namespace hsgm::pipeline
