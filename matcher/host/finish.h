#pragma once

#include <cstdint>

namespace hsgm::matcher::host {

/// Finished pixels of a row. Arrays need not be longer than `cols`.
struct FinishedRow {
    const std::int32_t* disparity_q8; ///< kHole where there is no value
    const std::uint16_t* reasons;
    const std::uint8_t* measured; ///< confidence of values that were measured
    int cols;
};

/// Disparities in px (`nodata` for holes) and confidences (0 for holes, `interpolated` for
/// values that were not measured).
void finish_row(const FinishedRow& row, float nodata, std::uint8_t interpolated,
                float* disparity_px, std::uint8_t* confidence);

} // namespace hsgm::matcher::host
