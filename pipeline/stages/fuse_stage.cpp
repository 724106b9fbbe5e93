#include "pipeline/stages/fuse_stage.h"

#include "io/error.h"
#include "pipeline/stages/dsm_stage.h"
#include "pipeline/stages/ordered_pieces.h"
#include "pipeline/stages/satellite_stage.h"
#include "pipeline/stages/surface_stage.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

namespace hsgm::pipeline {

namespace {

using evaluate::SurfaceShift;
using geometry::GroundLattice;

/// Of a cell or the frames' step, whichever is larger: surfaces so far apart disagree.
constexpr double kGap = 2.0;
/// Likewise: points that lie closer together make a pair no surer.
constexpr double kSpreadFloor = 0.2;

void require_one_grid(const std::vector<FinishedPair>& pairs,
                      const std::vector<DsmOptions>& how)
{
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (how[i].map_wkt != how[0].map_wkt || how[i].cells.cell_m != how[0].cells.cell_m) {
            throw io::ConfigError(fmt::format(
                "the pairs {} and {} cannot be fused: their DSMs have cells of {:g} m in {} "
                "and "
                "of {:g} m in {}; run them with the same dsm.gsd_m, dsm.crs and dsm.vertical",
                pairs[0].name, pairs[i].name, how[0].cells.cell_m,
                how[0].metadata.at("HSGM_MAP"), how[i].cells.cell_m,
                how[i].metadata.at("HSGM_MAP")));
        }
    }
    if (how[0].cells.map_units_per_m != 1) {
        throw io::ConfigError("pairs are fused on a map in metres, but dsm.crs is in degrees: "
                              "choose another one, and reproject the result with gdalwarp");
    }
}

/// How the surface of `pair` lies beside that of `base`; nothing where they do not meet.
std::optional<PairShift> shift_between(const FinishedPair& pair, const FinishedPair& base)
{
    SurfaceQuestion question;
    question.inputs.test = pair.job.outputs.dsm.string();
    question.inputs.reference = base.job.outputs.dsm.string();
    try {
        const SurfaceAnswer answer = score_surface(question);
        return PairShift{pair.name, answer.shift, answer.horizontal, answer.all.nmad_m};
    } catch (const io::InputError&) {
        return std::nullopt;
    }
}

SurfaceShift sum(const SurfaceShift& a, const SurfaceShift& b, double factor = 1)
{
    return {a.east + factor * b.east, a.north + factor * b.north, a.up + factor * b.up};
}

/// The shifts against the first pair, each by way of the first of those before that it meets.
std::vector<PairShift> shifts_of(const std::vector<FinishedPair>& pairs)
{
    std::vector<std::optional<PairShift>> found(pairs.size());
    found[0] = PairShift{pairs[0].name, {}, true, 0};
    for (bool more = true; more;) {
        more = false;
        for (std::size_t i = 1; i < pairs.size(); ++i) {
            for (std::size_t base = 0; base < pairs.size() && !found[i]; ++base) {
                if (found[base]) {
                    check_stop();
                    found[i] = shift_between(pairs[i], pairs[base]);
                    if (found[i]) {
                        found[i]->shift_m = sum(found[i]->shift_m, found[base]->shift_m);
                        more = true;
                    }
                }
            }
        }
    }
    std::vector<PairShift> shifts;
    SurfaceShift mean;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (!found[i]) {
            throw io::InputError(fmt::format("the surface of pair {} meets none of the others, "
                                             "so it cannot be laid on them; leave it out",
                                             pairs[i].name));
        }
        shifts.push_back(*found[i]);
        mean = sum(mean, shifts.back().shift_m, 1.0 / static_cast<double>(pairs.size()));
    }
    for (PairShift& shift : shifts) {
        shift.shift_m = sum(shift.shift_m, mean, -1);
    }
    return shifts;
}

