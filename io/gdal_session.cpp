#include "io/gdal_session.h"

#include "io/error.h"
#include "io/gdal_private.h"

#include <cpl_conv.h>
#include <cpl_vsi.h>

#include <array>
#include <cerrno>
#include <mutex>
#include <system_error>

namespace hsgm::io {

namespace {

struct TypeName {
    PixelType type;
    GDALDataType gdal;
    const char* name;
    std::size_t bytes;
};

constexpr std::array<TypeName, 7> kTypes{{
    {PixelType::uint8, GDT_Byte, "uint8", 1},
    {PixelType::uint16, GDT_UInt16, "uint16", 2},
    {PixelType::int16, GDT_Int16, "int16", 2},
    {PixelType::uint32, GDT_UInt32, "uint32", 4},
    {PixelType::int32, GDT_Int32, "int32", 4},
    {PixelType::float32, GDT_Float32, "float32", 4},
    {PixelType::float64, GDT_Float64, "float64", 8},
}};

const TypeName& row_of(PixelType type)
{
    return kTypes[static_cast<std::size_t>(type)];
}

/// GDAL reports that a write failed, not why. The system's reason is usually still in errno
/// when the error handler runs; only reasons that a user can act on are worth quoting, since
/// errno also holds leftovers of harmless look-ups.
std::string actionable_system_message(int code)
{
    switch (code) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
    case EROFS:
    case EACCES:
    case EIO:
        return std::generic_category().message(code);
    default:
        return "";
    }
}

} // namespace

void register_gdal()
{
    static std::once_flag once;
    std::call_once(once, [] {
        // A JPEG cut short is a warning by default and its missing part turns grey: pixels
        // that nobody measured. Users may still ask for the old behaviour.
        if (CPLGetConfigOption("GDAL_ERROR_ON_LIBJPEG_WARNING", nullptr) == nullptr) {
            CPLSetConfigOption("GDAL_ERROR_ON_LIBJPEG_WARNING", "YES");
        }
        GDALAllRegister();
    });
}

void initialise_gdal(std::size_t cache_bytes)
{
    register_gdal();
    GDALSetCacheMax64(static_cast<GIntBig>(cache_bytes));
}

const char* name_of(PixelType type)
{
    return row_of(type).name;
}

std::size_t bytes_of(PixelType type)
{
    return row_of(type).bytes;
}

GDALDataType gdal_type(PixelType type)
{
    return row_of(type).gdal;
}

std::optional<PixelType> pixel_type(GDALDataType type)
{
    for (const TypeName& row : kTypes) {
        if (row.gdal == type) {
            return row.type;
        }
    }
    return std::nullopt;
}

ErrorCollector::ErrorCollector()
{
    errno = 0;
    CPLPushErrorHandlerEx(&ErrorCollector::collect, this);
    // CPL_DEBUG=ON is how users study GDAL; let those lines through.
    CPLSetCurrentErrorHandlerCatchDebug(FALSE);
}

ErrorCollector::~ErrorCollector()
{
    CPLPopErrorHandler();
}

void CPL_STDCALL ErrorCollector::collect(CPLErr severity, CPLErrorNum, const char* text)
{
    const int code = errno;
    auto* self = static_cast<ErrorCollector*>(CPLGetErrorHandlerUserData());
    if (severity != CE_Failure && severity != CE_Fatal) {
        self->warnings_.emplace_back(text);
        return;
    }
    self->failures_.emplace_back(text);
    if (self->system_message_.empty()) {
        self->system_message_ = actionable_system_message(code);
    }
}

std::string ErrorCollector::quote() const
{
    // The first failure is closest to the cause; the later ones only say who else stumbled.
    std::string text = "GDAL gives no reason";
    if (!failures_.empty()) {
        text = "GDAL says: " + failures_.front();
    } else if (!warnings_.empty()) {
        text = "GDAL says: " + warnings_.front();
    }
    text.erase(text.find_last_not_of(". \n") + 1); // sentences go on after a quote
    return system_message_.empty() ? text : text + " (" + system_message_ + ")";
}

Dataset open_raster(const std::string& path)
{
    register_gdal();
    ErrorCollector errors;
    const unsigned flags = GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR;
    Dataset dataset(GDALOpenEx(path.c_str(), flags, nullptr, nullptr, nullptr));
    if (dataset == nullptr) {
        VSIStatBufL status;
        if (VSIStatL(path.c_str(), &status) != 0) {
            throw InputError("There is no file " + path + " (" + errors.quote() + ").");
        }
        throw InputError("Cannot open " + path + " as a raster; " + errors.quote() + ".");
    }
    if (GDALGetRasterCount(dataset.get()) == 0) {
        throw InputError(path + " holds no raster band; if it is a container, name one of "
                                "the subdatasets that gdalinfo lists.");
    }
    return dataset;
}

const char* gdal_version()
{
    return GDALVersionInfo("RELEASE_NAME");
}

} // namespace hsgm::io
