#include "io/raster_source.h"

#include "io/error.h"
#include "io/gdal_private.h"
#include "io/raster_channels_private.h"
#include "io/vector_mask_private.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace hsgm::io {

using tiling::ImageView;
using tiling::Rect;
using tiling::Size;

namespace {

/// Windows are read in strips of about this many rows, so that colour bands and masks need
/// little memory of their own however large the window is.
constexpr int kStripRows = 256;

} // namespace

struct RasterSource::State {
    ImageSpec spec;
    Dataset dataset;
    Dataset mask_file;
    std::optional<VectorMask> mask_areas;
    std::vector<Channel> channels;      // one, or red, green and blue
    std::vector<GDALRasterBandH> masks; // a zero in any of them: no value
    std::vector<double> buffer;         // of one strip, kept between reads
    bool suspect = false;               // a read failed, so GDAL's caches may hold anything

    void open();
    void open_mask_file();
    void read_band(GDALRasterBandH band, const std::string& path, const Rect& window,
                   ImageView<double> values) const;
    void read_strip(const Rect& strip, ImageView<double> values);
    void read_luminance(const Rect& strip, ImageView<double> values);
    void apply_masks(const Rect& strip, ImageView<double> values);
    ImageView<double> buffer_view(Size size, int index, int count);
};

void RasterSource::State::open()
{
    dataset = open_raster(spec.path);
    ErrorCollector errors; // some drivers grumble about masks and metadata; that is no news
    channels = choose_channels(dataset.get(), spec);
    masks = find_masks(dataset.get(), channels, spec);
    open_mask_file();
}

void RasterSource::State::open_mask_file()
{
    if (spec.mask.empty()) {
        return;
    }
    if (is_vector(spec.mask)) {
        mask_areas.emplace(spec, dataset.get());
        return;
    }
    mask_file = open_raster(spec.mask);
    if (size_of(mask_file.get()) != size_of(dataset.get())) {
        throw InputError("The mask " + spec.mask + " has " + to_text(size_of(mask_file.get())) +
                         ", but its image " + spec.path + " has " +
                         to_text(size_of(dataset.get())) + "; they must agree.");
    }
}

ImageView<double> RasterSource::State::buffer_view(Size size, int index, int count)
{
    const auto area = static_cast<std::size_t>(size.area());
    buffer.resize(std::max(buffer.size(), area * static_cast<std::size_t>(count)));
    return {buffer.data() + area * static_cast<std::size_t>(index), size, size.cols};
}

void RasterSource::State::read_band(GDALRasterBandH band, const std::string& path,
                                    const Rect& window, ImageView<double> values) const
{
    ErrorCollector errors;
    const CPLErr result = GDALRasterIOEx(
        band, GF_Read, window.col, window.row, window.cols, window.rows, values.data(),
        window.cols, window.rows, GDT_Float64, sizeof(double),
        static_cast<GSpacing>(values.stride()) * static_cast<GSpacing>(sizeof(double)),
        nullptr);
    // GDAL sometimes reports an error, fills a block with zeros and yet calls it a success: a
    // TIFF whose table of block lengths could not be read looks like one with empty blocks.
    if (result != CE_None || errors.failed()) {
        throw InputError("Cannot read " + to_text(window) + " of " + path + "; " +
                         errors.quote() + ".");
    }
}

void RasterSource::State::read_luminance(const Rect& strip, ImageView<double> red)
{
    buffer_view(strip.size(), 1, 2); // both views must outlive any growth of the buffer
    const ImageView<double> green = buffer_view(strip.size(), 0, 2);
    const ImageView<double> blue = buffer_view(strip.size(), 1, 2);
    read_band(channels[0].band, spec.path, strip, red);
    read_band(channels[1].band, spec.path, strip, green);
    read_band(channels[2].band, spec.path, strip, blue);
    for (int r = 0; r < strip.rows; ++r) {
        for (int c = 0; c < strip.cols; ++c) {
            const bool absent = red(r, c) == channels[0].nodata &&
                                green(r, c) == channels[1].nodata &&
                                blue(r, c) == channels[2].nodata;
            red(r, c) = absent ? std::numeric_limits<double>::quiet_NaN()
                               : luminance(red(r, c), green(r, c), blue(r, c));
        }
    }
}

void RasterSource::State::apply_masks(const Rect& strip, ImageView<double> values)
{
    const auto apply = [&](const auto& read_mask) {
        const ImageView<double> mask = buffer_view(strip.size(), 0, 1);
        read_mask(mask);
        for (int r = 0; r < strip.rows; ++r) {
            for (int c = 0; c < strip.cols; ++c) {
                if (mask(r, c) == 0) {
                    values(r, c) = std::numeric_limits<double>::quiet_NaN();
                }
            }
        }
    };
    const auto apply_band = [&](GDALRasterBandH band, const std::string& path) {
        apply([&](ImageView<double> mask) { read_band(band, path, strip, mask); });
    };
    for (GDALRasterBandH band : masks) {
        apply_band(band, spec.path);
    }
    if (mask_file != nullptr) {
        apply_band(GDALGetRasterBand(mask_file.get(), 1), spec.mask);
    }
    if (mask_areas) {
        apply([&](ImageView<double> mask) { mask_areas->read(strip, mask); });
    }
}

