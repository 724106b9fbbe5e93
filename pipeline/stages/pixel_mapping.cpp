#include "pipeline/stages/pixel_mapping.h"

#include "pipeline/error.h"
#include "tiling/image.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace hsgm::pipeline {

namespace {

constexpr double kHighestPixel = 65534;

struct Span {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();
};

void widen(Span& span, PixelSource& source)
{
    tiling::Image<double> pixels;
    for (const tiling::Rect& window : source.reading_windows()) {
        check_stop();
        if (pixels.size() != window.size()) {
            pixels = tiling::Image<double>(window.size());
        }
        source.read(window, pixels);
        for (const double value : pixels.pixels()) {
            if (!std::isnan(value)) {
                span.least = std::min(span.least, value);
                span.most = std::max(span.most, value);
            }
        }
    }
}

bool keeps_values(io::PixelType type)
{
    return type == io::PixelType::uint8 || type == io::PixelType::uint16;
}

} // namespace

PixelMapping find_mapping(PixelSource& left, PixelSource& right)
{
    if (keeps_values(left.pixel_type()) && keeps_values(right.pixel_type())) {
        return {};
    }
    Span span;
    widen(span, left);
    widen(span, right);
    if (!(span.most > span.least)) {
        return {span.most == span.least ? span.least : 0, 1};
    }
    const bool whole =
        !io::is_floating(left.pixel_type()) && !io::is_floating(right.pixel_type());
    const double width = span.most - span.least;
    return {span.least, whole && width <= kHighestPixel ? 1.0 : kHighestPixel / width};
}

matcher::Tone find_tone(io::PixelType type, const PixelHistogram& histogram)
{
    if (type == io::PixelType::uint8) {
        return {0, 255};
    }
    const std::uint64_t n =
        std::accumulate(histogram.begin(), histogram.end(), std::uint64_t{0});
    std::uint64_t below = 0;
    int lo = -1;
    int hi = 0;
    for (int value = 0; value < 65536; ++value) {
        below += histogram[std::size_t(value)];
        if (lo < 0 && 1000 * below > n) {
            lo = value;
        }
        if (1000 * below >= 999 * n) {
            hi = value;
            break;
        }
    }
    lo = std::max(lo, 0);
    return {lo, hi > lo ? hi : lo + 1};
}

} // namespace hsgm::pipeline
