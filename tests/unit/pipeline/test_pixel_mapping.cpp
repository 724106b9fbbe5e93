#include "tests/catch.h"

#include "pipeline/stages/pixel_mapping.h"

#include "io/geotiff_writer.h"
#include "matcher/pixel.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

using namespace hsgm;
using namespace hsgm::pipeline;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// A raster of one row, gone with this object.
class RowFile {
public:
    template <typename T>
    explicit RowFile(const std::vector<T>& values, std::optional<double> nodata = std::nullopt)
        : path_((std::filesystem::temp_directory_path() /
                 ("hsgm_row_" + std::to_string(::getpid()) + "_" + std::to_string(++made_) +
                  ".tif"))
                    .string())
    {
        const tiling::Size size{1, static_cast<int>(values.size())};
        io::RasterOptions options;
        options.nodata = nodata;
        io::GeoTiffWriter writer(path_, size, io::pixel_type_of<T>(), options);
        tiling::Image<T> row(size);
        std::copy(values.begin(), values.end(), row.data());
        writer.write(rect_of(size), row);
        writer.finish();
    }
    ~RowFile() { std::filesystem::remove(path_); }
    RowFile(const RowFile&) = delete;
    RowFile& operator=(const RowFile&) = delete;

    FileSource open() const { return FileSource(io::RasterSource({path_})); }

private:
    static inline int made_ = 0;
    std::string path_;
};

PixelMapping mapping_of(const RowFile& left, const RowFile& right)
{
    auto left_source = left.open();
    auto right_source = right.open();
    return find_mapping(left_source, right_source);
}

std::unique_ptr<PixelHistogram> empty_histogram()
{
    return std::make_unique<PixelHistogram>();
}

} // namespace

TEST_CASE("8-bit and uint16 pixels keep their values, but 65535 becomes 65534")
{
    const PixelMapping mapping = mapping_of(RowFile(std::vector<std::uint8_t>{9, 200}),
                                            RowFile(std::vector<std::uint16_t>{70, 65535}));
    for (const int value : {0, 1, 255, 4095, 65533, 65534}) {
        CHECK(mapping(value) == value);
    }
    CHECK(mapping(65535) == 65534);
    CHECK(mapping(kNaN) == matcher::kNodataPixel);
}

TEST_CASE("integers whose span fits 16 bits are only shifted, both images alike")
{
    const PixelMapping mapping = mapping_of(RowFile(std::vector<std::int16_t>{-5, 100}),
                                            RowFile(std::vector<std::int16_t>{-90, 7}));
    CHECK(mapping(-90) == 0);
    CHECK(mapping(-5) == 85);
    CHECK(mapping(100) == 190);
    const PixelMapping wide = mapping_of(RowFile(std::vector<std::int32_t>{0, 1'000'000}),
                                         RowFile(std::vector<std::int32_t>{500'000, 7}));
    CHECK(wide(0) == 0);
    CHECK(wide(1'000'000) == 65534);
    CHECK(wide(500'000) == 32767);
}

TEST_CASE("float pixels are mapped by the range of both images, NaN and nodata left out")
{
    const auto nan = std::numeric_limits<float>::quiet_NaN();
    const PixelMapping mapping =
        mapping_of(RowFile(std::vector<float>{0.25F, nan, -9999}, -9999),
                   RowFile(std::vector<float>{1.25F, 0.5F, nan}));
    CHECK(mapping(0.25) == 0);
    CHECK(mapping(1.25) == 65534);
    CHECK(mapping(0.75) == 32767);
    CHECK(mapping(-3) == 0);
    CHECK(mapping(7) == 65534);
    CHECK(mapping(kNaN) == matcher::kNodataPixel);
}

TEST_CASE("float images of one value, or of none, have a mapping too")
{
    const auto nan = std::numeric_limits<float>::quiet_NaN();
    const PixelMapping one =
        mapping_of(RowFile(std::vector<float>{3.5F}), RowFile(std::vector<float>{3.5F}));
    CHECK(one(3.5) == 0);
    const PixelMapping none =
        mapping_of(RowFile(std::vector<float>{nan}), RowFile(std::vector<float>{nan}));
    CHECK(none(kNaN) == matcher::kNodataPixel);
}

TEST_CASE("the tone of 8-bit images is the identity")
{
    auto histogram = empty_histogram();
    (*histogram)[17] = 1000;
    CHECK(find_tone(io::PixelType::uint8, *histogram) == matcher::Tone{0, 255});
}

TEST_CASE("other tones leave out a thousandth of the pixels at either end")
{
    // 10 000 pixels of value 1000..10 999, one each.
    auto histogram = empty_histogram();
    for (std::size_t value = 1000; value < 11'000; ++value) {
        (*histogram)[value] = 1;
    }
    // More than 10 pixels up to 1010, at least 9990 up to 10 989.
    CHECK(find_tone(io::PixelType::uint16, *histogram) == matcher::Tone{1010, 10'989});
    // Two thousandths of outliers on one side.
    (*histogram)[60'000] = 20;
    CHECK(find_tone(io::PixelType::uint16, *histogram).hi == 60'000);
    (*histogram)[60'000] = 9;
    CHECK(find_tone(io::PixelType::uint16, *histogram).hi < 11'000);
}

TEST_CASE("an image of one value has a tone that can be divided by")
{
    auto histogram = empty_histogram();
    (*histogram)[400] = 5;
    CHECK(find_tone(io::PixelType::float32, *histogram) == matcher::Tone{400, 401});
    CHECK(find_tone(io::PixelType::uint16, *empty_histogram()).hi == 1);
}

TEST_CASE("tones run from 0 to 255 and nodata is 0")
{
    const matcher::Tone tone{100, 355};
    CHECK(tone(50) == 0);
    CHECK(tone(100) == 0);
    CHECK(tone(101) == 1);
    CHECK(tone(355) == 255);
    CHECK(tone(9000) == 255);
    CHECK(tone(matcher::kNodataPixel) == 0);
    CHECK(matcher::Tone{0, 255}(77) == 77);
}
