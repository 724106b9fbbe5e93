#include "io/creation_options_private.h"

#include "io/error.h"
#include "io/gdal_private.h"

#include <cpl_vsi.h>

#include <atomic>
#include <cstring>

namespace hsgm::io {

namespace {

bool geotiff_offers(const char* word)
{
    GDALDriverH driver = GDALGetDriverByName("GTiff");
    const char* list = GDALGetMetadataItem(driver, GDAL_DMD_CREATIONOPTIONLIST, nullptr);
    return list != nullptr && std::strstr(list, word) != nullptr;
}

CPLStringList user_options(const std::string& path, const std::vector<std::string>& entries)
{
    CPLStringList options;
    for (const std::string& entry : entries) {
        const std::size_t equals = entry.find('=');
        if (equals == 0 || equals == std::string::npos) {
            throw ConfigError("The creation option '" + entry + "' for " + path +
                              " must read KEY=VALUE, for example COMPRESS=LZW.");
        }
        options.SetNameValue(entry.substr(0, equals).c_str(), entry.substr(equals + 1).c_str());
    }
    return options;
}

void add_default(CPLStringList& options, const char* key, const char* value)
{
    if (options.FetchNameValue(key) == nullptr) {
        options.SetNameValue(key, value);
    }
}

/// Defaults that depend on other options keep out of the way where they would make no sense:
/// GDAL refuses a predictor for compressions without one.
void add_defaults(CPLStringList& options, PixelType type)
{
    add_default(options, "TILED", "YES");
    if (CPLTestBool(options.FetchNameValueDef("TILED", "YES"))) {
        add_default(options, "BLOCKXSIZE", "256");
        add_default(options, "BLOCKYSIZE", "256");
    }
    add_default(options, "COMPRESS",
                geotiff_offers("<Value>ZSTD</Value>") ? "ZSTD" : "DEFLATE");
    const std::string compression = options.FetchNameValue("COMPRESS");
    for (const char* with_predictor : {"ZSTD", "DEFLATE", "LZW"}) {
        if (EQUAL(compression.c_str(), with_predictor)) {
            add_default(options, "PREDICTOR", is_floating(type) ? "3" : "2");
        }
    }
    if (EQUAL(compression.c_str(), "ZSTD")) {
        // Twice as fast as GDAL's choice of 9, for files that are 6 % larger.
        add_default(options, "ZSTD_LEVEL", "3");
    }
    add_default(options, "BIGTIFF", "IF_SAFER");
}

/// Writes one pixel into memory with these options, for GDAL finds some contradictions only
/// then; found here, they are the user's mistake and not the disk's.
void rehearse(const std::string& path, const CPLStringList& options, PixelType type)
{
    static std::atomic<unsigned> counter{0};
    const std::string name = "/vsimem/hsgm-rehearsal-" + std::to_string(counter++) + ".tif";
    ErrorCollector errors;
    Dataset dataset(GDALCreate(GDALGetDriverByName("GTiff"), name.c_str(), 1, 1, 1,
                               gdal_type(type), options.List()));
    if (dataset != nullptr) {
        double pixel = 0;
        const CPLErr result = GDALRasterIO(GDALGetRasterBand(dataset.get(), 1), GF_Write, 0, 0,
                                           1, 1, &pixel, 1, 1, GDT_Float64, 0, 0);
        (void)result; // the collector knows
        dataset.reset();
    }
    VSIUnlink(name.c_str());
    if (errors.failed()) {
        throw ConfigError("The creation options for " + path + " do not work for " +
                          name_of(type) + " pixels; " + errors.quote() + ".");
    }
}

} // namespace

CPLStringList geotiff_options(const std::string& path, PixelType type,
                              const std::vector<std::string>& overrides)
{
    CPLStringList options = user_options(path, overrides);
    {
        ErrorCollector errors;
        if (GDALValidateCreationOptions(GDALGetDriverByName("GTiff"), options.List()) ==
            FALSE) {
            throw ConfigError("A creation option for " + path + " is unknown or has a wrong " +
                              "value; " + errors.quote() + ".");
        }
    }
    add_defaults(options, type);
    rehearse(path, options, type);
    return options;
}

} // namespace hsgm::io
