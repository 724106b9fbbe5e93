#pragma once

#include "pipeline/geometry/epipolar_frame.h"
#include "pipeline/geometry/ground_lattice.h"
#include "pipeline/geometry/overlap.h"
#include "pipeline/geometry/pointing.h"
#include "pipeline/geometry/reference_surface.h"
#include "pipeline/geometry/sensor_model.h"
#include "tiling/disparity_range.h"

#include <optional>
#include <string>
#include <vector>

namespace hsgm::geometry {

/// How alike the images are where samples of them were matched: what noise, haze and change
/// between the two dates leave of the texture.
struct Likeness {
    int windows = 0; ///< 7 x 7 pixels of the frame each, matched throughout
    int unlike = 0;  ///< of them, those that correlate by less than 0.8

    double unlike_share() const { return windows > 0 ? double(unlike) / windows : 0; }
};

/// All that is known of a pair before it is matched. Made once, stored, and then only read:
/// whoever has it agrees with all others to the last bit.
struct PairGeometry {
    SensorModel left;
    SensorModel right;      ///< with the correction that was found
    std::string frame_map;  ///< the map grid of the frame
    std::string output_map; ///< and that of ground points
    ReferenceSurface surface;
    EpipolarFrame frame;
    GroundLattice ground;
    tiling::DisparityRange disparity;
    HeightSpan heights; ///< that the disparities stand for, above the ellipsoid; over a
                        ///< surface with relief, from its lowest to its highest place
    std::optional<Pointing> pointing;
    std::optional<Likeness> likeness; ///< where it was measured
    std::vector<std::string> warnings;
};

/// The geometry as JSON; numbers come back to the last bit.
std::string to_json(const PairGeometry& pair);

/// Reads what `to_json` wrote. Throws GeometryError for text that is not, or no longer, of
/// that form.
PairGeometry pair_geometry_from_json(const std::string& text);

} // namespace hsgm::geometry
