#include "io/raster_channels_private.h"

#include "io/error.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace hsgm::io {

namespace {

/// True where the first three bands are red, green and blue of one type, 8 or 16 bits.
bool has_colour(GDALDatasetH dataset)
{
    if (GDALGetRasterCount(dataset) < 3) {
        return false;
    }
    constexpr GDALColorInterp kColours[] = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand};
    const GDALDataType type = GDALGetRasterDataType(GDALGetRasterBand(dataset, 1));
    for (int i = 0; i < 3; ++i) {
        GDALRasterBandH band = GDALGetRasterBand(dataset, i + 1);
        if (GDALGetRasterColorInterpretation(band) != kColours[i] ||
            GDALGetRasterDataType(band) != type) {
            return false;
        }
    }
    return type == GDT_Byte || type == GDT_UInt16;
}

/// A float32 file may declare its sentinel with more digits than a float has, so the
/// comparison happens in the precision of the file.
double in_precision_of(GDALDataType type, double nodata)
{
    if (type != GDT_Float32 || !std::isfinite(nodata)) {
        return nodata;
    }
    constexpr double kLargest = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(nodata, -kLargest, kLargest));
}

Channel channel_of(GDALDatasetH dataset, int band, const std::optional<double>& given)
{
    Channel channel;
    channel.band = GDALGetRasterBand(dataset, band);
    int declared = FALSE;
    const double nodata = GDALGetRasterNoDataValue(channel.band, &declared);
    if (given.has_value() || declared != FALSE) {
        channel.nodata =
            in_precision_of(GDALGetRasterDataType(channel.band), given.value_or(nodata));
    }
    return channel;
}

} // namespace

std::vector<Channel> choose_channels(GDALDatasetH dataset, const ImageSpec& spec)
{
    const int count = GDALGetRasterCount(dataset);
    if (spec.band < 0 || spec.band > count) {
        throw InputError(spec.path + " has " + std::to_string(count) +
                         (count == 1 ? " band" : " bands") + ", so there is no band " +
                         std::to_string(spec.band) + "; bands count from 1.");
    }
    const bool colour = spec.band == 0 && has_colour(dataset);
    const int first = std::max(spec.band, 1);
    std::vector<Channel> channels;
    for (int band = first; band < first + (colour ? 3 : 1); ++band) {
        channels.push_back(channel_of(dataset, band, spec.nodata));
    }
    const GDALDataType type = GDALGetRasterDataType(channels.front().band);
    if (!pixel_type(type).has_value()) {
        throw InputError(spec.path + ", band " + std::to_string(first) + ", stores " +
                         GDALGetDataTypeName(type) + " pixels; whole numbers of 8 to 32 bits " +
                         "and real numbers of 32 or 64 bits can be read.");
    }
    return channels;
}

std::vector<GDALRasterBandH>
find_masks(GDALDatasetH dataset, const std::vector<Channel>& channels, const ImageSpec& spec)
{
    // GDAL offers one mask per band and hides the alpha band behind a nodata value, so alpha
    // and nodata are looked at here, and GDAL's mask only where it is something else.
    std::vector<GDALRasterBandH> masks;
    for (const Channel& channel : channels) {
        const int flags = GDALGetMaskFlags(channel.band);
        const bool own_mask = (flags & (GMF_ALL_VALID | GMF_ALPHA)) == 0 && flags != GMF_NODATA;
        // Combined nodata values of several bands (NODATA_VALUES) give way to a given one.
        const bool overruled = (flags & GMF_NODATA) != 0 && spec.nodata.has_value();
        if (own_mask && !overruled) {
            masks.push_back(GDALGetMaskBand(channel.band));
        }
        if ((flags & GMF_PER_DATASET) != 0) {
            break; // the same one for every band
        }
    }
    for (int number = 1; number <= GDALGetRasterCount(dataset); ++number) {
        GDALRasterBandH band = GDALGetRasterBand(dataset, number);
        if (GDALGetRasterColorInterpretation(band) == GCI_AlphaBand &&
            band != channels.front().band) {
            masks.push_back(band);
        }
    }
    return masks;
}

double luminance(double red, double green, double blue)
{
    const auto sum = static_cast<std::int64_t>(red) * 4899 +
                     static_cast<std::int64_t>(green) * 9617 +
                     static_cast<std::int64_t>(blue) * 1868;
    return static_cast<double>((sum + 8192) >> 14);
}

tiling::Size size_of(GDALDatasetH dataset)
{
    return {GDALGetRasterYSize(dataset), GDALGetRasterXSize(dataset)};
}

std::string to_text(tiling::Size size)
{
    return std::to_string(size.rows) + " rows x " + std::to_string(size.cols) + " columns";
}

std::string to_text(const tiling::Rect& window)
{
    return "rows " + std::to_string(window.row) + "-" + std::to_string(window.row_end() - 1) +
           ", columns " + std::to_string(window.col) + "-" +
           std::to_string(window.col_end() - 1);
}

} // namespace hsgm::io
