#include "pipeline/pairs/fuse_runs.h"

#include "io/error.h"
#include "io/pending_file.h"
#include "pipeline/budget.h"
#include "pipeline/configuration.h"
#include "pipeline/error.h"
#include "pipeline/ledger/checksum.h"
#include "pipeline/stages/fuse_stage.h"
#include "pipeline/stages/pictures_stage.h"
#include "pipeline/stages/satellite_record.h"
#include "pipeline/stages/stored_geometry.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <utility>

namespace hsgm::pipeline {

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::int64_t kMiB = std::int64_t{1} << 20;
/// The program and its libraries, and GDAL's cache.
constexpr std::int64_t kBaseBytes = 96 * kMiB;

FinishedPair finished_pair(const fs::path& folder)
{
    const fs::path used = folder / "config.used.yaml";
    const fs::path geometry = folder / "geometry.json";
    if (!fs::exists(used) || !fs::exists(geometry) || !fs::exists(folder / "dsm.tif")) {
        throw io::ConfigError(
            fmt::format("{} holds no finished run of a raw pair: there must be "
                        "config.used.yaml, geometry.json and dsm.tif",
                        folder.string()));
    }
    auto document = io::ConfigDocument::load(used);
    // The folder may have moved since.
    document.set("output.folder", fmt::format("'{}'", fs::absolute(folder).string()));
    FinishedPair pair{folder.filename().string(), read_configuration(document).job};
    if (!pair.job.satellite) {
        throw io::ConfigError(fmt::format("{} is not a run of raw images", folder.string()));
    }
    pair.job.satellite->pair =
        std::make_shared<geometry::PairGeometry>(read_geometry(geometry.string(), pair.job));
    return pair;
}

std::vector<FinishedPair> finished_pairs(const std::vector<fs::path>& folders)
{
    std::vector<FinishedPair> pairs;
    for (const fs::path& folder : folders) {
        pairs.push_back(finished_pair(folder.lexically_normal().has_filename()
                                          ? folder.lexically_normal()
                                          : folder.lexically_normal().parent_path()));
    }
    std::sort(pairs.begin(), pairs.end(),
              [](const FinishedPair& a, const FinishedPair& b) { return a.name < b.name; });
    const auto twice = std::adjacent_find(
        pairs.begin(), pairs.end(),
        [](const FinishedPair& a, const FinishedPair& b) { return a.name == b.name; });
    if (twice != pairs.end()) {
        throw io::ConfigError(fmt::format(
            "two of the folders to be fused are named '{}': each needs a name of its own",
            twice->name));
    }
    if (pairs.size() < 2) {
        throw io::ConfigError("to fuse takes two finished pairs or more");
    }
    return pairs;
}

/// The surfaces that the result is made from.
ordered_json inputs_json(const std::vector<FinishedPair>& pairs)
{
    ordered_json inputs;
    for (const FinishedPair& pair : pairs) {
        const OutputPaths& o = pair.job.outputs;
        for (const auto& file : {o.disparity, o.confidence, o.reasons, o.dsm}) {
            inputs[pair.name][file.filename().string()] = ledger::sha256_of_file(file);
        }
    }
    return inputs;
}

bool is_done(const FuseRequest& request, const ordered_json& inputs)
{
    std::ifstream file(request.folder / "run.json");
    const auto record = file ? ordered_json::parse(file, nullptr, false) : ordered_json();
    const auto outputs = request.outputs.files();
    return request.resume && record.is_object() &&
           record.value("inputs", ordered_json()) == inputs &&
           std::all_of(outputs.begin(), outputs.end(),
                       [](const fs::path& path) { return fs::exists(path); });
}

ordered_json record_of(const FuseSummary& summary, const ordered_json& inputs,
                       const OutputPaths& outputs)
{
    ordered_json record{{"program", "hsgm " HSGM_VERSION}, {"inputs", inputs}};
    for (const PairShift& pair : summary.pairs) {
        record["pairs"].push_back({{"name", pair.name},
                                   {"shift_m",
                                    {{"east", pair.shift_m.east},
                                     {"north", pair.shift_m.north},
                                     {"up", pair.shift_m.up}}},
                                   {"horizontal", pair.horizontal},
                                   {"nmad_m", pair.nmad_m}});
    }
    record["dsm"] = dsm_json(summary.dsm);
    for (const auto& path : outputs.files()) {
        record["outputs"][path.filename().string()] = {
            {"bytes", fs::file_size(path)}, {"sha256", ledger::sha256_of_file(path)}};
    }
    return record;
}

void log_summary(const FuseSummary& summary, const OutputPaths& outputs)
{
    for (const PairShift& pair : summary.pairs) {
        spdlog::info(
            "{}: lay east {:+.2f} m, north {:+.2f} m, up {:+.2f} m of the mean of all{}",
            pair.name, pair.shift_m.east, pair.shift_m.north, pair.shift_m.up,
            pair.horizontal ? "" : " (the ground shows a shift in height alone)");
    }
    const dsm::DsmGrid& grid = summary.dsm.grid;
    spdlog::info("{}: {} x {} cells of {:g} from {} pairs, {:.1f} % of them with a height",
                 outputs.dsm.string(), grid.size.cols, grid.size.rows, grid.cell,
                 summary.pairs.size(),
                 100.0 * static_cast<double>(summary.dsm.cells_with_value) /
                     static_cast<double>(grid.size.area()));
}

void check_memory(const FuseRequest& request, const std::vector<FinishedPair>& pairs,
                  int threads)
{
    const std::int64_t needed = kBaseBytes + fuse_bytes(pairs, threads);
    const auto allowed = static_cast<std::int64_t>(
        request.memory_bytes.value_or(available_memory_bytes() / 5 * 4));
    if (needed > allowed) {
        throw BudgetError(fmt::format("to fuse {} pairs with {} threads needs {} MiB of "
                                      "memory, but may take {} MiB: allow "
                                      "more with --memory, or use fewer threads",
                                      pairs.size(), threads, needed / kMiB + 1,
                                      allowed / kMiB));
    }
}

} // namespace

