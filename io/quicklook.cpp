#include "io/quicklook.h"

#include "io/colour_map.h"
#include "io/error.h"
#include "io/gdal_private.h"
#include "io/png.h"
#include "io/raster_channels_private.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace hsgm::io {

namespace {

using tiling::Image;
using tiling::Size;

Size reduced(Size size, int max_side_px)
{
    const int longest = std::max(size.rows, size.cols);
    if (longest <= max_side_px) {
        return size;
    }
    const auto side = [&](int px) {
        return std::max(1, static_cast<int>(std::int64_t{px} * max_side_px / longest));
    };
    return {side(size.rows), side(size.cols)};
}

template <typename T>
Image<T> read_reduced(GDALRasterBandH band, Size from, Size to, GDALDataType type,
                      const std::string& path)
{
    Image<T> image(to);
    GDALRasterIOExtraArg extra;
    INIT_RASTERIO_EXTRA_ARG(extra);
    extra.eResampleAlg = GRIORA_Average;
    ErrorCollector errors;
    if (GDALRasterIOEx(band, GF_Read, 0, 0, from.cols, from.rows, image.data(), to.cols,
                       to.rows, type, 0, 0, &extra) != CE_None) {
        throw InputError("Cannot read " + path + "; " + errors.quote() + ".");
    }
    return image;
}

/// The values, NaN where no pixel under them is valid.
Image<float> read_values(const std::string& path, int max_side_px)
{
    const Dataset dataset = open_raster(path);
    GDALRasterBandH band = GDALGetRasterBand(dataset.get(), 1);
    const Size from = size_of(dataset.get());
    const Size to = reduced(from, max_side_px);
    Image<float> values = read_reduced<float>(band, from, to, GDT_Float32, path);
    const Image<float> mask =
        read_reduced<float>(GDALGetMaskBand(band), from, to, GDT_Float32, path);
    for (int r = 0; r < to.rows; ++r) {
        for (int c = 0; c < to.cols; ++c) {
            if (mask(r, c) <= 0) {
                values(r, c) = NAN;
            }
        }
    }
    return values;
}

/// The values below which `low` and `high` percent of the valid ones lie; never equal.
std::pair<float, float> stretch(const Image<float>& values, double low, double high)
{
    std::vector<float> sorted;
    std::copy_if(values.pixels().begin(), values.pixels().end(), std::back_inserter(sorted),
                 [](float value) { return std::isfinite(value); });
    if (sorted.empty()) {
        return {0.0F, 1.0F};
    }
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double percent) {
        const double last = static_cast<double>(sorted.size() - 1);
        return sorted[static_cast<std::size_t>(std::lround(percent / 100 * last))];
    };
    return {at(low), std::max(at(high), std::nextafter(at(low), INFINITY))};
}

template <typename Pixel, typename Paint>
Image<Pixel> paint(const Image<float>& values, Paint paint_value)
{
    Image<Pixel> picture(values.size(), Pixel{});
    for (int r = 0; r < values.rows(); ++r) {
        for (int c = 0; c < values.cols(); ++c) {
            if (std::isfinite(values(r, c))) {
                picture(r, c) = paint_value(values(r, c));
            }
        }
    }
    return picture;
}

std::uint8_t to_byte(double value)
{
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

} // namespace

void QuicklookOptions::validate() const
{
    if (max_side_px < 1) {
        throw ConfigError("A quick look's max_side_px is " + std::to_string(max_side_px) +
                          "; it must be at least 1.");
    }
    if (!(low_percentile >= 0 && low_percentile < high_percentile && high_percentile <= 100)) {
        throw ConfigError("A quick look's percentiles are " + std::to_string(low_percentile) +
                          " and " + std::to_string(high_percentile) +
                          "; they must rise and lie between 0 and 100.");
    }
}

void write_quicklook_png(const std::string& raster_path, const std::string& png_path,
                         const QuicklookOptions& options)
{
    options.validate();
    const Image<float> values = read_values(raster_path, options.max_side_px);
    if (options.style == QuicklookStyle::hillshade) {
        const auto picture = paint<std::uint8_t>(values, [](float v) { return to_byte(v); });
        write_png(png_path, picture.view());
        return;
    }
    const auto [low, high] = stretch(values, options.low_percentile, options.high_percentile);
    const auto position = [low = double{low}, high = double{high}](float value) {
        return (value - low) / (high - low);
    };
    if (options.style == QuicklookStyle::disparity) {
        const auto picture = paint<Rgb>(values, [&](float v) { return turbo(position(v)); });
        write_png(png_path, picture.view());
    } else {
        const auto picture =
            paint<std::uint8_t>(values, [&](float v) { return to_byte(255 * position(v)); });
        write_png(png_path, picture.view());
    }
}

} // namespace hsgm::io