void RasterSource::State::read_strip(const Rect& strip, ImageView<double> values)
{
    if (channels.size() == 3) {
        read_luminance(strip, values);
    } else {
        read_band(channels.front().band, spec.path, strip, values);
        const double nodata = channels.front().nodata;
        for (int r = 0; r < strip.rows; ++r) {
            for (double& value : values.row_span(r)) {
                if (value == nodata || !std::isfinite(value)) {
                    value = std::numeric_limits<double>::quiet_NaN();
                }
            }
        }
    }
    apply_masks(strip, values);
}

RasterSource::RasterSource(ImageSpec spec) : state_(std::make_unique<State>())
{
    state_->spec = std::move(spec);
    state_->open();
}

RasterSource::~RasterSource() = default;
RasterSource::RasterSource(RasterSource&&) noexcept = default;
RasterSource& RasterSource::operator=(RasterSource&&) noexcept = default;

Size RasterSource::size() const
{
    return size_of(state_->dataset.get());
}

PixelType RasterSource::pixel_type() const
{
    return *io::pixel_type(GDALGetRasterDataType(state_->channels.front().band));
}

int RasterSource::bands() const
{
    return GDALGetRasterCount(state_->dataset.get());
}

Size RasterSource::block_size() const
{
    Size size;
    GDALGetBlockSize(state_->channels.front().band, &size.cols, &size.rows);
    return size;
}

const std::string& RasterSource::path() const
{
    return state_->spec.path;
}

std::string RasterSource::description() const
{
    if (state_->channels.size() == 3) {
        return state_->spec.path + ", luminance of bands 1-3";
    }
    return state_->spec.path + ", band " + std::to_string(std::max(state_->spec.band, 1));
}

GeoReference geo_reference_of(GDALDatasetH dataset)
{
    ErrorCollector errors;
    GeoReference geo;
    std::array<double, 6> transform{};
    if (GDALGetGeoTransform(dataset, transform.data()) == CE_None) {
        geo.transform = transform;
    }
    if (OGRSpatialReferenceH crs = GDALGetSpatialRef(dataset)) {
        const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
        char* wkt = nullptr;
        if (OSRExportToWktEx(crs, &wkt, options) == OGRERR_NONE) {
            geo.wkt = wkt;
        }
        CPLFree(wkt);
    }
    return geo;
}

GeoReference RasterSource::geo_reference() const
{
    return geo_reference_of(state_->dataset.get());
}

std::vector<std::string> RasterSource::files() const
{
    ErrorCollector errors;
    std::vector<std::string> paths;
    for (const Dataset* dataset : {&state_->dataset, &state_->mask_file}) {
        if (*dataset == nullptr) {
            continue;
        }
        char** list = GDALGetFileList(dataset->get());
        for (int i = 0; i < CSLCount(list); ++i) {
            paths.emplace_back(list[i]);
        }
        CSLDestroy(list);
    }
    if (state_->mask_areas) {
        const auto& files = state_->mask_areas->files();
        paths.insert(paths.end(), files.begin(), files.end());
    }
    return paths;
}

std::map<std::string, std::string> RasterSource::metadata(const std::string& domain) const
{
    ErrorCollector errors;
    std::map<std::string, std::string> items;
    char** list = GDALGetMetadata(state_->dataset.get(), domain.c_str());
    for (int i = 0; i < CSLCount(list); ++i) {
        char* key = nullptr;
        const char* value = CPLParseNameValue(list[i], &key);
        if (key != nullptr && value != nullptr) {
            items[key] = value;
        }
        CPLFree(key);
    }
    return items;
}

void RasterSource::read(const Rect& window, ImageView<double> values)
{
    if (values.size() != window.size()) {
        throw std::invalid_argument("RasterSource::read: view and window differ in size");
    }
    if (std::exchange(state_->suspect, true)) {
        state_->open(); // what the failed read left in GDAL must not pass for pixels
    }
    // Strips end at block borders of the file, so no block is decoded for two of them.
    const int block = block_size().rows;
    const int rows =
        block > 4 * kStripRows ? kStripRows : tiling::ceil_div(kStripRows, block) * block;
    for (int row = window.row; row < window.row_end();) {
        const int end = std::min((row / rows + 1) * rows, window.row_end());
        const Rect strip = tiling::rect_between(row, window.col, end, window.col_end());
        state_->read_strip(strip, values.part({row - window.row, 0, strip.rows, strip.cols}));
        row = end;
    }
    state_->suspect = false;
}

} // namespace hsgm::io
