#pragma once

#include "io/gdal_session.h"
#include "tests/catch.h"
#include "tiling/image.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <unistd.h>

namespace hsgm::io::samples {

/// A folder of its own for one test, removed with everything in it.
class TemporaryFolder {
public:
    TemporaryFolder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "hsgm-io-XXXXXX").string();
        REQUIRE(::mkdtemp(name.data()) != nullptr);
        path_ = name;
    }
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    const std::filesystem::path& path() const { return path_; }
    /// Names of everything inside, hidden files too.
    std::vector<std::string> names() const
    {
        std::vector<std::string> found;
        for (const auto& entry : std::filesystem::directory_iterator(path_)) {
            found.push_back(entry.path().filename().string());
        }
        std::sort(found.begin(), found.end());
        return found;
    }

private:
    std::filesystem::path path_;
};

/// Makes a raster with GDAL alone, so that what we read was not written by us. Every band
/// gets the same number of pixels, row by row; `touch` sets whatever else the test is about.
inline void make_raster(const std::string& path, GDALDataType type, tiling::Size size,
                        const std::vector<std::vector<double>>& bands,
                        const std::function<void(GDALDatasetH)>& touch = {},
                        const std::vector<std::string>& options = {},
                        const char* driver = "GTiff")
{
    register_gdal();
    CPLStringList list;
    for (const std::string& option : options) {
        list.AddString(option.c_str());
    }
    GDALDatasetH dataset =
        GDALCreate(GDALGetDriverByName(driver), path.c_str(), size.cols, size.rows,
                   static_cast<int>(bands.size()), type, list.List());
    REQUIRE(dataset != nullptr);
    if (touch) {
        touch(dataset);
    }
    int number = 1;
    for (std::vector<double> pixels : bands) {
        REQUIRE(GDALRasterIO(GDALGetRasterBand(dataset, number++), GF_Write, 0, 0, size.cols,
                             size.rows, pixels.data(), size.cols, size.rows, GDT_Float64, 0,
                             0) == CE_None);
    }
    GDALClose(dataset);
}

/// The bytes of a file, virtual ones too.
inline std::string bytes_of_file(const std::string& path)
{
    VSILFILE* file = VSIFOpenL(path.c_str(), "rb");
    REQUIRE(file != nullptr);
    std::string bytes;
    char buffer[65536];
    for (std::size_t n; (n = VSIFReadL(buffer, 1, sizeof(buffer), file)) > 0;) {
        bytes.append(buffer, n);
    }
    VSIFCloseL(file);
    return bytes;
}

inline void put_bytes(const std::string& path, const std::string& bytes)
{
    VSILFILE* file = VSIFOpenL(path.c_str(), "wb");
    REQUIRE(file != nullptr);
    REQUIRE(VSIFWriteL(bytes.data(), 1, bytes.size(), file) == bytes.size());
    REQUIRE(VSIFCloseL(file) == 0);
}

/// Row-by-row pixels as a list with -1 for NaN, which compares and prints well.
inline std::vector<double> flat(tiling::ImageView<const double> image)
{
    std::vector<double> values;
    for (int r = 0; r < image.rows(); ++r) {
        for (const double value : image.row_span(r)) {
            values.push_back(std::isnan(value) ? -1 : value);
        }
    }
    return values;
}

} // namespace hsgm::io::samples
