#include "io/geotiff_writer.h"

#include "io/creation_options_private.h"
#include "io/error.h"
#include "io/gdal_private.h"
#include "io/gdal_session.h"
#include "io/pending_file.h"
#include "io/stored_blocks.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <unordered_map>
#include <utility>

namespace hsgm::io {

using tiling::Rect;
using tiling::Size;

namespace {

/// A block of the file on its way: its pixels so far, and which ones they are.
struct Block {
    std::vector<std::byte> pixels;
    std::vector<Rect> written;
    std::int64_t missing = 0;
};

std::vector<std::byte> one_pixel(PixelType type, double value)
{
    std::vector<std::byte> bytes(bytes_of(type));
    GDALCopyWords64(&value, GDT_Float64, 0, bytes.data(), gdal_type(type), 0, 1);
    return bytes;
}

void describe(GDALDatasetH dataset, const RasterOptions& options)
{
    GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
    if (options.geo.transform.has_value()) {
        auto transform = *options.geo.transform;
        GDALSetGeoTransform(dataset, transform.data());
    }
    if (!options.geo.wkt.empty()) {
        GDALSetProjection(dataset, options.geo.wkt.c_str());
    }
    if (options.nodata.has_value()) {
        GDALSetRasterNoDataValue(band, *options.nodata);
    }
    for (const auto& [key, value] : options.metadata) {
        GDALSetMetadataItem(dataset, key.c_str(), value.c_str(), nullptr);
    }
    for (const auto& [key, value] : options.rpc) {
        GDALSetMetadataItem(dataset, key.c_str(), value.c_str(), "RPC");
    }
    if (!options.band_descriptions.empty()) {
        GDALSetDescription(band, options.band_descriptions.front().c_str());
    }
    if (!options.unit.empty()) {
        GDALSetRasterUnitType(band, options.unit.c_str());
    }
}

} // namespace

struct GeoTiffWriter::State {
    State(std::string path, Size raster, PixelType pixel_type, RasterOptions raster_options)
        : file(std::move(path)), size(raster), type(pixel_type),
          options(std::move(raster_options)), fill(one_pixel(type, options.nodata.value_or(0)))
    {
    }
    ~State();

    PendingFile file; // first: outlives the dataset, which has the temporary file open
    Size size;
    PixelType type;
    RasterOptions options;
    std::vector<std::byte> fill;
    Size block;
    Size grid; // blocks down and across
    std::unordered_map<std::int64_t, Block> pending;
    std::vector<bool> done; // by block, row by row
    bool complete = false;  // closed, and found whole
    bool sparse = false;    // SPARSE_OK: GDAL may leave out blocks of nothing but nodata
    Dataset dataset;

