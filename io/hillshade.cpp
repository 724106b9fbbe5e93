#include "io/hillshade.h"

#include "io/creation_options_private.h"
#include "io/error.h"
#include "io/gdal_private.h"
#include "io/pending_file.h"
#include "io/raster_channels_private.h"
#include "io/stored_blocks.h"

#include <gdal_utils.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace hsgm::io {

namespace {

void check(const char* name, double value, bool allowed, const char* range)
{
    if (!std::isfinite(value) || !allowed) {
        throw ConfigError(std::string("The hillshade's ") + name + " is " +
                          std::to_string(value) + "; it must be " + range + ".");
    }
}

/// For GDAL, rows without a georeference go north. They go down, as in the picture, whose top
/// is north for us; so the light is mirrored.
double azimuth_for(GDALDatasetH height, double azimuth_deg)
{
    double transform[6];
    if (GDALGetGeoTransform(height, transform) == CE_None) {
        return azimuth_deg;
    }
    return azimuth_deg <= 180 ? 180 - azimuth_deg : 540 - azimuth_deg;
}

struct OptionsFree {
    void operator()(GDALDEMProcessingOptions* options) const
    {
        GDALDEMProcessingOptionsFree(options);
    }
};
using DemOptions = std::unique_ptr<GDALDEMProcessingOptions, OptionsFree>;

DemOptions gdal_options(const HillshadeOptions& options, double azimuth_deg,
                        const CPLStringList& creation)
{
    CPLStringList list;
    const auto add = [&](const char* flag, double value) {
        list.AddString(flag);
        list.AddString(CPLSPrintf("%.17g", value));
    };
    add("-az", azimuth_deg);
    add("-alt", options.altitude_deg);
    add("-z", options.z_factor);
    add("-s", options.scale);
    list.AddString("-compute_edges"); // else the outermost pixels would stay empty
    list.AddString("-of");
    list.AddString("GTiff");
    for (int i = 0; i < creation.Count(); ++i) {
        list.AddString("-co");
        list.AddString(creation[i]);
    }
    return DemOptions(GDALDEMProcessingOptionsNew(list.List(), nullptr));
}

/// Room in GDAL's block cache while it lives. GDAL shades row by row and wants the blocks of
/// three rows at hand; in too little room it would decode each block anew for each of its rows.
class CacheRoom {
public:
    explicit CacheRoom(GIntBig bytes) : before_(GDALGetCacheMax64())
    {
        GDALSetCacheMax64(std::max(before_, bytes));
    }
    ~CacheRoom() { GDALSetCacheMax64(before_); }
    CacheRoom(const CacheRoom&) = delete;
    CacheRoom& operator=(const CacheRoom&) = delete;

private:
    GIntBig before_;
};

/// Asks whether to go on, for GDAL.
struct Question {
    const std::function<bool()>& go_on;
    bool refused = false;

    static int ask(double, const char*, void* question)
    {
        auto& q = *static_cast<Question*>(question);
        q.refused = q.refused || (q.go_on && !q.go_on());
        return q.refused ? FALSE : TRUE;
    }
};

} // namespace

std::int64_t hillshade_bytes(tiling::Size size)
{
    // Two rows of blocks of heights, and two of shades.
    constexpr std::int64_t kBlock = 256;
    return (size.cols + kBlock) * kBlock * 2 * (sizeof(float) + 1);
}

void HillshadeOptions::validate() const
{
    check("azimuth_deg", azimuth_deg, azimuth_deg >= 0 && azimuth_deg <= 360, "0 to 360");
    check("altitude_deg", altitude_deg, altitude_deg >= 0 && altitude_deg <= 90, "0 to 90");
    check("z_factor", z_factor, z_factor > 0, "above 0");
    check("scale", scale, scale > 0, "above 0");
}

bool write_hillshade(const std::string& height_path, const std::string& output_path,
                     const HillshadeOptions& options, const std::function<bool()>& go_on)
{
    options.validate();
    const Dataset height = open_raster(height_path);
    const CPLStringList creation =
        geotiff_options(output_path, PixelType::uint8, options.creation_options);
    PendingFile file(output_path);
    const CacheRoom room(hillshade_bytes(size_of(height.get())));
    ErrorCollector errors;
    const DemOptions dem_options =
        gdal_options(options, azimuth_for(height.get(), options.azimuth_deg), creation);
    Question question{go_on};
    GDALDEMProcessingOptionsSetProgress(dem_options.get(), Question::ask, &question);
    Dataset shaded(GDALDEMProcessing(file.temporary_path().c_str(), height.get(), "hillshade",
                                     nullptr, dem_options.get(), nullptr));
    const bool made = shaded != nullptr;
    shaded.reset();
    if (question.refused) {
        return false;
    }
    if (!made || errors.failed()) {
        throw StorageError("Cannot shade " + height_path + " into " + output_path + "; " +
                           errors.quote() + ".");
    }
    check_stored_blocks(file, size_of(height.get()), PixelType::uint8,
                        creation.FetchBool("SPARSE_OK", false));
    file.publish();
    return true;
}

} // namespace hsgm::io
