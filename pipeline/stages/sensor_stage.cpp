#include "pipeline/stages/sensor_stage.h"

#include "io/error.h"
#include "io/map_reference.h"
#include "pipeline/geometry/error.h"
#include "pipeline/stages/camera_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace hsgm::pipeline {

namespace {

using geometry::MapBox;
using geometry::MapGrid;
using geometry::MapProjection;
using geometry::OrthoModel;
using geometry::RpcModel;

constexpr double kSpareShare = 1.2; // of the margin round a levelled image

MapProjection map_of(const io::RasterSource& image, const std::string& crs)
{
    try {
        return MapProjection::from_text(crs);
    } catch (const std::invalid_argument& error) {
        throw io::ConfigError(
            fmt::format("the map of {} cannot be used: {}", image.description(), error.what()));
    }
}

std::optional<double> number_in(const std::map<std::string, std::string>& items,
                                const std::string& ending)
{
    for (const auto& [key, text] : items) {
        double value = 0;
        if (key.ends_with(ending) &&
            std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc()) {
            return value;
        }
    }
    return std::nullopt;
}

void set_view(OrthoModel& model, const io::RasterSource& image, const io::ImageSpec& spec,
              const MapProjection& map)
{
    const auto take = [&](geometry::ImagePoint slope) {
        model.slope_x = slope.x;
        model.slope_y = slope.y;
    };
    const auto by_angles = [&](const std::array<double, 2>& view) {
        take(geometry::slope_of_view(model.grid, model.size, map, view[0], view[1]));
    };
    if (spec.view_vector) {
        take(geometry::slope_of_vector(model.grid, model.size, map, (*spec.view_vector)[0],
                                       (*spec.view_vector)[1]));
    } else if (spec.view_deg) {
        by_angles(*spec.view_deg);
    } else if (!spec.rpc.empty()) {
        model.rpc = open_camera(image, spec.rpc).model();
    } else if (const auto stored = io::stored_rpc(image)) {
        model.rpc = to_model(*stored);
    } else if (const auto view = view_in(image)) {
        by_angles(*view);
    } else {
        throw io::InputError(fmt::format(
            "nothing says how the orthoimage {} was taken: give `rpc:` (of the raw image), "
            "`azimuth_deg:` and `incidence_deg:`, or `view_vector:`",
            image.description()));
    }
}

/// How far the relief of its surface moves pixels of the image, at most.
double margin_px(const OrthoModel& model, const geometry::ElevationGrid& dem,
                 const MapProjection& map)
{
    const geometry::OrthoGroundCamera camera(model, {}, map);
    constexpr double kRiseM = 100;
    auto place = model.grid.place_of({model.size.cols / 2.0, model.size.rows / 2.0});
    const auto at = [&](double height_m) {
        place.height_m = height_m;
        return camera.project(place);
    };
    const auto low = at(model.level_m - kRiseM);
    const auto high = at(model.level_m + kRiseM);
    const double px_per_m = std::hypot(high.x - low.x, high.y - low.y) / (2 * kRiseM);
    const double relief_m =
        std::max(dem.highest_m() - model.level_m, model.level_m - dem.lowest_m());
    if (!std::isfinite(px_per_m)) {
        throw geometry::GeometryError("the RPC does not reach the middle of the orthoimage: it "
                                      "is that of another image");
    }
    return std::ceil(kSpareShare * px_per_m * relief_m) + 1;
}

} // namespace

std::optional<std::array<double, 2>> view_in(const io::RasterSource& image)
{
    const auto own = image.metadata("");
    const auto azimuth = number_in(own, "VIEW_AZIMUTH_DEG");
    const auto incidence = number_in(own, "VIEW_INCIDENCE_DEG");
    if (azimuth && incidence) {
        return std::array{*azimuth, *incidence};
    }
    // GDAL gives the items of an .IMD file the names of the older version R.
    const auto imd = image.metadata("IMD");
    for (const std::string prefix : {".s", ".meanS"}) {
        const auto satellite_azimuth = number_in(imd, prefix + "atAz");
        const auto elevation = number_in(imd, prefix + "atEl");
        if (satellite_azimuth && elevation) {
            return std::array{*satellite_azimuth, 90 - *elevation};
        }
    }
    return std::nullopt;
}

OrthoModel open_ortho(const io::RasterSource& image, const io::ImageSpec& spec,
                      const OrthoBase& base)
{
    const io::GeoReference geo = image.geo_reference();
    if (!geo.transform || geo.wkt.empty()) {
        throw io::InputError(fmt::format(
            "{} is no orthoimage: it has no {}", image.description(),
            geo.transform ? "coordinate reference system" : "geotransform, so lies on no map"));
    }
    try {
        OrthoModel model;
        model.size = image.size();
        model.grid = MapGrid(*geo.transform);
        model.crs = io::horizontal_crs(geo.wkt);
        const MapProjection map = map_of(image, model.crs);
        set_view(model, image, spec, map);
        model.level_m = base.plane_m ? *base.plane_m
                        : base.dem   ? std::round(base.dem->middle_m())
                                     : 0;
        model.margin_px = base.plane_m || !base.dem ? 0 : margin_px(model, *base.dem, map);
        return model;
    } catch (const geometry::GeometryError& error) {
        throw io::InputError(fmt::format("{}: {}", image.description(), error.what()));
    }
}

MapBox lonlat_box(const OrthoModel& model)
{
    constexpr int kAlongSide = 8;
    MapBox box = MapBox::nothing();
    const MapProjection map = MapProjection::from_text(model.crs);
    for (int i = 0; i <= kAlongSide; ++i) {
        for (int j = 0; j <= kAlongSide; ++j) {
            const auto ground = map.inverse(
                model.grid.place_of({double(model.size.cols - 1) * j / kAlongSide,
                                     double(model.size.rows - 1) * i / kAlongSide}));
            if (std::isfinite(ground.longitude_deg) && std::isfinite(ground.latitude_deg)) {
                box.include(ground.longitude_deg, ground.latitude_deg);
            }
        }
    }
    return box;
}

MapBox lonlat_box(const RpcModel& model, tiling::Size size, double low_m, double high_m)
{
    MapBox box = MapBox::nothing();
    const geometry::RpcCamera camera(model);
    for (const double height : {low_m, high_m}) {
        for (const double x : {0.0, size.cols - 1.0}) {
            for (const double y : {0.0, size.rows - 1.0}) {
                if (const auto ground = camera.locate({x, y}, height)) {
                    box.include(ground->longitude_deg, ground->latitude_deg);
                }
            }
        }
    }
    return box;
}

bool same_sensor(const geometry::SensorModel& a, const geometry::SensorModel& b)
{
    if (a.ortho() == nullptr || b.ortho() == nullptr) {
        return a.model() == b.model();
    }
    OrthoModel same = *b.ortho();
    const OrthoModel& first = *a.ortho();
    const auto near = [](double p, double q) {
        return std::abs(p - q) <= 1e-9 * std::max(1.0, std::abs(p));
    };
    if (!near(first.slope_x, same.slope_x) || !near(first.slope_y, same.slope_y)) {
        return false;
    }
    same.slope_x = first.slope_x;
    same.slope_y = first.slope_y;
    return first == same;
}

std::shared_ptr<const geometry::ReliefWarp> warp_of(const geometry::SensorModel& model,
                                                    const OrthoBase& base)
{
    const bool warped = model.ortho() != nullptr && !base.plane_m && base.dem;
    return warped ? std::make_shared<const geometry::ReliefWarp>(*model.ortho(), base.dem)
                  : nullptr;
}

} // namespace hsgm::pipeline
