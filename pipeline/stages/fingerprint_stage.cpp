#include "pipeline/stages/fingerprint_stage.h"

#include "io/file_identity.h"
#include "io/raster_source.h"
#include "pipeline/ledger/checksum.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hsgm::pipeline {

namespace {

constexpr int kWindowsAcross = 8;
constexpr int kWindowSide = 32;

// Pixels as the matcher will see them: nodata is NaN, whatever number it is stored as.
std::string sample(io::RasterSource& source)
{
    const tiling::Size size = source.size();
    const tiling::Size window{std::min(size.rows, kWindowSide),
                              std::min(size.cols, kWindowSide)};
    ledger::Checksum sum;
    tiling::Image<double> pixels(window);
    const auto place = [](int i, int room) {
        return static_cast<int>(std::int64_t{room} * i / (kWindowsAcross - 1));
    };
    for (int i = 0; i < kWindowsAcross * kWindowsAcross; ++i) {
        source.read({place(i / kWindowsAcross, size.rows - window.rows),
                     place(i % kWindowsAcross, size.cols - window.cols), window.rows,
                     window.cols},
                    pixels.view());
        std::replace_if(
            pixels.data(), pixels.data() + window.area(),
            [](double v) { return std::isnan(v); },
            -1e300); // NaN has many bit patterns
        sum.add_values(pixels.pixels());
    }
    return sum.hex();
}

std::string text_of(const io::GeoReference& geo)
{
    ledger::Checksum sum;
    if (geo.transform) {
        sum.add_values(std::span<const double>(*geo.transform));
    }
    sum.add_values(std::span<const char>(geo.wkt));
    return geo.transform || !geo.wkt.empty() ? "checksum " + sum.hex() : "none";
}

void describe(const std::string& name, const io::ImageSpec& spec, ledger::Facts& facts)
{
    io::RasterSource source(spec);
    facts[name + " size"] = fmt::format("{} x {} px", source.size().cols, source.size().rows);
    facts[name + " type"] = io::name_of(source.pixel_type());
    facts[name + " georeference"] = text_of(source.geo_reference());
    facts[name + " pixels"] = "checksum " + sample(source);
}

bool defines_the_result(const io::ConfigValue& value)
{
    return !value.name.starts_with("run.") && !value.name.starts_with("output.") &&
           !value.is_image;
}

} // namespace

ledger::Facts settings_of(const io::ConfigDocument& document)
{
    ledger::Facts settings;
    for (const io::ConfigValue& value : document.effective_values()) {
        if (defines_the_result(value)) {
            settings[value.name] =
                value.is_file ? io::identity_of_file(value.text) : value.text;
        }
    }
    return settings;
}

ledger::Facts fingerprint(const PlannedJob& planned, const ledger::Facts& settings)
{
    ledger::Facts facts = settings;
    facts["program"] = "hsgm " HSGM_VERSION;
    describe("left image", planned.job.left, facts);
    describe("right image", planned.job.right, facts);
    return facts;
}

} // namespace hsgm::pipeline
