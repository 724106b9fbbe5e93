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

std::string horizontal_crs(const std::string& wkt)
{
    OGRSpatialReference crs = crs_of(wkt);
    if (wkt.empty()) {
        return "";
    }
    if (crs.IsCompound() != FALSE) {
        crs.StripVertical();
    }
    crs.DemoteTo2D(nullptr);
    const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
    char* text = nullptr;
    crs.exportToWkt(&text, options);
    const std::string result = text == nullptr ? "" : text;
    CPLFree(text);
    return result;
}

bool has_heights(const std::string& wkt)
{
    return !wkt.empty() &&
           (crs_of(wkt).IsCompound() != FALSE || crs_of(wkt).GetAxesCount() > 2);
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
