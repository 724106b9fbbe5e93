#include "pipeline/stages/pixel_checksum.h"

#include "pipeline/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace hsgm::pipeline {

void PixelChecksum::add(tiling::ImageView<double> values)
{
    // Row by row: how many rows are read at a time depends on the blocks of the file.
    for (int row = 0; row < values.rows(); ++row) {
        const std::span<double> pixels(values.row(row),
                                       static_cast<std::size_t>(values.cols()));
        std::replace_if(
            pixels.begin(), pixels.end(), [](double value) { return std::isnan(value); },
            std::numeric_limits<double>::quiet_NaN()); // it has many bit patterns
        sum_.add_values(std::span<const double>(pixels));
    }
}

std::string checksum_of(PixelSource& source)
{
    PixelChecksum sum;
    tiling::Image<double> values;
    for (const tiling::Rect& window : source.reading_windows()) {
        check_stop();
        if (values.size() != window.size()) {
            values = tiling::Image<double>(window.size());
        }
        source.read(window, values);
        sum.add(values.view());
    }
    return sum.hex();
}

} // namespace hsgm::pipeline