OutputPaths fused_outputs(const fs::path& folder, bool hillshade, bool quicklooks)
{
    OutputPaths outputs;
    outputs.dsm = folder / "dsm.tif";
    outputs.dsm_confidence = folder / "dsm.confidence.tif";
    outputs.dsm_points = folder / "dsm.points.tif";
    outputs.dsm_spread = folder / "dsm.spread.tif";
    outputs.dsm_reasons = folder / "dsm.reasons.tif";
    outputs.dsm_pairs = folder / "dsm.pairs.tif";
    if (hillshade) {
        outputs.hillshade = folder / "hillshade.tif";
        if (quicklooks) {
            outputs.hillshade_picture = folder / "hillshade.png";
        }
    }
    return outputs;
}

void fuse_runs(const FuseRequest& request)
{
    const auto pairs = finished_pairs(request.runs);
    const ordered_json inputs = inputs_json(pairs);
    if (is_done(request, inputs)) {
        spdlog::info("{}: everything is done already", request.folder.string());
        return;
    }
    const int threads =
        request.threads > 0 ? request.threads : tbb::info::default_concurrency();
    check_memory(request, pairs, threads);
    std::error_code error;
    fs::create_directories(request.folder, error);
    if (error) {
        throw io::StorageError(fmt::format("cannot make the output folder {}: {}",
                                           request.folder.string(), error.message()));
    }
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    const FuseSummary summary = arena.execute([&] {
        FuseSummary fused = fuse_pairs(pairs, request.outputs);
        write_hillshade_of(request.outputs);
        write_pictures_of(request.outputs);
        return fused;
    });
    log_summary(summary, request.outputs);
    io::write_text_file((request.folder / "run.json").string(),
                        record_of(summary, inputs, request.outputs).dump(2) + "\n");
}

} // namespace hsgm::pipeline