/// The lattice whose points lie where the shift is taken out: interpolation keeps sums.
GroundLattice moved(const GroundLattice& ground, const SurfaceShift& shift)
{
    geometry::Lattice nodes = ground.nodes();
    constexpr std::size_t kPerLayer = 4; // x, y, height, residual
    for (std::size_t i = 0; i + kPerLayer <= nodes.values().size(); i += kPerLayer) {
        nodes.values()[i] -= shift.east;
        nodes.values()[i + 1] -= shift.north;
        nodes.values()[i + 2] -= shift.up;
    }
    return {std::move(nodes), ground.disparity_min_px(), ground.disparity_max_px(),
            ground.error_m()};
}

/// A pair's points where they belong.
struct LaidPair {
    LaidPair(const FinishedPair& pair, const PairShift& shift, const CellManner& manner)
        : ground(moved(pair.job.satellite->pair->ground, shift.shift_m)),
          match(matched_pair(pair.job))
    {
        match.ground = &ground;
        cells = std::make_unique<PairCells>(match, manner, survey_pair(match));
    }
    GroundLattice ground;
    MatchedPair match;
    std::unique_ptr<PairCells> cells;
};

double largest_step_m(const std::vector<FinishedPair>& pairs, double cell_m)
{
    for (const FinishedPair& pair : pairs) {
        cell_m = std::max(cell_m, pair.job.satellite->pair->frame.gsd_m);
    }
    return cell_m;
}

} // namespace

FuseSummary fuse_pairs(const std::vector<FinishedPair>& pairs, const OutputPaths& outputs)
{
    std::vector<DsmOptions> how;
    for (const FinishedPair& pair : pairs) {
        how.push_back(dsm_options(pair.job));
    }
    require_one_grid(pairs, how);
    DsmOptions options = how.front();
    options.metadata["HSGM_PAIRS"] = std::to_string(pairs.size());
    options.metadata.erase("HSGM_DISPARITY"); // each pair has its own, and perhaps
    options.metadata.erase("HSGM_PENALTIES");
    options.creation_options = outputs.creation_options;
    FuseSummary summary;
    summary.pairs = shifts_of(pairs);
    std::vector<std::unique_ptr<LaidPair>> laid;
    dsm::Bounds bounds;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        laid.push_back(std::make_unique<LaidPair>(pairs[i], summary.pairs[i], options.cells));
        bounds.include(laid.back()->cells->bounds());
    }
    const dsm::DsmGrid grid = grid_over(bounds, options.cells, "the pairs");
    CellRasters rasters(grid, options,
                        {{},
                         {},
                         outputs.dsm,
                         outputs.dsm_confidence,
                         outputs.dsm_points,
                         outputs.dsm_spread,
                         outputs.dsm_reasons,
                         outputs.dsm_pairs});
    const auto blocks = CellRasters::blocks_of(grid);
    const double step_m = largest_step_m(pairs, options.cells.cell_m);
    in_order(
        blocks.size(),
        [&](std::size_t i) {
            std::vector<ReasonedCells> of_pairs;
            for (const auto& pair : laid) {
                of_pairs.push_back(pair->cells->block(grid, blocks[i]));
            }
            auto fused = dsm::fuse(of_pairs, kGap * step_m, kSpreadFloor * step_m);
            remove_uncertain(fused, options.cells.min_confidence);
            return fused;
        },
        [&](std::size_t i, const dsm::FusedCells& cells) {
            rasters.write(blocks[i], cells.of);
            rasters.write_pairs(blocks[i], cells.pairs);
        });
    summary.dsm = rasters.finish();
    return summary;
}

std::int64_t fuse_bytes(const std::vector<FinishedPair>& pairs, int threads)
{
    constexpr std::int64_t kCellBytes = 4 + 4 + 1 + 1 + 1;
    std::int64_t block = 0;
    for (const FinishedPair& pair : pairs) {
        block = std::max(block, PairCells::bytes(CellRasters::kBlock,
                                                 pair.job.satellite->pair->frame.gsd_m,
                                                 dsm_options(pair.job).cells.cell_m));
    }
    const auto count = static_cast<std::int64_t>(pairs.size());
    return pieces_in_flight(threads) *
           (block + (count + 1) * CellRasters::kBlock.area() * kCellBytes);
}

} // namespace hsgm::pipeline
