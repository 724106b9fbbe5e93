#pragma once

#include "io/raster_source.h"
#include "tiling/image.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace hsgm::pipeline {

/// Which rasters are compared, and how their pixels are to be read. Paths are what GDAL
/// opens; an empty one means that there is none.
struct DisparityInputs {
    std::string test;        ///< the disparity map in question
    std::string truth;       ///< may be empty for seams
    std::string truth_right; ///< its right view: only non-occluded pixels count, by cross-check
    std::string mask;        ///< of the left image's size
    std::optional<double> mask_value; ///< pixels of this mask value count; else all but 0
    std::string confidence;           ///< of the test's size, 0..255; may be empty
    double test_scale = 1;            ///< stored value / scale = disparity in pixels
    double truth_scale = 1;
    /// The stored value of the truths that means "unknown"; NaN: there is none. Without it,
    /// what the file declares, and 0 where it stores integers.
    std::optional<double> truth_nodata;
    bool zbuffer = false; ///< only non-occluded pixels count, by a z-buffer of the truth

    /// Throws io::ConfigError naming the option, its value and what is allowed.
    void validate() const;
};

/// One row of everything; what there is no raster of is empty.
struct DisparityRow {
    std::span<const float> test_px;
    std::span<const float> truth_px;
    std::span<const std::uint8_t> mask; ///< 0 where a pixel does not count
    std::span<const float> confidence;
};
using RowVisitor = std::function<void(const DisparityRow&)>;

/// Reads the rasters strip by strip and hands over every row, from top to bottom. Throws
/// io::ConfigError for contradictory inputs, io::InputError where a raster cannot be read or
/// has another size than the test.
void for_each_row(const DisparityInputs& inputs, const RowVisitor& visit);

} // namespace hsgm::pipeline
