#include "io/cog.h"

#include "io/error.h"
#include "io/gdal_private.h"
#include "io/gdal_session.h"
#include "io/pending_file.h"

#include <cpl_string.h>

#include <algorithm>
#include <array>

namespace hsgm::io {

namespace {

[[noreturn]] void fail(const std::string& path, const ErrorCollector& errors)
{
    throw StorageError("Cannot write " + path + " as a cloud-optimized GeoTIFF; " +
                       errors.quote() + ".");
}

CPLStringList cog_options(const std::vector<std::string>& given, Overviews overviews)
{
    CPLStringList options;
    options.SetNameValue("COMPRESS", "DEFLATE");
    options.SetNameValue("PREDICTOR", "YES");
    options.SetNameValue("OVERVIEW_RESAMPLING",
                         overviews == Overviews::mean ? "AVERAGE" : "NEAREST");
    options.SetNameValue("BIGTIFF", "IF_SAFER");
    const char* compressions =
        GDALGetMetadataItem(GDALGetDriverByName("COG"), GDAL_DMD_CREATIONOPTIONLIST, nullptr);
    if (compressions != nullptr &&
        std::string(compressions).find("ZSTD") != std::string::npos) {
        options.SetNameValue("COMPRESS", "ZSTD");
    }
    static constexpr std::array<const char*, 3> kShared{"COMPRESS", "LEVEL", "BIGTIFF"};
    for (const std::string& option : given) {
        for (const char* key : kShared) {
            if (option.starts_with(std::string(key) + "=")) {
                options.SetNameValue(key, option.c_str() + std::string(key).size() + 1);
            }
        }
    }
    return options;
}

// Exact ones, stored in the file itself, where the copy takes them from. A raster without a
// single value has none.
void compute_statistics(const std::string& path)
{
    ErrorCollector none;
    const Dataset dataset(GDALOpen(path.c_str(), GA_Update));
    if (dataset != nullptr) {
        double lowest = 0;
        double highest = 0;
        double mean = 0;
        double deviation = 0;
        GDALComputeRasterStatistics(GDALGetRasterBand(dataset.get(), 1), FALSE, &lowest,
                                    &highest, &mean, &deviation, nullptr, nullptr);
    }
}

} // namespace

void make_cloud_optimized(const std::string& path,
                          const std::vector<std::string>& creation_options, Overviews overviews)
{
    register_gdal();
    compute_statistics(path);
    PendingFile file(path);
    {
        ErrorCollector errors;
        const Dataset plain = open_raster(path);
        Dataset copy(GDALCreateCopy(
            GDALGetDriverByName("COG"), file.temporary_path().c_str(), plain.get(), FALSE,
            cog_options(creation_options, overviews).List(), nullptr, nullptr));
        const bool made = copy != nullptr;
        copy.reset();
        if (!made || errors.failed()) {
            fail(path, errors);
        }
    }
    ErrorCollector errors;
    const Dataset written(GDALOpen(file.temporary_path().c_str(), GA_ReadOnly));
    if (written == nullptr || errors.failed()) {
        fail(path, errors);
    }
    file.publish();
}

} // namespace hsgm::io
