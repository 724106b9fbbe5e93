#pragma once

#include "pipeline/batch/manifest.h"

#include <filesystem>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// An image of an archive that is in no pair.
struct LeftOutImage {
    std::string image; ///< its path
    std::string why;   ///< "overlaps no other image", ...
};

/// The pairs of a folder of orthoimages.
struct OrthoArchive {
    std::vector<BatchPair> pairs; ///< named LEFT-RIGHT, by the images' names
    std::vector<LeftOutImage> left_out;
};

/// Pairs the orthoimages of a folder (every raster in it that lies on a map, in the order of
/// their names) by where they lie and how they were taken: each image with the one that serves
/// it best, by the shared area (at least 20 % of the smaller image) and the base-to-height
/// ratio (0.05 to 1.2; 0.15 to 0.6 serves best). How an image was taken is told by the row of
/// `views.csv` in the folder that names it (columns image, and azimuth_deg and incidence_deg,
/// or rpc), or else by itself as for geometry kind ortho. `plane_m` is about the height of the
/// ground above the ellipsoid.
///
/// Whatever cannot be paired is left out with its reason. Throws ConfigError for a views.csv
/// that cannot be understood, or names an image that is not there.
OrthoArchive pair_orthos(const std::filesystem::path& folder, double plane_m);

/// What is left out, as CSV with a first row: image, why.
std::string text_of(const std::vector<LeftOutImage>& left_out);

} // namespace hsgm::pipeline
