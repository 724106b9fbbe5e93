#pragma once

// Shared by the .cpp files of this folder. Never include it from a header: GDAL's names
// must not reach the rest of the program.

#include "io/geo_reference.h"
#include "io/pixel_type.h"

#include <cpl_error.h>
#include <gdal.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace hsgm::io {

/// While it lives, everything that GDAL complains about on this thread is collected here
/// instead of being printed. Scopes nest; the innermost one collects.
class ErrorCollector {
public:
    ErrorCollector();
    ~ErrorCollector();
    ErrorCollector(const ErrorCollector&) = delete;
    ErrorCollector& operator=(const ErrorCollector&) = delete;

    /// Something failed; warnings do not count.
    bool failed() const { return !failures_.empty(); }
    /// Ready to quote: "GDAL says: ... (No space left on device)".
    std::string quote() const;

private:
    static void CPL_STDCALL collect(CPLErr severity, CPLErrorNum number, const char* text);

    std::vector<std::string> failures_;
    std::vector<std::string> warnings_;
    std::string system_message_;
};

struct DatasetCloser {
    void operator()(GDALDatasetH dataset) const { GDALClose(dataset); }
};
/// An open data set; closing one that was written must happen inside an ErrorCollector.
using Dataset = std::unique_ptr<void, DatasetCloser>;

/// Opens a raster for reading; throws InputError with GDAL's own message.
Dataset open_raster(const std::string& path);

/// Where an open raster lies.
GeoReference geo_reference_of(GDALDatasetH dataset);

/// GDAL's name of a pixel type, and back; nothing where we have no such type.
GDALDataType gdal_type(PixelType type);
std::optional<PixelType> pixel_type(GDALDataType type);

} // namespace hsgm::io
