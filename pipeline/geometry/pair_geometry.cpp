#include "pipeline/geometry/pair_geometry.h"

#include "pipeline/geometry/error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <utility>

namespace hsgm::geometry {

namespace {

using nlohmann::json;

constexpr const char* kFormat = "hsgm-pair-geometry";
constexpr int kVersion = 1;

json written(const RpcModel& m)
{
    return {{"line_off", m.line_off},
            {"samp_off", m.samp_off},
            {"lat_off_deg", m.lat_off_deg},
            {"long_off_deg", m.long_off_deg},
            {"height_off_m", m.height_off_m},
            {"line_scale", m.line_scale},
            {"samp_scale", m.samp_scale},
            {"lat_scale_deg", m.lat_scale_deg},
            {"long_scale_deg", m.long_scale_deg},
            {"height_scale_m", m.height_scale_m},
            {"line_num", m.line_num},
            {"line_den", m.line_den},
            {"samp_num", m.samp_num},
            {"samp_den", m.samp_den}};
}

RpcModel model(const json& j)
{
    RpcModel m;
    j.at("line_off").get_to(m.line_off);
    j.at("samp_off").get_to(m.samp_off);
    j.at("lat_off_deg").get_to(m.lat_off_deg);
    j.at("long_off_deg").get_to(m.long_off_deg);
    j.at("height_off_m").get_to(m.height_off_m);
    j.at("line_scale").get_to(m.line_scale);
    j.at("samp_scale").get_to(m.samp_scale);
    j.at("lat_scale_deg").get_to(m.lat_scale_deg);
    j.at("long_scale_deg").get_to(m.long_scale_deg);
    j.at("height_scale_m").get_to(m.height_scale_m);
    j.at("line_num").get_to(m.line_num);
    j.at("line_den").get_to(m.line_den);
    j.at("samp_num").get_to(m.samp_num);
    j.at("samp_den").get_to(m.samp_den);
    return m;
}

json written(const ImageCorrection& c)
{
    return {{"x_px", c.x_px}, {"x_by_x", c.x_by_x}, {"x_by_y", c.x_by_y},
            {"y_px", c.y_px}, {"y_by_x", c.y_by_x}, {"y_by_y", c.y_by_y}};
}

ImageCorrection correction(const json& j)
{
    return {j.at("x_px"), j.at("x_by_x"), j.at("x_by_y"),
            j.at("y_px"), j.at("y_by_x"), j.at("y_by_y")};
}

json written(const OrthoModel& m)
{
    json j{{"rows", m.size.rows},
           {"cols", m.size.cols},
           {"crs", m.crs},
           {"grid", m.grid.corner_transform()},
           {"level_m", m.level_m},
           {"margin_px", m.margin_px},
           {"slope", {m.slope_x, m.slope_y}}};
    if (m.rpc) {
        j["rpc"] = written(*m.rpc);
    }
    return j;
}

OrthoModel ortho_model(const json& j)
{
    OrthoModel m;
    m.size = {j.at("rows"), j.at("cols")};
    j.at("crs").get_to(m.crs);
    m.grid = MapGrid(j.at("grid").get<std::array<double, 6>>());
    j.at("level_m").get_to(m.level_m);
    j.at("margin_px").get_to(m.margin_px);
    m.slope_x = j.at("slope").at(0);
    m.slope_y = j.at("slope").at(1);
    if (j.contains("rpc")) {
        m.rpc = model(j.at("rpc"));
    }
    return m;
}

json written(const SensorModel& sensor)
{
    json j{{"correction", written(sensor.correction())}};
    if (sensor.rpc() != nullptr) {
        j["rpc"] = written(*sensor.rpc());
    } else {
        j["ortho"] = written(*sensor.ortho());
    }
    return j;
}

SensorModel sensor(const json& j)
{
    const ImageCorrection mended = correction(j.at("correction"));
    return j.contains("ortho") ? SensorModel(ortho_model(j.at("ortho")), mended)
                               : SensorModel(model(j.at("rpc")), mended);
}

json written(const Lattice& lattice)
{
    return {{"first_row", lattice.first_row()}, {"first_col", lattice.first_col()},
            {"step", lattice.step()},           {"rows", lattice.rows()},
            {"cols", lattice.cols()},           {"channels", lattice.channels()},
            {"values", lattice.values()}};
}

Lattice lattice(const json& j, int channels)
{
    const int rows = j.at("rows");
    const int cols = j.at("cols");
    const double step = j.at("step");
    auto values = j.at("values").get<std::vector<double>>();
    if (rows < 4 || cols < 4 || !(step > 0) || j.at("channels") != channels ||
        values.size() != static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols) *
                             static_cast<std::size_t>(channels)) {
        throw GeometryError("a lattice of the stored geometry is damaged");
    }
    Lattice result(j.at("first_row"), j.at("first_col"), step, rows, cols, channels);
    result.values() = std::move(values);
    return result;
}

json written(const ReferenceSurface& surface)
{
    if (surface.is_level()) {
        return {{"level_m", surface.level_m()}};
    }
    const auto posts = surface.posts().pixels();
    return {{"west", surface.west()},
            {"north", surface.north()},
            {"step_m", surface.step_m()},
            {"rows", surface.posts().rows()},
            {"cols", surface.posts().cols()},
            {"posts", std::vector<double>(posts.begin(), posts.end())}};
}

ReferenceSurface surface(const json& j)
{
    if (j.contains("level_m")) {
        return ReferenceSurface(j.at("level_m").get<double>());
    }
    tiling::Image<double> posts({j.at("rows"), j.at("cols")});
    const auto heights = j.at("posts").get<std::vector<double>>();
    if (posts.rows() < 4 || posts.cols() < 4 || heights.size() != posts.pixels().size()) {
        throw GeometryError("the reference surface of the stored geometry is damaged");
    }
    std::copy(heights.begin(), heights.end(), posts.data());
    return {j.at("west"), j.at("north"), j.at("step_m"), std::move(posts)};
}

json written(const EpipolarFrame& f)
{
    return {{"rows", f.size.rows},
            {"cols", f.size.cols},
            {"images_gsd_m", f.images_gsd_m},
            {"gsd_m", f.gsd_m},
            {"px_per_m", f.px_per_m},
            {"angle_rad", f.angle_rad},
            {"below_m", f.below_m},
            {"above_m", f.above_m},
            {"lattice_error_px", f.lattice_error_px},
            {"map", written(f.map)},
            {"left", written(f.left)},
            {"right", written(f.right)}};
}

EpipolarFrame frame(const json& j)
{
    EpipolarFrame f;
    f.size = {j.at("rows"), j.at("cols")};
    j.at("images_gsd_m").get_to(f.images_gsd_m);
    j.at("gsd_m").get_to(f.gsd_m);
    j.at("px_per_m").get_to(f.px_per_m);
    j.at("angle_rad").get_to(f.angle_rad);
    j.at("below_m").get_to(f.below_m);
    j.at("above_m").get_to(f.above_m);
    j.at("lattice_error_px").get_to(f.lattice_error_px);
    f.map = lattice(j.at("map"), 3);
    f.left = lattice(j.at("left"), 2);
    f.right = lattice(j.at("right"), 2);
    return f;
}

json written(const GroundLattice& ground)
{
    return {{"nodes", written(ground.nodes())},
            {"disparity_min_px", ground.disparity_min_px()},
            {"disparity_max_px", ground.disparity_max_px()},
            {"error_m", ground.error_m()}};
}

json written(const Pointing& p)
{
    return {{"correction", written(p.correction)},
            {"affine", p.affine},
            {"across", {p.across.x, p.across.y}},
            {"tie_points", p.points},
            {"inliers", p.inliers},
            {"shift_px", p.shift_px},
            {"rms_before_px", p.rms_before_px},
            {"rms_after_px", p.rms_after_px},
            {"warnings", p.warnings}};
}

Pointing pointing(const json& j)
{
    Pointing p;
    p.correction = correction(j.at("correction"));
    j.at("affine").get_to(p.affine);
    p.across = {j.at("across").at(0), j.at("across").at(1)};
    j.at("tie_points").get_to(p.points);
    j.at("inliers").get_to(p.inliers);
    j.at("shift_px").get_to(p.shift_px);
    j.at("rms_before_px").get_to(p.rms_before_px);
    j.at("rms_after_px").get_to(p.rms_after_px);
    j.at("warnings").get_to(p.warnings);
    return p;
}

PairGeometry read(const json& j)
{
    if (j.at("format") != kFormat || j.at("version") != kVersion) {
        throw GeometryError("the stored geometry is of another version of this program");
    }
    const json& ground = j.at("ground");
    PairGeometry pair{sensor(j.at("left")),
                      sensor(j.at("right")),
                      j.at("frame_map"),
                      j.at("output_map"),
                      surface(j.at("surface")),
                      frame(j.at("frame")),
                      GroundLattice(lattice(ground.at("nodes"), 16),
                                    ground.at("disparity_min_px"),
                                    ground.at("disparity_max_px"), ground.at("error_m")),
                      {j.at("disparity").at(0), j.at("disparity").at(1)},
                      {j.at("heights_m").at(0), j.at("heights_m").at(1)},
                      std::nullopt,
                      std::nullopt,
                      j.at("warnings").get<std::vector<std::string>>()};
    if (j.contains("pointing")) {
        pair.pointing = pointing(j.at("pointing"));
    }
    if (j.contains("likeness")) {
        const json& likeness = j.at("likeness");
        pair.likeness = Likeness{likeness.at("windows"), likeness.at("unlike")};
    }
    return pair;
}

} // namespace

std::string to_json(const PairGeometry& pair)
{
    json j{{"format", kFormat},
           {"version", kVersion},
           {"left", written(pair.left)},
           {"right", written(pair.right)},
           {"frame_map", pair.frame_map},
           {"output_map", pair.output_map},
           {"surface", written(pair.surface)},
           {"frame", written(pair.frame)},
           {"ground", written(pair.ground)},
           {"disparity", {pair.disparity.min, pair.disparity.max}},
           {"heights_m", {pair.heights.low_m, pair.heights.high_m}},
           {"warnings", pair.warnings}};
    if (pair.pointing) {
        j["pointing"] = written(*pair.pointing);
    }
    if (pair.likeness) {
        j["likeness"] = {{"windows", pair.likeness->windows},
                         {"unlike", pair.likeness->unlike}};
    }
    return j.dump(1) + "\n";
}

PairGeometry pair_geometry_from_json(const std::string& text)
{
    try {
        return read(json::parse(text));
    } catch (const json::exception& error) {
        throw GeometryError(
            fmt::format("the stored geometry cannot be read ({})", error.what()));
    }
}

} // namespace hsgm::geometry
