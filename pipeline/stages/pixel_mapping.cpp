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

void widen(Span& span, io::RasterSource& source)
{
    const int rows = strip_rows(source);
    tiling::Image<double> strip({rows, source.size().cols});
    for (int row = 0; row < source.size().rows; row += rows) {
        check_stop();
        const int count = std::min(rows, source.size().rows - row);
        source.read({row, 0, count, source.size().cols},
                    strip.view().part({0, 0, count, source.size().cols}));
        for (const double value :
             strip.pixels().first(std::size_t(count) * std::size_t(source.size().cols))) {
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

PixelMapping find_mapping(io::RasterSource& left, io::RasterSource& right)
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

int strip_rows(const io::RasterSource& source)
{
    constexpr std::int64_t kStripBytes = 16 << 20;
    const tiling::Size size = source.size();
    const std::int64_t row_bytes = std::int64_t{size.cols} * 8;
    const int fitting =
        static_cast<int>(std::clamp<std::int64_t>(kStripBytes / row_bytes, 1, size.rows));
    const int block = std::max(source.block_size().rows, 1);
    // Compressed blocks are decoded as a whole: a strip of less than one decodes it again
    // and again unless GDAL's cache holds a row of them.
    return block <= fitting ? fitting / block * block : fitting;
}

} // namespace hsgm::pipeline
