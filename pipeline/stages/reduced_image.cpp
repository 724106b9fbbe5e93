#include "pipeline/stages/reduced_image.h"

#include "pipeline/error.h"

#include <cmath>
#include <limits>

namespace hsgm::pipeline {

tiling::Image<double> reduced_image(PixelSource& source, int factor)
{
    const tiling::Size size{tiling::ceil_div(source.size().rows, factor),
                            tiling::ceil_div(source.size().cols, factor)};
    tiling::Image<double> sums(size);
    tiling::Image<int> counts(size);
    tiling::Image<double> pixels;
    for (const tiling::Rect& window : source.reading_windows()) {
        check_stop();
        if (pixels.size() != window.size()) {
            pixels = tiling::Image<double>(window.size());
        }
        source.read(window, pixels);
        for (int r = 0; r < window.rows; ++r) {
            for (int c = 0; c < window.cols; ++c) {
                if (!std::isnan(pixels(r, c))) {
                    sums((window.row + r) / factor, (window.col + c) / factor) += pixels(r, c);
                    ++counts((window.row + r) / factor, (window.col + c) / factor);
                }
            }
        }
    }
    for (int r = 0; r < size.rows; ++r) {
        for (int c = 0; c < size.cols; ++c) {
            const tiling::Rect cell =
                intersect({r * factor, c * factor, factor, factor}, rect_of(source.size()));
            sums(r, c) = 2 * counts(r, c) >= cell.area()
                             ? sums(r, c) / counts(r, c)
                             : std::numeric_limits<double>::quiet_NaN();
        }
    }
    return sums;
}

} // namespace hsgm::pipeline
