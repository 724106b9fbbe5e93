// The camera against GDAL's RPC transformer, on every model at hand. GDAL reads the models
// with its own code, and its image coordinates are those of pixel corners: half a pixel more.

#include "io/rpc_metadata.h"
#include "pipeline/stages/camera_stage.h"
#include "tests/unit/geometry/data_folder.h"
#include "tests/unit/io/sample_rasters.h"

#include <gdal_alg.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <random>

using namespace hsgm;
using namespace hsgm::geometry;
using io::samples::TemporaryFolder;

namespace {

struct Differences {
    double forward_px = 0;    // ours against GDAL's
    double inverse_px = 0;    // ours against GDAL's, seen in the image
    double round_trip_px = 0; // ours back and forth
    int located_by_gdal = 0;  // of 1000
};

class GdalTransformer {
public:
    explicit GdalTransformer(const std::string& image)
    {
        GDALDatasetH dataset = GDALOpen(image.c_str(), GA_ReadOnly);
        REQUIRE(dataset != nullptr);
        GDALRPCInfoV2 info;
        REQUIRE(GDALExtractRPCInfoV2(GDALGetMetadata(dataset, "RPC"), &info) == TRUE);
        CPLStringList options;
        options.SetNameValue("RPC_PIXEL_ERROR_THRESHOLD", "0.0001");
        options.SetNameValue("RPC_MAX_ITERATIONS", "100");
        transformer_ = GDALCreateRPCTransformerV2(&info, FALSE, 0.0001, options.List());
        REQUIRE(transformer_ != nullptr);
        GDALClose(dataset);
    }
    ~GdalTransformer() { GDALDestroyRPCTransformer(transformer_); }
    GdalTransformer(const GdalTransformer&) = delete;
    GdalTransformer& operator=(const GdalTransformer&) = delete;

    ImagePoint project(const GeodeticPoint& g)
    {
        double x = g.longitude_deg;
        double y = g.latitude_deg;
        double z = g.height_m;
        int done = FALSE;
        GDALRPCTransform(transformer_, TRUE, 1, &x, &y, &z, &done);
        REQUIRE(done == TRUE);
        return {x - 0.5, y - 0.5};
    }
    // Nothing where GDAL's iteration does not converge.
    std::optional<GeodeticPoint> locate(ImagePoint image, double height_m)
    {
        double x = image.x + 0.5;
        double y = image.y + 0.5;
        double z = height_m;
        int done = FALSE;
        GDALRPCTransform(transformer_, FALSE, 1, &x, &y, &z, &done);
        return done == TRUE ? std::optional(GeodeticPoint{x, y, height_m}) : std::nullopt;
    }

private:
    void* transformer_ = nullptr;
};

double distance(ImagePoint a, ImagePoint b)
{
    return std::hypot(a.x - b.x, a.y - b.y);
}

// The part of the image in which points are drawn: the image itself, or what the model says
// it is for.
struct Frame {
    ImagePoint centre;
    ImagePoint half;
};

Frame frame_of(const RpcModel& m)
{
    return {{m.samp_off, m.line_off}, {m.samp_scale, m.line_scale}};
}

Frame frame_of(tiling::Size size)
{
    return {{(size.cols - 1) / 2.0, (size.rows - 1) / 2.0}, {size.cols / 2.0, size.rows / 2.0}};
}

// 1000 random points over the ground and heights of the model, and as many in the image.
Differences compare(const RpcCamera& camera, const Frame& frame, const std::string& gdal_image)
{
    GdalTransformer theirs(gdal_image);
    const RpcModel& m = camera.model();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    Differences most;
    for (int i = 0; i < 1000; ++i) {
        const double l = unit(random);
        const double p = unit(random);
        const double height_m = m.height_off_m + unit(random) * m.height_scale_m;
        const GeodeticPoint ground{m.long_off_deg + l * m.long_scale_deg,
                                   m.lat_off_deg + p * m.lat_scale_deg, height_m};
        most.forward_px =
            std::max(most.forward_px, distance(camera.project(ground), theirs.project(ground)));
        const ImagePoint image{frame.centre.x + l * frame.half.x,
                               frame.centre.y + p * frame.half.y};
        const auto back = camera.locate(image, height_m);
        REQUIRE(back.has_value());
        most.round_trip_px =
            std::max(most.round_trip_px, distance(image, camera.project(*back)));
        if (const auto gdal = theirs.locate(image, height_m)) {
            most.inverse_px = std::max(most.inverse_px, distance(image, camera.project(*gdal)));
            ++most.located_by_gdal;
        }
    }
    return most;
}

void check(const std::string& name, const Differences& d)
{
    std::cout << name << ": forward " << d.forward_px << " px, inverse " << d.inverse_px
              << " px, round trip " << d.round_trip_px << " px, " << d.located_by_gdal
              << " located by GDAL\n";
    CAPTURE(name);
    CHECK(d.forward_px < 0.001);
    CHECK(d.round_trip_px < 0.01);
    CHECK(d.inverse_px < 0.01);
    CHECK(d.located_by_gdal == 1000);
}

// A raster beside which GDAL finds the model.
std::string image_with_sidecar(const TemporaryFolder& folder, const std::string& model)
{
    const std::string image = folder / "image.tif";
    io::samples::make_raster(image, GDT_Byte, {1, 1}, {{0}});
    std::filesystem::copy_file(model, folder / "image_RPC.TXT");
    return image;
}

} // namespace

TEST_CASE("RPC cameras agree with GDAL's on every image at hand")
{
    if (!samples::has_data("synthetic_satellite_500m")) {
        return;
    }
    for (const char* name :
         {"sat_reunion_pair/img_01.tif", "sat_reunion_pair/img_02.tif",
          "synthetic_satellite_500m/left.tif", "synthetic_satellite_500m/right.tif",
          "synthetic_satellite_500m/third.tif"}) {
        const std::string path = samples::data_folder() + "/" + name;
        const io::RasterSource image({path});
        check(name, compare(pipeline::open_camera(image), frame_of(image.size()), path));
    }
}

TEST_CASE("RPC cameras agree with GDAL's on every model at hand")
{
    if (!samples::has_data("../geometry_rpc")) {
        return;
    }
    int models = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(samples::data_folder() + "/../geometry_rpc")) {
        if (entry.path().extension() == ".txt") {
            const TemporaryFolder folder;
            const std::string image = image_with_sidecar(folder, entry.path());
            const RpcCamera camera(
                pipeline::to_model(io::read_rpc_file(entry.path().string())));
            check(entry.path().filename(), compare(camera, frame_of(camera.model()), image));
            ++models;
        }
    }
    CHECK(models == 24);
}

TEST_CASE("a .geom file and the image's own place in the scene make its camera")
{
    if (!samples::has_data("sat_gizeh_phr")) {
        return;
    }
    const std::string folder = samples::data_folder() + "/sat_gizeh_phr/";
    const io::RasterSource image({folder + "img1.tif"});
    const RpcCamera part = pipeline::open_camera(image, folder + "img1.geom");
    const RpcCamera whole(pipeline::to_model(io::read_rpc_file(folder + "img1.geom")));
    const GeodeticPoint apex{31.13422, 29.97922, 213}; // of the Great Pyramid
    const ImagePoint a = part.project(apex);
    const ImagePoint b = whole.project(apex);
    CHECK(a.x == Approx(b.x - 20500));
    CHECK(a.y == Approx(b.y - 5000));
    CHECK(a.x > 0);
    CHECK(a.x < 800);
    CHECK(a.y > 0);
    CHECK(a.y < 801);
}
