#include "pipeline/stages/scene_config.h"

#include "io/config.h"
#include "io/error.h"

#include <cmath>
#include <stdexcept>

namespace hsgm::pipeline {

namespace {

using io::ConfigSection;

// Each reader keeps what the struct holds where the key is missing. Ranges are the scene's
// own business: Scene::validate() knows them.

void read(ConfigSection section, synth::Texture& t)
{
    t.mean = section.number("mean", t.mean);
    t.contrast = section.number("contrast", t.contrast);
    t.finest_px = section.number("finest_px", t.finest_px);
    t.octaves = section.integer("octaves", t.octaves);
}

void read(ConfigSection section, synth::Wave& w)
{
    w.amplitude_px = section.required_number("amplitude_px");
    w.wavelength_px = section.number("wavelength_px", w.wavelength_px);
    w.direction_deg = section.number("direction_deg", w.direction_deg);
    w.phase_deg = section.number("phase_deg", w.phase_deg);
}

void read(ConfigSection section, synth::LowTexture& area)
{
    area.x = section.required_number("x");
    area.y = section.required_number("y");
    area.cols = section.required_number("cols");
    area.rows = section.required_number("rows");
    area.contrast_scale = section.number("contrast_scale", area.contrast_scale);
}

void read(ConfigSection section, synth::Hole& hole)
{
    hole.center_x = section.required_number("center_x");
    hole.center_y = section.required_number("center_y");
    hole.radius_px = section.required_number("radius_px");
}

synth::Shape read_shape(ConfigSection& section)
{
    return section.choice("shape", "rectangle", {"rectangle", "ellipse"}) == "ellipse"
               ? synth::Shape::ellipse
               : synth::Shape::rectangle;
}

synth::Roof read_roof(ConfigSection& section)
{
    const std::string roof = section.choice("roof", "flat", {"flat", "slope", "gable"});
    return roof == "flat" ? synth::Roof::flat
                          : (roof == "slope" ? synth::Roof::slope : synth::Roof::gable);
}

void read(ConfigSection section, synth::Object& o)
{
    o.shape = read_shape(section);
    o.center_x = section.required_number("center_x");
    o.center_y = section.required_number("center_y");
    o.length_px = section.required_number("length_px");
    o.width_px = section.required_number("width_px");
    o.angle_deg = section.number("angle_deg", o.angle_deg);
    o.height_px = section.required_number("height_px");
    o.roof = read_roof(section);
    o.rise_px = section.number("rise_px", o.rise_px);
    read(section.section("texture"), o.texture);
}

template <typename Struct>
void read_list(ConfigSection& section, const char* key, std::vector<Struct>& entries)
{
    for (ConfigSection& entry : section.sections(key)) {
        read(entry, entries.emplace_back());
    }
}

void read(ConfigSection section, synth::Terrain& t)
{
    t.offset_px = section.number("offset_px", t.offset_px);
    t.slope_x = section.number("slope_x", t.slope_x);
    t.slope_y = section.number("slope_y", t.slope_y);
    read_list(section, "waves", t.waves);
    read(section.section("texture"), t.texture);
}

void read(ConfigSection section, synth::City& c)
{
    c.cell_px = section.number("cell_px", c.cell_px);
    c.street_px = section.number("street_px", c.street_px);
    c.fill = section.number("fill", c.fill);
    c.slanted = section.number("slanted", c.slanted);
    c.rotated = section.number("rotated", c.rotated);
    c.plain = section.number("plain", c.plain);
    c.plain_contrast = section.number("plain_contrast", c.plain_contrast);
    c.height_min_px = section.number("height_min_px", c.height_min_px);
    c.height_max_px = section.number("height_max_px", c.height_max_px);
    read(section.section("texture"), c.texture);
}

void read(ConfigSection section, synth::Sensor& s)
{
    s.gain = section.number("gain", s.gain);
    s.offset = section.number("offset", s.offset);
    s.gamma = section.number("gamma", s.gamma);
    s.noise_gray = section.number("noise_gray", s.noise_gray);
    s.nodata_border_px = section.integer("nodata_border_px", s.nodata_border_px);
    read_list(section, "holes", s.holes);
}

void read(ConfigSection section, OrbitView& view)
{
    view.toward_east = section.number("toward_east", view.toward_east);
    view.toward_north = section.number("toward_north", view.toward_north);
    view.turn_deg = section.number("turn_deg", view.turn_deg);
    view.written_col_px = section.number("written_col_px", view.written_col_px);
    view.written_row_px = section.number("written_row_px", view.written_row_px);
}

void read(ConfigSection section, SceneOrtho& ortho)
{
    ortho.plane_m = section.optional_number("plane_m");
    ortho.dem_post_cells = section.integer("dem_post_cells", ortho.dem_post_cells);
    ortho.dem_error_m = section.number("dem_error_m", ortho.dem_error_m);
}

void read(ConfigSection section, SceneCameras& c)
{
    c.crs = section.text("crs", c.crs);
    c.west = section.number("west", c.west);
    c.north = section.number("north", c.north);
    c.cell_m = section.number("cell_m", c.cell_m);
    c.base_m = section.number("base_m", c.base_m);
    c.pixel_m = section.number("pixel_m", c.pixel_m);
    read(section.section("left"), c.left);
    read(section.section("right"), c.right);
    if (section.has("ortho")) {
        read(section.section("ortho"), c.ortho.emplace());
    }
}

tiling::Size read_size(ConfigSection& section, tiling::Size size)
{
    const std::vector<double> given = section.numbers("size", 2);
    if (given.empty()) {
        return size;
    }
    const auto whole = [&](double v) {
        if (v != std::floor(v) || v < 1 || v > 1e6) {
            section.fail("size", "must be [rows, columns], whole numbers from 1 to 1000000.");
        }
        return static_cast<int>(v);
    };
    return {whole(given[0]), whole(given[1])};
}

void read(ConfigSection root, synth::Scene& scene)
{
    scene.size = read_size(root, scene.size);
    scene.seed = static_cast<std::uint64_t>(root.integer("seed", 1, 0));
    scene.bits = root.integer("bits", scene.bits);
    read(root.section("terrain"), scene.terrain);
    read_list(root, "objects", scene.objects);
    if (root.has("city")) {
        read(root.section("city"), scene.city.emplace());
    }
    read_list(root, "low_texture", scene.low_texture);
    read(root.section("left"), scene.left);
    read(root.section("right"), scene.right);
}

} // namespace

SceneConfig read_scene(const std::string& path, const std::vector<std::string>& overrides)
{
    io::ConfigDocument document = io::ConfigDocument::load(path);
    for (const std::string& assignment : overrides) {
        document.set(assignment);
    }
    SceneConfig config;
    io::ConfigSection root = document.root();
    read(root, config.scene);
    if (root.has("cameras")) {
        read(root.section("cameras"), config.cameras.emplace());
    }
    document.refuse_unknown();
    try {
        config.scene.validate();
        if (config.cameras) {
            config.cameras->validate();
        }
    } catch (const std::invalid_argument& refused) {
        throw io::ConfigError(path + ": " + refused.what());
    }
    config.used_yaml = document.effective_yaml();
    return config;
}

} // namespace hsgm::pipeline
