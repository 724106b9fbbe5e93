#include "pipeline/time_estimate.h"

#include "matcher/kernel.h"
#include "pipeline/bench/measure.h"
#include "tiling/tile_plan.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>
#include <cmath>

namespace hsgm::pipeline {

namespace {

// Seconds a megapixel, of one thread, on a 2-core AMD EPYC (Zen 4, virtual) with a local disk.
constexpr double kReadSource = 0.03;   // both images: decoding, checksum, pyramid, scratch
constexpr double kResample = 0.30;     // of a raw pair, both images, into the frame
constexpr double kTileFiles = 0.02;    // support read, results stored
constexpr double kWriteRasters = 0.11; // compressing and writing all of a left pixel
constexpr double kGround = 1.1;        // of a raw pair: rays, cells, three more rasters
constexpr double kHillshade = 0.05;
constexpr double kProof = 0.05; // seam figure, SHA-256

// Each thread beyond the first one adds less than the first.
constexpr double kFurtherThread = 0.86;
// Time grows with the range to this power where windows search only what the coarser level
// found, and in proportion where they search all of it (docs/benchmarks.md).
constexpr double kPrunedGrowth = 0.14;

constexpr int kSide = 512;
constexpr int kMostDisparities = kSide / 4; // steeper hills are no pair
constexpr int kLeastDisparities = 16;
constexpr int kRounds = 3;

struct Calibration {
    double match_s_per_px = 0;
    double refine_s_per_px = 0;
    double coarse_s_per_cell = 0;
};

std::int64_t coarse_cells(const matcher::LevelPlan& plan)
{
    return plan.coarsest_whole ? plan.left_sizes.back().area() *
                                     matcher::padded_count(plan.ranges.back().count())
                               : 0;
}

matcher::Options calibration_options(const matcher::PairShape& shape, matcher::Options options)
{
    try {
        matcher::plan_levels(shape, options);
    } catch (const std::invalid_argument&) {
        options.levels = 0; // more than so small a scene can have
    }
    return options;
}

// Least of a few rounds: what disturbs a measurement makes it longer.
Calibration calibrate(const PlannedJob& planned)
{
    const int asked = planned.shape.asked.count();
    const int count = std::clamp(asked, kLeastDisparities, kMostDisparities);
    const double longer = static_cast<double>(std::max(asked, count)) / count;
    Calibration least{1e9, 1e9, 1e9};
    bench::on_threads(1, [&] {
        const auto pair = bench::render_pair("town", kSide, count);
        const auto options = calibration_options(pair.shape(), planned.job.matcher);
        const auto plan = matcher::plan_levels(pair.shape(), options.resolved());
        const auto pixels = static_cast<double>(pair.left.size().area());
        const auto cells = static_cast<double>(std::max<std::int64_t>(coarse_cells(plan), 1));
        for (int round = 0; round < kRounds; ++round) {
            const auto s = bench::match_in_memory(pair, options, 0).seconds;
            least.match_s_per_px = std::min(least.match_s_per_px, s.windows / pixels);
            least.refine_s_per_px = std::min(least.refine_s_per_px, s.second / pixels);
            least.coarse_s_per_cell = std::min(least.coarse_s_per_cell, s.coarse / cells);
        }
    });
    const bool pruned = planned.job.matcher.resolved().prune && planned.levels.levels() > 1;
    least.match_s_per_px *= std::pow(longer, pruned ? kPrunedGrowth : 1);
    return least;
}

// How much more than its share of the image a tile in the middle computes: windows that it
// shares with its neighbours, at every level.
double repeated_work(const PlannedJob& planned)
{
    const int side = planned.budget.tile_size_px;
    const tiling::Size size = planned.shape.left;
    if (side == 0 || (side >= size.rows && side >= size.cols)) {
        return 1;
    }
    const tiling::TilePlan tiles(size, side);
    const auto rule = matcher::support_rule(planned.job.matcher.resolved());
    const auto& plan = planned.levels;
    const auto work = [&](const tiling::Rect& core) {
        const auto support =
            tiling::tile_support(core, plan.left_sizes, plan.right_sizes, plan.ranges, rule);
        double sum = 0;
        for (std::size_t k = 0; k < static_cast<std::size_t>(plan.windowed_levels()); ++k) {
            sum += static_cast<double>(support[k].windows.area()) * plan.ranges[k].count();
        }
        return sum / static_cast<double>(core.area());
    };
    const double whole = work(rect_of(size));
    return whole > 0 ? work(tiles.core(tiles.count() / 2)) / whole : 1;
}

} // namespace

TimeEstimate estimate_time(const PlannedJob& planned)
{
    const Calibration measured = calibrate(planned);
    const Job& job = planned.job;
    const int threads =
        std::min(planned.budget.threads, static_cast<int>(tbb::info::default_concurrency()));
    const double crew = 1 + kFurtherThread * (threads - 1);
    const auto pixels = static_cast<double>(planned.shape.left.area());
    const double mpx = pixels / 1e6;
    const double both_mpx = mpx + static_cast<double>(planned.shape.right.area()) / 1e6;
    TimeEstimate t;
    t.match_ns_per_px = 1e9 * measured.match_s_per_px;
    t.refine_ns_per_px = 1e9 * measured.refine_s_per_px;
    // The two images are read side by side.
    t.prepare_s = both_mpx * (kReadSource + (job.satellite ? kResample : 0)) /
                  std::min(crew, 1 + kFurtherThread);
    t.coarse_s = measured.coarse_s_per_cell * static_cast<double>(coarse_cells(planned.levels));
    t.tiles_s =
        (pixels * measured.match_s_per_px * repeated_work(planned) + mpx * kTileFiles) / crew;
    t.assemble_s = (pixels * measured.refine_s_per_px + mpx * kWriteRasters) / crew +
                   mpx * kProof + (job.satellite ? mpx * kGround / crew : 0) +
                   (job.outputs.hillshade.empty() ? 0 : mpx * kHillshade);
    return t;
}

double TimeEstimate::part_s(const PlannedPart& part, const matcher::PairShape& shape) const
{
    if (part.stage != RunStage::tiles) {
        return part.stage == RunStage::coarse ? prepare_s : assemble_s;
    }
    return part.tiles == 0 ? 0
                           : coarse_s + tiles_s * static_cast<double>(part.rows.area()) /
                                            static_cast<double>(shape.left.area());
}

double TimeEstimate::side_by_side_s(const std::vector<PlannedPart>& parts,
                                    const matcher::PairShape& shape) const
{
    double longest = 0;
    for (const PlannedPart& part : parts) {
        if (part.stage == RunStage::tiles) {
            longest = std::max(longest, part_s(part, shape));
        }
    }
    return prepare_s + longest + assemble_s;
}

std::string rough_time(double seconds)
{
    if (seconds < 100) {
        return fmt::format("{:.0f} s", std::max(seconds, 1.0));
    }
    return seconds < 6000 ? fmt::format("{:.0f} min", seconds / 60)
                          : fmt::format("{:.1f} h", seconds / 3600);
}

} // namespace hsgm::pipeline
