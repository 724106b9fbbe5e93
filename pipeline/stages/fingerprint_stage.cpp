#include "pipeline/stages/fingerprint_stage.h"

#include "io/file_identity.h"
#include "io/raster_source.h"
#include "pipeline/ledger/checksum.h"
#include "pipeline/stages/pair_sources.h"
#include "pipeline/stages/pixel_checksum.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <tbb/parallel_invoke.h>

#include <utility>

namespace hsgm::pipeline {

namespace {

constexpr const char* kLeftPixels = "pair.left_pixels";
constexpr const char* kRightPixels = "pair.right_pixels";
constexpr const char* kStamp = "pair.stamp";

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
    if (planned.job.satellite) {
        ledger::Checksum sum;
        sum.add_values(std::span<const char>(to_json(*planned.job.satellite->pair)));
        facts["geometry found"] = "checksum " + sum.hex();
    }
    return facts;
}

std::string stamp_of(const PlannedJob& planned)
{
    std::vector<std::string> files = io::RasterSource(planned.job.left).files();
    for (std::string& file : io::RasterSource(planned.job.right).files()) {
        files.push_back(std::move(file));
    }
    return io::stamp_of_files(files);
}

ledger::Facts pixel_facts(const PairChecksums& checksums, const std::string& stamp)
{
    return {{kLeftPixels, checksums.left}, {kRightPixels, checksums.right}, {kStamp, stamp}};
}

ledger::Facts pixels_in(const ledger::Facts& facts)
{
    ledger::Facts found;
    for (const auto& [fact, name] : {std::pair(kLeftPixels, "left image pixels"),
                                     std::pair(kRightPixels, "right image pixels")}) {
        const auto known = facts.find(fact);
        if (known != facts.end()) {
            found[name] = "checksum " + known->second;
        }
    }
    return found;
}

std::vector<std::string> changed_pixels(const PlannedJob& planned, const ledger::Facts& facts)
{
    const ledger::Facts before = pixels_in(facts);
    const auto stamp = facts.find(kStamp);
    const std::string now = stamp_of(planned);
    if (before.empty() || (stamp != facts.end() && !now.empty() && stamp->second == now)) {
        return {};
    }
    spdlog::info("the images have been touched since; comparing all of their pixels");
    const PairSources sources = open_sources(planned.job);
    PairChecksums checksums;
    tbb::parallel_invoke([&] { checksums.left = checksum_of(*sources.left); },
                         [&] { checksums.right = checksum_of(*sources.right); });
    return ledger::differences(before, pixels_in(pixel_facts(checksums, now)));
}

} // namespace hsgm::pipeline
