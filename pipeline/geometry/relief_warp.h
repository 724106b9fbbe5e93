#pragma once

#include "pipeline/geometry/elevation_grid.h"
#include "pipeline/geometry/lattice.h"
#include "pipeline/geometry/ortho_model.h"

#include <memory>

namespace hsgm::geometry {

/// Goes from the levelled image (see OrthoModel) back to the orthoimage whose pixels are read,
/// where that was made on a DEM. Immutable; threads may share one.
class ReliefWarp {
public:
    /// `dem` is the one that the image was made on.
    ReliefWarp(const OrthoModel& model, std::shared_ptr<const ElevationGrid> dem);

    /// The pixel of the orthoimage that the levelled one shows at `levelled`; not finite where
    /// the DEM has no height, or is so steep that the ray grazes it.
    ImagePoint source_of(ImagePoint levelled) const;

private:
    std::shared_ptr<const ElevationGrid> dem_;
    double level_m_ = 0;
    double margin_px_ = 0;
    double right_ = 0; // of the orthoimage
    double bottom_ = 0;
    Lattice at_; // of pixels: col and row of the DEM's posts, then b in pixels
};

} // namespace hsgm::geometry
