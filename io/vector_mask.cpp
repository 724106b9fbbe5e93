#include "io/vector_mask_private.h"

#include "io/error.h"
#include "io/rpc_metadata.h"

#include <cpl_string.h>
#include <gdal_alg.h>

#include <algorithm>
#include <cstdint>

namespace hsgm::io {

namespace {

struct TransformerDestroyer {
    void operator()(void* transformer) const { GDALDestroyGenImgProjTransformer(transformer); }
};
using Transformer = std::unique_ptr<void, TransformerDestroyer>;

// The image with the model of another file as its own.
Dataset with_rpc(GDALDatasetH image, const std::string& image_path, const std::string& rpc_file)
{
    Dataset copy(GDALCreateCopy(GDALGetDriverByName("VRT"), "", image, FALSE, nullptr, nullptr,
                                nullptr));
    RpcMetadata rpc = read_rpc_file(rpc_file);
    const auto first = first_pixel_in_scene(rpc, geo_reference_of(image), image_path);
    rpc.samp_off -= first[0];
    rpc.line_off -= first[1];
    CPLStringList items;
    for (const auto& [key, value] : rpc_items(rpc)) {
        items.SetNameValue(key.c_str(), value.c_str());
    }
    GDALSetMetadata(copy.get(), items.List(), "RPC");
    return copy;
}

// From pixels of the image to coordinates of the polygons; null where nothing joins them.
Transformer transformer_of(GDALDatasetH image, const std::string& wkt)
{
    CPLStringList options;
    options.SetNameValue("DST_SRS", wkt.c_str());
    if (const char* height = GDALGetMetadataItem(image, "HEIGHT_OFF", "RPC")) {
        options.SetNameValue("METHOD", "RPC");
        options.SetNameValue("RPC_HEIGHT", height);
        options.SetNameValue("RPC_PIXEL_ERROR_THRESHOLD", "0.01");
    }
    return Transformer(GDALCreateGenImgProjTransformer2(image, nullptr, options.List()));
}

bool bring(OGRGeometryH geometry, void* transformer)
{
    for (int i = 0; i < OGR_G_GetGeometryCount(geometry); ++i) {
        if (!bring(OGR_G_GetGeometryRef(geometry, i), transformer)) {
            return false;
        }
    }
    if (OGR_G_GetGeometryCount(geometry) > 0) {
        return true;
    }
    for (int p = 0; p < OGR_G_GetPointCount(geometry); ++p) {
        double x = OGR_G_GetX(geometry, p);
        double y = OGR_G_GetY(geometry, p);
        double z = 0;
        int done = FALSE;
        if (GDALGenImgProjTransform(transformer, TRUE, 1, &x, &y, &z, &done) == FALSE ||
            done == FALSE) {
            return false;
        }
        OGR_G_SetPoint_2D(geometry, p, x, y);
    }
    return true;
}

} // namespace

VectorMask::VectorMask(const ImageSpec& spec, GDALDatasetH image) : path_(spec.mask)
{
    const Dataset file = open_vector(spec.mask);
    ErrorCollector errors;
    polygons_ = polygons_of(file.get());
    if (errors.failed()) {
        throw InputError("Cannot read the mask " + spec.mask + "; " + errors.quote() + ".");
    }
    char** list = GDALGetFileList(file.get());
    for (int i = 0; i < CSLCount(list); ++i) {
        files_.emplace_back(list[i]);
    }
    CSLDestroy(list);
    const std::string wkt = crs_of_polygons(file.get());
    if (wkt.empty()) {
        return;
    }
    std::string rpc = spec.rpc;
    if (rpc.empty() && GDALGetMetadata(image, "RPC") == nullptr) {
        rpc = geom_beside(spec.path);
    }
    const Dataset modelled = rpc.empty() ? nullptr : with_rpc(image, spec.path, rpc);
    const Transformer transformer =
        transformer_of(modelled != nullptr ? modelled.get() : image, wkt);
    bool brought = transformer != nullptr;
    for (const Geometry& polygon : polygons_) {
        brought = brought && bring(polygon.get(), transformer.get());
    }
    if (!brought) {
        throw InputError("The mask " + spec.mask + " is in map coordinates, which cannot be " +
                         "brought into the pixels of " + spec.path + " (" + errors.quote() +
                         "); give the polygons in pixels, without a reference system.");
    }
}

void VectorMask::read(const tiling::Rect& window, tiling::ImageView<double> mask) const
{
    ErrorCollector errors;
    const Dataset burnt(GDALCreate(GDALGetDriverByName("MEM"), "", window.cols, window.rows, 1,
                                   GDT_Byte, nullptr));
    std::vector<OGRGeometryH> geometries;
    for (const Geometry& polygon : polygons_) {
        geometries.push_back(polygon.get());
    }
    bool done = burnt != nullptr;
    if (done && !geometries.empty()) {
        double transform[] = {static_cast<double>(window.col), 1, 0,
                              static_cast<double>(window.row), 0, 1};
        int band = 1;
        const std::vector<double> ones(geometries.size(), 1.0);
        done =
            GDALSetGeoTransform(burnt.get(), transform) == CE_None &&
            GDALRasterizeGeometries(burnt.get(), 1, &band, static_cast<int>(geometries.size()),
                                    geometries.data(), nullptr, nullptr, ones.data(), nullptr,
                                    nullptr, nullptr) == CE_None;
    }
    std::vector<std::uint8_t> row(static_cast<std::size_t>(window.cols));
    for (int r = 0; done && r < window.rows; ++r) {
        done = GDALRasterIO(GDALGetRasterBand(burnt.get(), 1), GF_Read, 0, r, window.cols, 1,
                            row.data(), window.cols, 1, GDT_Byte, 0, 0) == CE_None;
        std::transform(row.begin(), row.end(), mask.row(r),
                       [](std::uint8_t burn) { return burn == 0 ? 1.0 : 0.0; });
    }
    if (!done) {
        throw InputError("Cannot lay the mask " + path_ + " on its image; " + errors.quote() +
                         ".");
    }
}

} // namespace hsgm::io
