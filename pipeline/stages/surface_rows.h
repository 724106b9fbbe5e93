#pragma once

#include "io/geo_reference.h"
#include "io/raster_source.h"
#include "pipeline/evaluate/coregistration.h"
#include "tiling/image.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// Which rasters of heights are compared, and which cells count. Mask and classes lie on the
/// reference's grid; an empty path means that there is none.
struct SurfaceInputs {
    std::string test;
    std::string reference;
    std::string mask;    ///< zeros do not count
    int mask_bits = 0;   ///< cells count where the mask has all of these bits; 0: any but 0
    std::string classes; ///< whole numbers 0..255, a class a cell
    std::vector<int> excluded_classes;

    /// Throws io::ConfigError naming the option, its value and what is allowed.
    void validate() const;
};

/// One row of the reference's grid.
struct SurfaceRow {
    int row = 0;
    std::span<const float> difference_m;   ///< test - reference; NaN where either is missing
    std::span<const float> slope_east;     ///< of the reference, m per m; NaN at holes and rims
    std::span<const float> slope_north;    ///< likewise
    std::span<const std::uint8_t> counts;  ///< 0: no reference, masked or excluded
    std::span<const std::uint8_t> classes; ///< empty where there are none
};
using SurfaceVisitor = std::function<void(const SurfaceRow&)>;

/// Reads two surface models side by side, as often as asked. The test is interpolated
/// linearly between its cell centres at those of the reference, or taken from the nearest
/// one where a neighbour is missing; both may have any cell size and origin, north up, and
/// must be in one reference system of a length unit. Memory is that of a strip of rows.
class SurfaceRows {
public:
    /// Throws io::ConfigError for contradictory inputs, io::InputError where a raster cannot
    /// be read, or where both do not fit together.
    explicit SurfaceRows(const SurfaceInputs& inputs);
    ~SurfaceRows();
    SurfaceRows(const SurfaceRows&) = delete;
    SurfaceRows& operator=(const SurfaceRows&) = delete;

    tiling::Size size() const; ///< of the reference
    io::GeoReference geo_reference() const;
    double cell_m() const; ///< the longer side of the reference's cells

    /// Hands over every row from top to bottom, with the test moved back by `shift`.
    void for_each(const evaluate::SurfaceShift& shift, const SurfaceVisitor& visit);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace hsgm::pipeline
