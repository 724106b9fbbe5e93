#include "pipeline/stages/surface_stage.h"

#include "io/error.h"
#include "io/geotiff_writer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>

namespace hsgm::pipeline {

namespace {

using evaluate::ShiftFit;
using evaluate::SurfaceScorer;
using evaluate::SurfaceShift;

constexpr int kMostRounds = 30;
constexpr double kSteepest = 1;         // 45 degrees
constexpr double kOutlier = 3;          // in NMAD
constexpr double kLeastLimit_m = 0.001; // a bin of the histogram, where there is no noise
constexpr double kStill = 0.002;        // of a cell: what a last round may still move

SurfaceScorer scorer_of(const std::vector<double>& thresholds_m)
{
    try {
        return SurfaceScorer(thresholds_m);
    } catch (const std::invalid_argument& refused) {
        throw io::ConfigError(refused.what());
    }
}

bool contains(const std::vector<int>& classes, int value)
{
    return std::find(classes.begin(), classes.end(), value) != classes.end();
}

/// The cells that a fit looks at: gentle slopes of the classes asked for, their neighbours in
/// the row likewise, so that no slope is that of a wall.
template <typename Visit>
void for_each_aligned(const SurfaceRow& row, const std::vector<int>& classes, Visit visit)
{
    const auto usable = [&](std::size_t i) {
        return row.counts[i] != 0 && (classes.empty() || contains(classes, row.classes[i]));
    };
    for (std::size_t i = 1; i + 1 < row.counts.size(); ++i) {
        const float east = row.slope_east[i];
        const float north = row.slope_north[i];
        if (usable(i) && usable(i - 1) && usable(i + 1) && !std::isnan(row.difference_m[i]) &&
            std::hypot(east, north) <= kSteepest) {
            visit(row.difference_m[i], east, north);
        }
    }
}

class Aligner {
public:
    Aligner(SurfaceRows& rows, const SurfaceQuestion& question)
        : rows_(rows), question_(question)
    {
    }

    void align(SurfaceAnswer& answer)
    {
        bool horizontal = question_.alignment == Alignment::shift;
        while (answer.rounds < kMostRounds) {
            ++answer.rounds;
            const ShiftFit fit = fit_left(answer.shift);
            const auto whole = horizontal ? fit.shift() : std::nullopt;
            horizontal = whole.has_value();
            const SurfaceShift step = whole.value_or(SurfaceShift{0, 0, fit.up().value_or(0)});
            answer.aligned_cells = fit.cells();
            answer.weakest_slope = fit.weakest_slope();
            answer.shift.east += step.east;
            answer.shift.north += step.north;
            answer.shift.up += step.up;
            if (std::hypot(answer.shift.east, answer.shift.north) > furthest_m()) {
                // It runs away; from its own place, then, and in height alone.
                answer.shift = {};
                horizontal = false;
                continue;
            }
            const double still_m = kStill * rows_.cell_m();
            if (std::hypot(step.east, step.north) < still_m && std::abs(step.up) < still_m) {
                break;
            }
        }
        answer.horizontal = horizontal;
        if (answer.aligned_cells == 0) {
            throw io::InputError("no cell of " + question_.inputs.reference +
                                 " can be compared with " + question_.inputs.test +
                                 ": check that they overlap, the mask and the classes");
        }
    }

private:
    double furthest_m() const
    {
        const tiling::Size size = rows_.size();
        return rows_.cell_m() * std::min(size.rows, size.cols) / 4;
    }

    // Over what is left when the test is moved back by `shift`.
    ShiftFit fit_left(const SurfaceShift& shift)
    {
        SurfaceScorer errors;
        rows_.for_each(shift, [&](const SurfaceRow& row) {
            for_each_aligned(row, question_.aligned_on,
                             [&](float difference, float, float) { errors.add(difference); });
        });
        const double limit_m = std::max(kOutlier * errors.nmad_m(), kLeastLimit_m);
        ShiftFit fit(errors.median_m(), limit_m);
        rows_.for_each(shift, [&](const SurfaceRow& row) {
            for_each_aligned(row, question_.aligned_on,
                             [&](float difference, float east, float north) {
                                 fit.add(difference, east, north);
                             });
        });
        return fit;
    }

    SurfaceRows& rows_;
    const SurfaceQuestion& question_;
};

std::optional<io::GeoTiffWriter> difference_writer(const SurfaceRows& rows,
                                                   const std::string& path)
{
    if (path.empty()) {
        return std::nullopt;
    }
    io::RasterOptions options;
    options.nodata = std::numeric_limits<float>::quiet_NaN();
    options.geo = rows.geo_reference();
    options.unit = "metre";
    options.band_descriptions = {"test - reference, after co-registration"};
    return io::GeoTiffWriter(path, rows.size(), io::PixelType::float32, options);
}

void validate(const SurfaceQuestion& question)
{
    if (!question.aligned_on.empty() && question.inputs.classes.empty()) {
        throw io::ConfigError("--align-classes needs --classes");
    }
    if (!question.aligned_on.empty() && question.alignment == Alignment::none) {
        throw io::ConfigError("--align-classes and --align none contradict each other");
    }
}

} // namespace

SurfaceAnswer score_surface(const SurfaceQuestion& question)
{
    validate(question);
    SurfaceScorer all = scorer_of(question.thresholds_m);
    SurfaceRows rows(question.inputs);
    auto writer = difference_writer(rows, question.difference);
    SurfaceAnswer answer;
    if (question.alignment != Alignment::none) {
        Aligner(rows, question).align(answer);
    }
    std::map<int, SurfaceScorer> classes;
    rows.for_each(answer.shift, [&](const SurfaceRow& row) {
        for (std::size_t i = 0; i < row.counts.size(); ++i) {
            if (row.counts[i] == 0) {
                continue;
            }
            all.add(row.difference_m[i]);
            if (!row.classes.empty()) {
                const int value = row.classes[i];
                classes.try_emplace(value, question.thresholds_m)
                    .first->second.add(row.difference_m[i]);
            }
        }
        if (writer) {
            const tiling::Size size{1, rows.size().cols};
            const tiling::ImageView<const float> view(row.difference_m.data(), size, size.cols);
            writer->write({row.row, 0, 1, size.cols}, view);
        }
    });
    answer.all = all.score();
    for (const auto& [value, scorer] : classes) {
        answer.classes.emplace_back(value, scorer.score());
    }
    if (writer) {
        writer->finish();
    }
    return answer;
}

} // namespace hsgm::pipeline
