#pragma once

#include "tiling/rect.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace hsgm::synth {

/// A synthetic stereo scene, as plain data. Everything is given in the coordinates of the
/// *left* image: x = column, y = row, integer at pixel centres. Surfaces are functions
/// disparity(x, y) in pixels, with disparity = x_left - x_right; what is nearer to the
/// sensor has the larger disparity and hides what is behind it.
///
///        x_left                 roof      d = 30
///     ---------->        ______________
///                        |            |           walls are never seen: they show
///      terrain   ________|            |________   as half-occluded strips
///                 d = 10                d = 10
///
/// Brightness is a fraction of the full scale, 0 black to 1 white.

/// Band-limited noise painted on a surface.
struct Texture {
    double mean = 0.45;     ///< brightness, 0..1
    double contrast = 0.06; ///< standard deviation of the brightness, 0..0.5
    double finest_px = 2.5; ///< spacing of the finest grain; below 2 the pixels alias
    int octaves = 4;        ///< grains of finest_px, 2 finest_px, 4 ..., equally strong
};

/// A sinusoid of disparity: hills.
struct Wave {
    double amplitude_px = 0;
    double wavelength_px = 512;
    double direction_deg = 0; ///< of the crests' normal: 0 along x, 90 along y
    double phase_deg = 0;
};

/// The ground: a plane through the image's corner pixel (0, 0), and waves on it.
struct Terrain {
    double offset_px = 0;
    double slope_x = 0; ///< px of disparity per column
    double slope_y = 0; ///< px of disparity per row
    std::vector<Wave> waves;
    Texture texture;
};

enum class Shape { rectangle, ellipse };

enum class Roof {
    flat,  ///< one disparity
    slope, ///< one plane, rising across the width
    gable, ///< two planes, rising to a ridge along the length
};

/// Something that stands on the ground: a footprint and a roof. Every roof is made of
/// planes, so that its right view has a closed form.
struct Object {
    Shape shape = Shape::rectangle;
    double center_x = 0;
    double center_y = 0;
    double length_px = 1;
    double width_px = 1;
    double angle_deg = 0; ///< of the length, from x towards y
    double height_px = 0; ///< disparity of the eaves above the ground at the centre, >= 0
    Roof roof = Roof::flat;
    double rise_px = 0; ///< from the eaves to the ridge, or to the high side
    Texture texture;
};

/// A town without end, made from a hash of grid cells: houses, blocks, towers, parks.
struct City {
    double cell_px = 96;            ///< side of a lot with its half of the streets, >= 32
    double street_px = 16;          ///< width of the streets between lots
    double fill = 0.8;              ///< share of the lots that are built on
    double slanted = 0.4;           ///< share of the built lots with sloped or gable roofs
    double rotated = 0.25;          ///< share of the built lots at an angle to the streets
    double plain = 0.1;             ///< share of the lots with hardly any texture
    double plain_contrast = 0.0015; ///< contrast there
    double height_min_px = 3;
    double height_max_px = 40; ///< of anything, roofs included
    Texture texture;           ///< of the roofs; the mean varies from roof to roof
};

/// Part of the ground and of all that stands on it where contrast is scaled down.
struct LowTexture {
    double x = 0; ///< first column
    double y = 0; ///< first row
    double cols = 0;
    double rows = 0;
    double contrast_scale = 0.02;
};

/// A disc without data in one image.
struct Hole {
    double center_x = 0;
    double center_y = 0;
    double radius_px = 0;
};

/// How one camera turns brightness into gray levels:
/// gray = full scale * (gain * brightness^gamma + offset) + noise, rounded.
/// Gray level 0 is kept for nodata.
struct Sensor {
    double gain = 1;
    double offset = 0; ///< fraction of the full scale
    double gamma = 1;
    double noise_gray = 0;    ///< standard deviation in gray levels
    int nodata_border_px = 0; ///< on all four sides
    std::vector<Hole> holes;
};

struct Scene {
    tiling::Size size{1024, 1024};
    std::uint64_t seed = 1;
    int bits = 8; ///< of a gray level, 8..16; satellites have 11 or 12
    Terrain terrain;
    std::vector<Object> objects;
    std::optional<City> city;
    std::vector<LowTexture> low_texture;
    Sensor left;
    Sensor right;

    int full_scale() const { return (1 << bits) - 1; }

    /// Throws std::invalid_argument naming the field, its value and what is allowed. Above
    /// all no surface may rise by half a pixel of disparity or more per column: beyond
    /// that the right view would fold.
    void validate() const;
};

} // namespace hsgm::synth