    void create();
    Rect rect_of_block(std::int64_t index) const;
    bool is_written(std::int64_t index, const Rect& rect) const;
    Block& begin(std::int64_t index);
    void store(std::int64_t index);
    void place(std::int64_t index, const Rect& rect, const std::byte* pixels,
               std::ptrdiff_t row_bytes);
    void close();
    [[noreturn]] void fail(const ErrorCollector& errors) const;
};

GeoTiffWriter::State::~State()
{
    if (dataset != nullptr) {
        ErrorCollector errors; // closing what is thrown away may fail in peace
        dataset.reset();
    }
}

void GeoTiffWriter::State::fail(const ErrorCollector& errors) const
{
    throw StorageError("Cannot write " + file.final_path() + "; " + errors.quote() +
                       "; an earlier file of that name is untouched.");
}

void GeoTiffWriter::State::create()
{
    const CPLStringList creation =
        geotiff_options(file.final_path(), type, options.creation_options);
    sparse = creation.FetchBool("SPARSE_OK", false);
    ErrorCollector errors;
    dataset.reset(GDALCreate(GDALGetDriverByName("GTiff"), file.temporary_path().c_str(),
                             size.cols, size.rows, 1, gdal_type(type), creation.List()));
    if (dataset == nullptr) {
        fail(errors);
    }
    describe(dataset.get(), options);
    if (errors.failed()) {
        fail(errors);
    }
    GDALGetBlockSize(GDALGetRasterBand(dataset.get(), 1), &block.cols, &block.rows);
    grid = {tiling::ceil_div(size.rows, block.rows), tiling::ceil_div(size.cols, block.cols)};
    done.resize(static_cast<std::size_t>(grid.area()));
}

/// The pixels of the raster that a block holds; those of the last row and column of blocks
/// hold fewer than they have room for.
Rect GeoTiffWriter::State::rect_of_block(std::int64_t index) const
{
    const int row = static_cast<int>(index / grid.cols) * block.rows;
    const int col = static_cast<int>(index % grid.cols) * block.cols;
    return tiling::intersect({row, col, block.rows, block.cols}, tiling::rect_of(size));
}

Block& GeoTiffWriter::State::begin(std::int64_t index)
{
    const auto [entry, is_new] = pending.try_emplace(index);
    Block& begun = entry->second;
    if (is_new) {
        begun.missing = rect_of_block(index).area();
        begun.pixels.resize(static_cast<std::size_t>(block.area()) * fill.size());
        for (std::size_t at = 0; at < begun.pixels.size(); at += fill.size()) {
            std::memcpy(&begun.pixels[at], fill.data(), fill.size());
        }
    }
    return begun;
}

void GeoTiffWriter::State::store(std::int64_t index)
{
    ErrorCollector errors;
    GDALRasterBandH band = GDALGetRasterBand(dataset.get(), 1);
    const int row = static_cast<int>(index / grid.cols);
    const int col = static_cast<int>(index % grid.cols);
    const CPLErr result = GDALWriteBlock(band, col, row, pending.at(index).pixels.data());
    if (result != CE_None || errors.failed()) {
        fail(errors);
    }
    pending.erase(index);
    done[static_cast<std::size_t>(index)] = true;
}

bool GeoTiffWriter::State::is_written(std::int64_t index, const Rect& rect) const
{
    const auto begun = pending.find(index);
    if (begun == pending.end()) {
        return done[static_cast<std::size_t>(index)];
    }
    const std::vector<Rect>& written = begun->second.written;
    return std::any_of(written.begin(), written.end(), [&](const Rect& earlier) {
        return !tiling::intersect(earlier, rect).empty();
    });
}

void GeoTiffWriter::State::place(std::int64_t index, const Rect& rect, const std::byte* pixels,
                                 std::ptrdiff_t row_bytes)
{
    if (is_written(index, rect)) {
        throw std::logic_error("GeoTiffWriter: a pixel of " + file.final_path() +
                               " was written twice");
    }
    Block& target = begin(index);
    const Rect home = rect_of_block(index);
    const std::size_t pixel_bytes = fill.size();
    for (int r = 0; r < rect.rows; ++r) {
        const std::int64_t at =
            std::int64_t{rect.row - home.row + r} * block.cols + (rect.col - home.col);
        std::memcpy(&target.pixels[static_cast<std::size_t>(at) * pixel_bytes],
                    pixels + r * row_bytes, static_cast<std::size_t>(rect.cols) * pixel_bytes);
    }
    target.written.push_back(rect);
    target.missing -= rect.area();
    if (target.missing == 0) {
        store(index);
    }
}

void GeoTiffWriter::State::close()
{
    ErrorCollector errors;
    GDALFlushCache(dataset.get());
    dataset.reset();
    if (errors.failed()) {
        fail(errors);
    }
}

void check_creation_options(const std::string& path, PixelType type,
                            const std::vector<std::string>& creation_options)
{
    register_gdal();
    geotiff_options(path, type, creation_options);
}

GeoTiffWriter::GeoTiffWriter(std::string path, Size size, PixelType type, RasterOptions options)
{
    register_gdal();
    state_ = std::make_unique<State>(std::move(path), size, type, std::move(options));
    state_->create();
}

GeoTiffWriter::~GeoTiffWriter() = default;
GeoTiffWriter::GeoTiffWriter(GeoTiffWriter&&) noexcept = default;
GeoTiffWriter& GeoTiffWriter::operator=(GeoTiffWriter&&) noexcept = default;

Size GeoTiffWriter::size() const
{
    return state_->size;
}

Size GeoTiffWriter::block_size() const
{
    return state_->block;
}

std::size_t GeoTiffWriter::pending_bytes() const
{
    return state_->pending.size() * static_cast<std::size_t>(state_->block.area()) *
           state_->fill.size();
}

void GeoTiffWriter::write_bytes(const Rect& rect, const std::byte* pixels, Size size,
                                std::ptrdiff_t row_bytes, PixelType type)
{
    State& state = *state_;
    if (state.dataset == nullptr || type != state.type || size != rect.size() ||
        !tiling::rect_of(state.size).contains(rect)) {
        throw std::logic_error("GeoTiffWriter: the piece does not fit " +
                               state.file.final_path() + " in place, size or type");
    }
    if (rect.empty()) {
        return;
    }
    const auto pixel_bytes = static_cast<std::ptrdiff_t>(state.fill.size());
    for (int row = rect.row / state.block.rows; row * state.block.rows < rect.row_end();
         ++row) {
        for (int col = rect.col / state.block.cols; col * state.block.cols < rect.col_end();
             ++col) {
            const std::int64_t index = std::int64_t{row} * state.grid.cols + col;
            const Rect part = tiling::intersect(rect, state.rect_of_block(index));
            state.place(index, part,
                        pixels + (part.row - rect.row) * row_bytes +
                            (part.col - rect.col) * pixel_bytes,
                        row_bytes);
        }
    }
}

void GeoTiffWriter::complete()
{
    State& state = *state_;
    if (state.dataset == nullptr) {
        throw std::logic_error("GeoTiffWriter: " + state.file.final_path() +
                               " is finished already");
    }
    for (std::int64_t index = 0; index < state.grid.area(); ++index) {
        if (!state.done[static_cast<std::size_t>(index)]) {
            state.begin(index);
            state.store(index);
        }
    }
    state.close();
    check_stored_blocks(state.file, state.size, state.type, state.sparse);
    state.complete = true;
}

void GeoTiffWriter::publish()
{
    if (!state_->complete) {
        throw std::logic_error("GeoTiffWriter: " + state_->file.final_path() +
                               " is not complete");
    }
    state_->file.publish();
}

void GeoTiffWriter::finish()
{
    complete();
    publish();
}

} // namespace hsgm::io
