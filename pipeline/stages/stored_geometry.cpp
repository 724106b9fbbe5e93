#include "pipeline/stages/stored_geometry.h"

#include "io/error.h"
#include "io/pending_file.h"
#include "pipeline/geometry/error.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace hsgm::pipeline {

namespace {

constexpr const char* kFileName = "geometry.json";

std::filesystem::path kept_file(const RunLayout& layout)
{
    return layout.work() / kFileName;
}

std::string text_of(const std::string& path)
{
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    if (!file) {
        throw io::InputError(fmt::format("cannot read the stored geometry {}", path));
    }
    return text.str();
}

geometry::ImageCorrection correction_of(const io::ImageSpec& image,
                                        const PairGeometryOptions& search,
                                        const geometry::PairGeometry& stored,
                                        const std::string& path)
{
    const io::RasterSource source(image);
    const geometry::SensorModel model = open_sensor(source, image, search);
    for (const geometry::SensorModel* other : {&stored.left, &stored.right}) {
        if (same_sensor(model, *other)) {
            return other->correction();
        }
    }
    throw io::InputError(
        fmt::format("geometry.pointing_from: {} has no corrections for {}: neither "
                    "of its images was taken in the same way",
                    path, source.description()));
}

void check_model(const io::ImageSpec& image, const PairGeometryOptions& search,
                 const geometry::SensorModel& stored, const std::string& path)
{
    const io::RasterSource source(image);
    if (!same_sensor(open_sensor(source, image, search), stored)) {
        throw io::InputError(fmt::format(
            "{} is the geometry of other images: {} of {} is not the one that it was found "
            "with",
            path, search.ortho ? "the map or view" : "the RPC", source.description()));
    }
}

} // namespace

geometry::PairGeometry read_geometry(const std::string& path, const Job& job)
{
    try {
        geometry::PairGeometry pair = geometry::pair_geometry_from_json(text_of(path));
        check_model(job.left, job.satellite->search, pair.left, path);
        check_model(job.right, job.satellite->search, pair.right, path);
        return pair;
    } catch (const geometry::GeometryError& error) {
        throw io::InputError(fmt::format("{}: {}", path, error.what()));
    }
}

std::pair<geometry::ImageCorrection, geometry::ImageCorrection>
read_corrections(const std::string& path, const Job& job)
{
    try {
        const auto stored = geometry::pair_geometry_from_json(text_of(path));
        return {correction_of(job.left, job.satellite->search, stored, path),
                correction_of(job.right, job.satellite->search, stored, path)};
    } catch (const geometry::GeometryError& error) {
        throw io::InputError(fmt::format("{}: {}", path, error.what()));
    }
}

void take_kept_geometry(Job& job, const RunManner& manner)
{
    const bool goes_on = manner.resume || manner.shard || manner.stage != RunStage::all;
    if (!job.satellite || manner.restart || !goes_on) {
        return;
    }
    const RunLayout layout{manner.folder};
    for (const auto& file : {kept_file(layout), layout.root / kFileName}) {
        if (std::filesystem::exists(file)) {
            job.satellite->stored = file.string();
            return;
        }
    }
}

void keep_geometry(const Job& job, const RunLayout& layout)
{
    if (!job.satellite) {
        return;
    }
    const std::string found = to_json(*job.satellite->pair);
    const std::filesystem::path file = kept_file(layout);
    if (!std::filesystem::exists(file)) {
        std::filesystem::create_directories(layout.work());
        io::write_text_file(file.string(), found);
    } else if (text_of(file.string()) != found) {
        throw io::StorageError(fmt::format(
            "{} was written by another process of this run while this one looked for the "
            "geometry itself, and found another one; start this one again, it then reads it",
            file.string()));
    }
}

void publish_geometry(const Job& job, const RunLayout& layout)
{
    if (job.satellite) {
        io::write_text_file((layout.root / kFileName).string(), to_json(*job.satellite->pair));
    }
}

} // namespace hsgm::pipeline
