#include "io/vector_areas.h"

#include "io/error.h"
#include "io/gdal_session.h"
#include "io/vector_file_private.h"

#include <cpl_conv.h>
#include <ogr_srs_api.h>

namespace hsgm::io {

namespace {

bool is_polygon(OGRGeometryH geometry)
{
    const OGRwkbGeometryType type = wkbFlatten(OGR_G_GetGeometryType(geometry));
    return type == wkbPolygon || type == wkbMultiPolygon;
}

// Polygons, also from within collections.
void collect(OGRGeometryH geometry, std::vector<Geometry>& polygons)
{
    if (is_polygon(geometry)) {
        polygons.emplace_back(OGR_G_Clone(geometry));
        OGR_G_FlattenTo2D(polygons.back().get());
        return;
    }
    if (wkbFlatten(OGR_G_GetGeometryType(geometry)) == wkbGeometryCollection) {
        for (int i = 0; i < OGR_G_GetGeometryCount(geometry); ++i) {
            collect(OGR_G_GetGeometryRef(geometry, i), polygons);
        }
    }
}

std::vector<Geometry> polygons_in(OGRLayerH layer)
{
    std::vector<Geometry> polygons;
    OGR_L_ResetReading(layer);
    while (OGRFeatureH feature = OGR_L_GetNextFeature(layer)) {
        OGRGeometryH stored = OGR_F_GetGeometryRef(feature);
        if (stored != nullptr && OGR_G_IsEmpty(stored) == FALSE) {
            const Geometry straight(OGR_G_GetLinearGeometry(stored, 0, nullptr));
            collect(straight.get(), polygons);
        }
        OGR_F_Destroy(feature);
    }
    return polygons;
}

OGRLayerH layer_with_polygons(GDALDatasetH dataset)
{
    for (int i = 0; i < GDALDatasetGetLayerCount(dataset); ++i) {
        OGRLayerH layer = GDALDatasetGetLayer(dataset, i);
        if (!polygons_in(layer).empty()) {
            return layer;
        }
    }
    return nullptr;
}

void add_rings(OGRGeometryH geometry, VectorAreas& areas)
{
    if (wkbFlatten(OGR_G_GetGeometryType(geometry)) == wkbMultiPolygon) {
        for (int i = 0; i < OGR_G_GetGeometryCount(geometry); ++i) {
            add_rings(OGR_G_GetGeometryRef(geometry, i), areas);
        }
        return;
    }
    for (int i = 0; i < OGR_G_GetGeometryCount(geometry); ++i) {
        OGRGeometryH line = OGR_G_GetGeometryRef(geometry, i);
        auto& ring = areas.rings.emplace_back();
        for (int p = 0; p < OGR_G_GetPointCount(line); ++p) {
            ring.push_back({OGR_G_GetX(line, p), OGR_G_GetY(line, p)});
        }
    }
}

} // namespace

Dataset open_vector(const std::string& path)
{
    register_gdal();
    ErrorCollector errors;
    Dataset dataset(
        GDALOpenEx(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
    if (dataset == nullptr) {
        throw InputError("Cannot open " + path + " as a vector file; " + errors.quote() + ".");
    }
    return dataset;
}

bool is_vector(const std::string& path)
{
    register_gdal();
    ErrorCollector errors;
    const Dataset raster(
        GDALOpenEx(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
    if (raster != nullptr && GDALGetRasterCount(raster.get()) > 0) {
        return false;
    }
    const Dataset vector(
        GDALOpenEx(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
    return vector != nullptr;
}

std::vector<Geometry> polygons_of(GDALDatasetH dataset)
{
    OGRLayerH layer = layer_with_polygons(dataset);
    return layer == nullptr ? std::vector<Geometry>{} : polygons_in(layer);
}

std::string crs_of_polygons(GDALDatasetH dataset)
{
    OGRLayerH layer = layer_with_polygons(dataset);
    OGRSpatialReferenceH crs = layer == nullptr ? nullptr : OGR_L_GetSpatialRef(layer);
    std::string text;
    if (crs != nullptr) {
        const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
        char* wkt = nullptr;
        if (OSRExportToWktEx(crs, &wkt, options) == OGRERR_NONE) {
            text = wkt;
        }
        CPLFree(wkt);
    }
    // What GeoPackage calls an undefined system is none.
    return text.find("Undefined") == std::string::npos ? text : "";
}

VectorAreas read_areas(const std::string& path)
{
    const Dataset dataset = open_vector(path);
    ErrorCollector errors;
    // Joined, so that what lies in two polygons lies in one.
    const Geometry all(OGR_G_CreateGeometry(wkbMultiPolygon));
    for (const Geometry& polygon : polygons_of(dataset.get())) {
        if (wkbFlatten(OGR_G_GetGeometryType(polygon.get())) == wkbPolygon) {
            OGR_G_AddGeometry(all.get(), polygon.get());
        }
        for (int i = 0; i < OGR_G_GetGeometryCount(polygon.get()); ++i) {
            OGRGeometryH part = OGR_G_GetGeometryRef(polygon.get(), i);
            if (is_polygon(part)) {
                OGR_G_AddGeometry(all.get(), part);
            }
        }
    }
    VectorAreas areas;
    if (const Geometry joined{OGR_G_UnionCascaded(all.get())}) {
        add_rings(joined.get(), areas);
    }
    if (errors.failed()) {
        throw InputError("Cannot read " + path + "; " + errors.quote() + ".");
    }
    if (areas.rings.empty()) {
        throw InputError(path + " holds no polygon, so it bounds no area.");
    }
    areas.wkt = crs_of_polygons(dataset.get());
    return areas;
}

} // namespace hsgm::io
