#include "io/png.h"

#include "io/error.h"
#include "io/gdal_private.h"
#include "io/gdal_session.h"
#include "io/pending_file.h"

#include <cpl_conv.h>

#include <vector>

namespace hsgm::io {

namespace {

using tiling::ImageView;

/// Transfers all bands between a data set and interleaved pixels without gaps.
bool transfer(GDALDatasetH dataset, GDALRWFlag direction, std::vector<std::uint8_t>& pixels)
{
    const int rows = GDALGetRasterYSize(dataset);
    const int cols = GDALGetRasterXSize(dataset);
    const int bands = GDALGetRasterCount(dataset);
    return GDALDatasetRasterIO(dataset, direction, 0, 0, cols, rows, pixels.data(), cols, rows,
                               GDT_Byte, bands, nullptr, bands, bands * cols, 1) == CE_None;
}

bool reads_back(const std::string& path, const std::vector<std::uint8_t>& pixels)
{
    try {
        const Dataset dataset = open_raster(path);
        std::vector<std::uint8_t> found(pixels.size());
        const std::size_t bytes = static_cast<std::size_t>(GDALGetRasterXSize(dataset.get())) *
                                  static_cast<std::size_t>(GDALGetRasterYSize(dataset.get())) *
                                  static_cast<std::size_t>(GDALGetRasterCount(dataset.get()));
        return bytes == pixels.size() && transfer(dataset.get(), GF_Read, found) &&
               found == pixels;
    } catch (const InputError&) {
        return false;
    }
}

/// GDAL would describe the picture once more in an .aux.xml beside it.
class NoSideFiles {
public:
    NoSideFiles() { CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", "NO"); }
    ~NoSideFiles() { CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", nullptr); }
    NoSideFiles(const NoSideFiles&) = delete;
    NoSideFiles& operator=(const NoSideFiles&) = delete;
};

void write_interleaved(const std::string& path, tiling::Size size, int bands,
                       std::vector<std::uint8_t> pixels)
{
    register_gdal();
    PendingFile file(path);
    const NoSideFiles no_side_files;
    ErrorCollector errors;
    Dataset memory(GDALCreate(GDALGetDriverByName("MEM"), "", size.cols, size.rows, bands,
                              GDT_Byte, nullptr));
    const bool filled = memory != nullptr && transfer(memory.get(), GF_Write, pixels);
    Dataset picture(filled ? GDALCreateCopy(GDALGetDriverByName("PNG"),
                                            file.temporary_path().c_str(), memory.get(), FALSE,
                                            nullptr, nullptr, nullptr)
                           : nullptr);
    const bool written = picture != nullptr;
    picture.reset();
    if (!written || errors.failed() || !reads_back(file.temporary_path(), pixels)) {
        throw StorageError("Cannot write " + path + "; " + errors.quote() + ".");
    }
    file.publish();
}

} // namespace

void write_png(const std::string& path, ImageView<const std::uint8_t> gray)
{
    std::vector<std::uint8_t> pixels;
    pixels.reserve(static_cast<std::size_t>(gray.size().area()));
    for (int r = 0; r < gray.rows(); ++r) {
        pixels.insert(pixels.end(), gray.row(r), gray.row(r) + gray.cols());
    }
    write_interleaved(path, gray.size(), 1, std::move(pixels));
}

void write_png(const std::string& path, ImageView<const Rgb> pixels)
{
    std::vector<std::uint8_t> bytes;
    bytes.reserve(static_cast<std::size_t>(pixels.size().area()) * 3);
    for (int r = 0; r < pixels.rows(); ++r) {
        for (const Rgb& pixel : pixels.row_span(r)) {
            bytes.insert(bytes.end(), pixel.begin(), pixel.end());
        }
    }
    write_interleaved(path, pixels.size(), 3, std::move(bytes));
}

} // namespace hsgm::io
