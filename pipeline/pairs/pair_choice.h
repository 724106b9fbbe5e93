#pragma once

#include "io/image_spec.h"

#include <optional>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// An image of a set, by its name.
struct NamedImage {
    std::string name;
    io::ImageSpec image;
};

/// What the geometry says of two images of a set.
struct PairChoice {
    std::string left; ///< of the two, the one that looks down more steeply
    std::string right;
    double base_to_height = 0; ///< 0 where it could not be found
    double overlap = 0;        ///< share of the smaller footprint that both show
    std::string refusal;       ///< why they make no pair; empty: they do

    std::string name() const { return left + "-" + right; }
};

/// All pairs of a set of raw images: base-to-height ratio and overlap by their models, at the
/// height at which they share most. A pair is taken with a ratio of 0.1 to 1 (below, heights
/// are too noisy; above, the images look too different) and an overlap of 30 % and more. In
/// the order of names, whatever that of the images. Opens images, reads no pixel.
std::vector<PairChoice> choose_pairs(std::vector<NamedImage> images);

/// What a run of one pair chooses for its DSM where nothing is said.
struct PairGround {
    std::string crs; ///< the UTM zone, or polar stereographic
    double cell_m = 0;
};

/// Nothing where the two make no pair, of which its run says why.
std::optional<PairGround> ground_of(const io::ImageSpec& left, const io::ImageSpec& right);

} // namespace hsgm::pipeline
