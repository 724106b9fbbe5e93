#include "pipeline/stages/match_stage.h"

#include "io/error.h"
#include "io/hillshade.h"
#include "io/quicklook.h"
#include "io/raster_source.h"
#include "io/scratch_folder.h"
#include "pipeline/cuda_worker.h"
#include "pipeline/error.h"
#include "pipeline/stages/output_check.h"
#include "pipeline/stages/prepare_stage.h"
#include "pipeline/tile_graph.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace hsgm::pipeline {

namespace {

using matcher::Matcher;

// Levels kept on scratch disk: those of the match, and the one HMI is learnt from.
int levels_to_prepare(const matcher::PairShape& shape, const matcher::LevelPlan& levels,
                      const Job& job)
{
    const int hmi = job.matcher.cost == matcher::Cost::hmi ? matcher::hmi_level(shape) + 1 : 1;
    return std::max(levels.levels(), hmi);
}

void check_sizes(const io::RasterSource& left, const io::RasterSource& right)
{
    if (left.size().rows != right.size().rows) {
        throw io::InputError(fmt::format("a rectified pair has equal heights, but {} has {} "
                                         "rows and {} has {}; resample the "
                                         "pair to epipolar geometry first",
                                         left.description(), left.size().rows,
                                         right.description(), right.size().rows));
    }
}

std::filesystem::path folder_of(const std::filesystem::path& file)
{
    return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

// A matcher for planning: the table that cost hmi needs comes later and takes no part in it.
matcher::PairTraits planning_traits(const matcher::PairShape& shape)
{
    matcher::PairTraits pair;
    pair.shape = shape;
    pair.hmi = std::make_shared<matcher::HmiTable>();
    return pair;
}

matcher::PairTraits pair_traits(const PlannedJob& planned, const PreparedPair& prepared)
{
    matcher::PairTraits pair;
    pair.shape = planned.shape;
    pair.left_tone = prepared.left_tone();
    pair.right_tone = prepared.right_tone();
    if (planned.job.matcher.cost == matcher::Cost::hmi) {
        const auto images = prepared.read_whole(matcher::hmi_level(planned.shape));
        pair.hmi = matcher::solve_hmi_table(pair, planned.job.matcher, images.left.pixels,
                                            images.right.pixels);
    }
    return pair;
}

std::shared_ptr<const matcher::CoarseSolution> solve_coarse(const Matcher& matcher,
                                                            const PreparedPair& prepared)
{
    if (!matcher.plan().coarsest_whole) {
        return matcher.solve_coarse({}, {});
    }
    const auto images = prepared.read_whole(matcher.plan().levels() - 1);
    return matcher.solve_coarse(images.left.pixels, images.right.pixels);
}

TileTask read_tile(int tile, const tiling::TilePlan& plan, const Matcher& matcher,
                   const PreparedPair& prepared)
{
    TileTask task;
    task.index = tile;
    task.core = plan.core(tile);
    const auto support = matcher.support(task.core);
    for (int level = 0; level < matcher.plan().windowed_levels(); ++level) {
        task.images.push_back(prepared.read(level, support[static_cast<std::size_t>(level)]));
    }
    return task;
}

// What a stage has freed goes back to the system: the plan counts stages one by one, and the
// program otherwise keeps freed memory for the next tile.
void give_back_freed_memory()
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

void match_tiles(const PlannedJob& planned, const Matcher& matcher,
                 const PreparedPair& prepared, FirstPass& first_pass, const Progress& progress)
{
    const auto coarse = solve_coarse(matcher, prepared);
    give_back_freed_memory();
    const tiling::TilePlan plan(planned.shape.left, planned.budget.tile_size_px);
    const auto trouble = [](int tile, const std::string& why) {
        spdlog::warn("{}; {}", why,
                     tile < 0 ? "it takes no part in this run"
                              : fmt::format("tile {} was matched on the processor", tile));
    };
    const auto workers =
        make_workers(planned.devices, planned.budget, matcher, *coarse, trouble);
    int done = 0;
    TileSteps steps;
    steps.read = [&](int tile) { return read_tile(tile, plan, matcher, prepared); };
    steps.write = [&](int, const matcher::TileMatch& match) {
        first_pass.store(match);
        progress(++done, plan.count());
    };
    const auto sequence = tiling::tile_sequence(plan, planned.job.run.order);
    run_tiles(sequence, steps, workers, planned.budget.tiles_in_flight);
}

void run_first_pass(const PlannedJob& planned, const PreparedPair& prepared,
                    FirstPass& first_pass, const Progress& progress)
{
    {
        const Matcher matcher(pair_traits(planned, prepared), planned.job.matcher);
        match_tiles(planned, matcher, prepared, first_pass, progress);
    }
    give_back_freed_memory();
}

MatchSummary run_in_arena(const PlannedJob& planned, const Progress& progress)
{
    const Job& job = planned.job;
    FileSource left{io::RasterSource(job.left)};
    FileSource right{io::RasterSource(job.right)};
    const io::ScratchFolder scratch(folder_of(job.outputs.disparity));
    FirstPass first_pass(planned.shape, scratch.path());
    const PreparedPair prepared(left, right, planned.pyramid_levels, scratch.path());
    give_back_freed_memory();
    run_first_pass(planned, prepared, first_pass, progress);
    return refine_and_write(first_pass, prepared, planned.shape, job, planned.geo);
}

// Pictures for people, made from the finished rasters.
void write_pictures(const OutputPaths& outputs)
{
    const auto write = [](const std::filesystem::path& raster,
                          const std::filesystem::path& picture, io::QuicklookStyle style) {
        if (!picture.empty()) {
            io::QuicklookOptions options;
            options.style = style;
            io::write_quicklook_png(raster.string(), picture.string(), options);
        }
    };
    write(outputs.disparity, outputs.disparity_picture, io::QuicklookStyle::disparity);
    write(outputs.hillshade, outputs.hillshade_picture, io::QuicklookStyle::hillshade);
}

} // namespace

PlannedJob plan_job(const Job& job)
{
    const io::RasterSource left(job.left);
    const io::RasterSource right(job.right);
    check_sizes(left, right);
    check_outputs(job);
    PlannedJob planned;
    planned.job = job;
    planned.shape = {left.size(), right.size(), job.disparity};
    planned.geo = left.geo_reference();
    try {
        const Matcher matcher(planning_traits(planned.shape), job.matcher);
        planned.levels = matcher.plan();
        planned.pyramid_levels = levels_to_prepare(planned.shape, planned.levels, job);
        planned.budget = make_budget(matcher, job, planned.pyramid_levels);
        planned.devices = plan_devices(device_choice(job.run.device), matcher, planned.budget);
    } catch (const std::invalid_argument& error) {
        throw io::ConfigError(error.what());
    }
    return planned;
}

MatchSummary run_job(const PlannedJob& planned, const Progress& progress)
{
    const auto threads = static_cast<std::size_t>(planned.budget.threads);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    tbb::task_arena arena(planned.budget.threads);
    const MatchSummary summary = arena.execute([&] { return run_in_arena(planned, progress); });
    if (!planned.job.outputs.hillshade.empty()) {
        io::HillshadeOptions options;
        options.creation_options = planned.job.outputs.creation_options;
        io::write_hillshade(planned.job.outputs.height.string(),
                            planned.job.outputs.hillshade.string(), options);
    }
    write_pictures(planned.job.outputs);
    return summary;
}

} // namespace hsgm::pipeline
