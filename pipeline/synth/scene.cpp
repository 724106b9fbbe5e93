#include "pipeline/synth/scene.h"

#include "pipeline/synth/terrain.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace hsgm::synth {

namespace {

void require(bool holds, const std::string& field, double value, const char* allowed)
{
    if (!holds || !std::isfinite(value)) {
        std::ostringstream message;
        message << field << " is " << value << "; allowed: " << allowed;
        throw std::invalid_argument(message.str());
    }
}

void require_within(const std::string& field, double value, double low, double high)
{
    std::ostringstream allowed;
    allowed << low << " to " << high;
    require(value >= low && value <= high, field, value, allowed.str().c_str());
}

void validate(const Texture& texture, const std::string& where)
{
    require_within(where + ".mean", texture.mean, 0, 1);
    require_within(where + ".contrast", texture.contrast, 0, 0.5);
    require_within(where + ".finest_px", texture.finest_px, 1, 1000);
    require_within(where + ".octaves", texture.octaves, 1, 16);
}

void validate(const Terrain& terrain)
{
    require_within("terrain.offset_px", terrain.offset_px, -1e5, 1e5);
    require_within("terrain.slope_y", terrain.slope_y, -10, 10);
    for (const Wave& wave : terrain.waves) {
        require_within("terrain.waves.amplitude_px", wave.amplitude_px, -1e4, 1e4);
        require_within("terrain.waves.wavelength_px", wave.wavelength_px, 4, 1e7);
        require_within("terrain.waves.direction_deg", wave.direction_deg, -360, 360);
        require_within("terrain.waves.phase_deg", wave.phase_deg, -360, 360);
    }
    const double steepest = TerrainSurface(terrain).steepest_slope_x();
    require(steepest < 0.5, "the steepest slope of the terrain along x", steepest,
            "below 0.5 px of disparity per column");
    validate(terrain.texture, "terrain.texture");
}

void validate(const Object& object, const std::string& where)
{
    require_within(where + ".center_x", object.center_x, -1e6, 1e6);
    require_within(where + ".center_y", object.center_y, -1e6, 1e6);
    require_within(where + ".length_px", object.length_px, 0.1, 1e6);
    require_within(where + ".width_px", object.width_px, 0.1, 1e6);
    require_within(where + ".angle_deg", object.angle_deg, -360, 360);
    require_within(where + ".height_px", object.height_px, 0, 1e4);
    require_within(where + ".rise_px", object.rise_px, 0, 1e4);
    const double run_px = object.roof == Roof::gable ? object.width_px / 2 : object.width_px;
    const double steepness = object.roof == Roof::flat ? 0 : object.rise_px / run_px;
    require(steepness < 0.5, where + ": the steepness of the roof, rise_px over its run,",
            steepness, "below 0.5");
    validate(object.texture, where + ".texture");
}

void validate(const City& city)
{
    require_within("city.cell_px", city.cell_px, 32, 4096);
    require_within("city.street_px", city.street_px, 0, city.cell_px / 2);
    require_within("city.fill", city.fill, 0, 1);
    require_within("city.slanted", city.slanted, 0, 1);
    require_within("city.rotated", city.rotated, 0, 1);
    require_within("city.plain", city.plain, 0, 1);
    require_within("city.plain_contrast", city.plain_contrast, 0, 0.5);
    require_within("city.height_min_px", city.height_min_px, 0, city.height_max_px);
    require_within("city.height_max_px", city.height_max_px, 0, 1e4);
    validate(city.texture, "city.texture");
}

void validate(const LowTexture& area)
{
    require_within("low_texture.rows", area.rows, 0, 1e6);
    require_within("low_texture.cols", area.cols, 0, 1e6);
    require_within("low_texture.contrast_scale", area.contrast_scale, 0, 10);
}

void validate(const Sensor& sensor, const std::string& where)
{
    require_within(where + ".gain", sensor.gain, 0.01, 100);
    require_within(where + ".offset", sensor.offset, -1, 1);
    require_within(where + ".gamma", sensor.gamma, 0.1, 10);
    require_within(where + ".noise_gray", sensor.noise_gray, 0, 1e4);
    require_within(where + ".nodata_border_px", sensor.nodata_border_px, 0, 1e6);
    for (const Hole& hole : sensor.holes) {
        require_within(where + ".holes.radius_px", hole.radius_px, 0, 1e6);
    }
}

} // namespace

void Scene::validate() const
{
    require_within("size: rows", size.rows, 1, 1e6);
    require_within("size: cols", size.cols, 1, 1e6);
    require_within("bits", bits, 8, 16);
    synth::validate(terrain);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        synth::validate(objects[i], "objects[" + std::to_string(i) + "]");
    }
    if (city) {
        synth::validate(*city);
    }
    for (const LowTexture& area : low_texture) {
        synth::validate(area);
    }
    synth::validate(left, "left");
    synth::validate(right, "right");
}

} // namespace hsgm::synth
