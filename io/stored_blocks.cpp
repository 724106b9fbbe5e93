#include "io/stored_blocks.h"

#include "io/error.h"
#include "io/gdal_private.h"

#include <cpl_vsi.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace hsgm::io {

namespace {

/// Where a block begins or how long it is, as the TIFF's directory says; 0 where it says
/// nothing.
std::int64_t block_entry(GDALRasterBandH band, const char* what, int col, int row)
{
    const std::string key =
        std::string(what) + "_" + std::to_string(col) + "_" + std::to_string(row);
    const char* value = GDALGetMetadataItem(band, key.c_str(), "TIFF");
    return value == nullptr ? 0 : std::strtoll(value, nullptr, 10);
}

bool decodes(GDALRasterBandH band, PixelType type, tiling::Size block, int col, int row)
{
    std::vector<std::byte> pixels(static_cast<std::size_t>(block.area()) * bytes_of(type));
    return GDALReadBlock(band, col, row, pixels.data()) == CE_None;
}

std::string first_flaw(GDALDatasetH dataset, const std::string& path, tiling::Size size,
                       PixelType type, bool may_omit)
{
    GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
    if (GDALGetRasterXSize(dataset) != size.cols || GDALGetRasterYSize(dataset) != size.rows ||
        GDALGetRasterDataType(band) != gdal_type(type)) {
        return "its size or pixel type is not what was asked for";
    }
    VSIStatBufL status;
    const std::int64_t bytes = VSIStatL(path.c_str(), &status) == 0 ? status.st_size : 0;
    tiling::Size block;
    GDALGetBlockSize(band, &block.cols, &block.rows);
    const int down = tiling::ceil_div(size.rows, block.rows);
    const int across = tiling::ceil_div(size.cols, block.cols);
    for (int row = 0; row < down; ++row) {
        for (int col = 0; col < across; ++col) {
            const std::int64_t offset = block_entry(band, "BLOCK_OFFSET", col, row);
            const std::int64_t length = block_entry(band, "BLOCK_SIZE", col, row);
            const bool absent = offset == 0 || length == 0;
            if ((absent && !may_omit) || (!absent && offset + length > bytes)) {
                return "block " + std::to_string(col) + ", " + std::to_string(row) +
                       " is missing from it";
            }
        }
    }
    if (!decodes(band, type, block, 0, 0) ||
        !decodes(band, type, block, across - 1, down - 1)) {
        return "its first or last block cannot be read back";
    }
    return "";
}

} // namespace

void check_stored_blocks(const PendingFile& file, tiling::Size size, PixelType type,
                         bool may_omit)
{
    std::string flaw;
    ErrorCollector errors;
    try {
        const Dataset dataset = open_raster(file.temporary_path());
        flaw = first_flaw(dataset.get(), file.temporary_path(), size, type, may_omit);
    } catch (const InputError&) {
        flaw = "it cannot be opened again";
    }
    if (!flaw.empty()) {
        const std::string reason = errors.failed() ? "; " + errors.quote() : "";
        throw StorageError("Cannot write " + file.final_path() + ": after closing it, " + flaw +
                           reason + "; look for a full or failing disk.");
    }
}

} // namespace hsgm::io
