#include "io/map_reference.h"

#include <ogr_spatialref.h>

namespace hsgm::io {

namespace {

OGRSpatialReference crs_of(const std::string& wkt)
{
    OGRSpatialReference crs;
    if (!wkt.empty()) {
        crs.importFromWkt(wkt.c_str());
    }
    return crs;
}

} // namespace

bool same_crs(const std::string& wkt, const std::string& other_wkt)
{
    if (wkt.empty() || other_wkt.empty()) {
        return wkt.empty() && other_wkt.empty();
    }
    const OGRSpatialReference crs = crs_of(wkt);
    const OGRSpatialReference other = crs_of(other_wkt);
    const char* const rules[] = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES",
                                 "CRITERION=EQUIVALENT", nullptr};
    return crs.IsSame(&other, rules) != FALSE;
}

bool in_degrees(const std::string& wkt)
{
    return !wkt.empty() && crs_of(wkt).IsGeographic() != FALSE;
}

std::string crs_name(const std::string& wkt)
{
    if (wkt.empty()) {
        return "no coordinate reference system";
    }
    const OGRSpatialReference crs = crs_of(wkt);
    const char* const name = crs.GetName();
    return name == nullptr ? "an unnamed reference system" : name;
}

} // namespace hsgm::io
