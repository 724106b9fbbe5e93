#include "pipeline/stages/geometry_search.h"

#include "io/error.h"
#include "pipeline/freed_memory.h"
#include "pipeline/geometry/disparity_bounds.h"
#include "pipeline/geometry/error.h"
#include "pipeline/geometry/tie_points.h"
#include "pipeline/stages/geometry_start.h"
#include "pipeline/stages/given_heights.h"
#include "pipeline/stages/height_search.h"
#include "pipeline/stages/pair_likeness.h"
#include "pipeline/stages/patch_ties.h"
#include "pipeline/stages/region_stage.h"
#include "pipeline/stages/resampled_source.h"
#include "pipeline/stages/sensor_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hsgm::pipeline {

namespace {

using geometry::EpipolarFrame;
using geometry::FrameOptions;
using geometry::FramePatch;
using geometry::HeightSpan;
using geometry::MapProjection;
using geometry::PairGeometry;
using geometry::Pointing;
using geometry::PointingModel;
using geometry::ReferenceSurface;
using geometry::ReliefSurface;
using geometry::TieGate;
using geometry::TiePoint;
using tiling::Image;
using tiling::Rect;
using tiling::Size;

/// Features are sought in images of at most about that size.
constexpr int kFeaturePx = 1024;
constexpr int kCoarseFeatures = 4000;
/// How much wider than the tie points the reduced images are searched, at least.
constexpr double kSearchDownM = 50;
constexpr double kSearchUpM = 100;

/// Step of the frame that is matched, of the images' ground sampling distance: a finer grid
/// than theirs makes the errors of fractions of a pixel smaller on the ground
/// (docs/geometry.md has the measurements).
constexpr double kFrameStep = 0.75;
/// Over relief: cells of the surface, of the parallax that the heights span, so that cubics
/// through four disparities hold; and what ground points may then be off, of a step.
constexpr double kCellsOfParallax = 3;
constexpr double kReliefTolerance = 0.02;
constexpr double kTolerance = 0.01;

/// What the frame shows round a region of interest, for the matcher's sake.
constexpr double kRegionMarginPx = 100;

class Search {
public:
    Search(const SensorImage& left, const SensorImage& right,
           const PairGeometryOptions& options)
        : left_(left, options), right_(right, options), options_(options), map_(find_map())
    {
        lay_relief(0);
    }

    PairGeometry run();
    /// Where the ground lies by the images alone.
    HeightSpan run_for_heights();
    /// What to add to a refusal where much of an image has no value; else empty.
    std::string word_on_masks() const;

private:
    void begin();
    MapProjection find_map() const;
    void lay_relief(double least_cell_m);
    void smooth_relief(bool known);
    ReferenceSurface surface_at(double level_m) const;
    HeightSpan heights_over(const ReferenceSurface& surface) const;
    geometry::Polygon region(const MapProjection& output, double margin_m) const;
    FrameOptions frame_options(double level_m, HeightSpan heights, double gsd_m) const;
    EpipolarFrame frame_at(double level_m, HeightSpan heights, double finer,
                           geometry::Polygon region = {}) const;
    DrawnPair draw_reduced(double level_m, HeightSpan heights, int coarser = 1) const;
    void find_rough_pointing();
    void find_heights();
    HeightSpan widened(HeightSpan heights) const;
    int feature_reduction() const;
    void find_pointing();
    PairGeometry finish();

    SensorView left_;
    SensorView right_;
    const PairGeometryOptions& options_;
    MapProjection map_;
    std::optional<ReliefSurface> relief_; // level_m_ and heights_ speak of its mean height
    int reduction_ = 1;
    double level_m_ = 0;
    HeightSpan heights_;     // as far as they are known
    HeightSpan tie_heights_; // of the bulk of the rough tie points
    Pointing rough_;
    std::optional<Pointing> pointing_;
    std::vector<std::string> warnings_;
};

MapProjection Search::find_map() const
{
    const HeightSpan heights = possible_heights(left_.model(), right_.model(), options_);
    const auto middle = middle_of(left_.model(), left_.size(), heights);
    if (!middle) {
        throw geometry::GeometryError(
            "the middle of the left image meets no ground: the RPC is that of another image");
    }
    return MapProjection::automatic(middle->longitude_deg, middle->latitude_deg);
}

/// The surface of the reference DEM, where there is one.
void Search::lay_relief(double least_cell_m)
{
    if (!options_.dem) {
        return;
    }
    const HeightSpan heights = possible_heights(left_.model(), right_.model(), options_);
    relief_ =
        relief_of(*options_.dem, map_, ground_box(left_.sensor(), right_.sensor(), options_),
                  pixel_of(*left_.camera(map_), left_.size(), heights), least_cell_m);
    if (relief_->covered < 1 && least_cell_m == 0) {
        warnings_.push_back(fmt::format(
            "the reference DEM has heights for {:.1f} % of what both images show; beyond them "
            "the surface that disparities count from goes on level",
            100 * relief_->covered));
    }
}

/// Makes the surface smoother where the heights found span much parallax.
void Search::smooth_relief(bool known)
{
    const EpipolarFrame frame = frame_at(level_m_, heights_, 1);
    const double parallax_m = (heights_.high_m - heights_.low_m) * frame.px_per_m * frame.gsd_m;
    if (kCellsOfParallax * parallax_m <= relief_->surface.step_m()) {
        return;
    }
    lay_relief(kCellsOfParallax * parallax_m);
    if (known) {
        heights_ = heights_round(*relief_, options_);
    } else {
        find_heights(); // over the new surface they are not quite the same
    }
}

ReferenceSurface Search::surface_at(double level_m) const
{
    return relief_ ? relief_->surface.lifted(level_m - relief_->surface.level_m())
                   : ReferenceSurface(level_m);
}

/// What the span of heights means where the surface has relief.
HeightSpan Search::heights_over(const ReferenceSurface& surface) const
{
    if (!relief_) {
        return heights_;
    }
    const double lift = surface.level_m() - relief_->surface.level_m();
    return {relief_->lowest_m + lift + heights_.low_m - level_m_,
            relief_->highest_m + lift + heights_.high_m - level_m_};
}

/// Convex and wider than what is wanted by `margin_m`; empty: everything.
geometry::Polygon Search::region(const MapProjection& output, double margin_m) const
{
    if (options_.region.empty()) {
        return {};
    }
    geometry::Polygon corners;
    for (const geometry::Polygon& ring : region_deg(options_.region, output)) {
        for (const geometry::MapPoint& corner : ring) {
            corners.push_back(map_.forward({corner.x, corner.y, level_m_}));
        }
    }
    return convex_hull(std::move(corners), margin_m);
}

FrameOptions Search::frame_options(double level_m, HeightSpan heights, double gsd_m) const
{
    FrameOptions options;
    options.gsd_m = gsd_m;
    options.below_m = std::min(heights.low_m - level_m, -1.0);
    options.above_m = std::max(heights.high_m - level_m, 1.0);
    return options;
}

EpipolarFrame Search::frame_at(double level_m, HeightSpan heights, double finer,
                               geometry::Polygon region) const
{
    FrameOptions how = frame_options(level_m, heights, options_.gsd_m);
    how.finer = finer;
    how.region = std::move(region);
    return geometry::make_epipolar_frame(*left_.camera(map_), left_.size(),
                                         *right_.camera(map_), right_.size(),
                                         surface_at(level_m), how);
}

/// The reduced images in a frame of their own, or one with pixels `coarser` times as wide.
DrawnPair Search::draw_reduced(double level_m, HeightSpan heights, int coarser) const
{
    const auto left = left_.reduced_camera(map_);
    const auto right = right_.reduced_camera(map_);
    const ReferenceSurface surface = surface_at(level_m);
    const auto frame = [&](double gsd_m) {
        return geometry::make_epipolar_frame(*left, left_.reduced_size(), *right,
                                             right_.reduced_size(), surface,
                                             frame_options(level_m, heights, gsd_m));
    };
    DrawnPair pair;
    pair.frame = frame(options_.gsd_m * reduction_);
    if (coarser > 1) {
        pair.frame = frame(pair.frame.gsd_m * coarser);
    }
    pair.left = left_.draw_reduced(pair.frame.left, pair.frame.size);
    pair.right = right_.draw_reduced(pair.frame.right, pair.frame.size);
    return pair;
}

/// Pixels of the images to one of those in which rough tie points are sought.
int Search::feature_reduction() const
{
    const Size left = left_.reduced_size();
    const Size right = right_.reduced_size();
    const int side = std::max({left.rows, left.cols, right.rows, right.cols});
    return reduction_ * tiling::ceil_div(side, kFeaturePx);
}

/// Features of the reduced images, over all heights at which they overlap.
void Search::find_rough_pointing()
{
    const int coarser = feature_reduction() / reduction_;
    const DrawnPair pair = draw_reduced(level_m_, heights_, coarser);
    // Given heights may be too narrow: look beside them, to be able to say so.
    const double beside_m = options_.heights ? heights_.high_m - heights_.low_m : 0;
    const TieGate gate{(heights_.low_m - beside_m - level_m_) * pair.frame.px_per_m - 2,
                       (heights_.high_m + beside_m - level_m_) * pair.frame.px_per_m + 2, 0,
                       options_.largest_pointing_px / feature_reduction() + 1};
    const auto points =
        geometry::match_features({0, 0, pair.left}, {0, 0, pair.right}, gate, kCoarseFeatures);
    std::vector<bool> agrees;
    const Pointing rough = geometry::estimate_pointing(
        pair.frame, points, right_.reduced_size(), PointingModel::shift, &agrees);
    std::vector<TiePoint> agreeing;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (agrees[i]) {
            agreeing.push_back(points[i]);
        }
    }
    if (options_.pointing) {
        geometry::ImageCorrection correction = rough.correction;
        correction.x_px *= reduction_;
        correction.y_px *= reduction_;
        right_.correct(correction);
        rough_ = rough;
        rough_.shift_px *= reduction_;
        rough_.correction = correction;
    }
    if (options_.heights) {
        warn_of_heights(*options_.heights, agreeing, pair.frame, level_m_, warnings_);
    }
    const auto bounds = geometry::bounds_of(agreeing);
    tie_heights_ = {level_m_ + bounds->min_px / pair.frame.px_per_m,
                    level_m_ + bounds->max_px / pair.frame.px_per_m};
}

HeightSpan Search::widened(HeightSpan span) const
{
    const double rise = span.high_m - span.low_m;
    const HeightSpan possible = heights_;
    return {std::max(span.low_m - std::max(kSearchDownM, rise / 2), possible.low_m),
            std::min(span.high_m + std::max(kSearchUpM, rise), possible.high_m)};
}

void Search::find_heights()
{
    HeightSearch found =
        search_heights(widened(tie_heights_), reduction_, [&](double level_m, HeightSpan span) {
            return draw_reduced(level_m, span);
        });
    heights_ = found.heights;
    if (!found.warning.empty()) {
        warnings_.push_back(std::move(found.warning));
    }
}

void Search::find_pointing()
{
    const EpipolarFrame frame = frame_at(level_m_, heights_, 1);
    const auto points = patch_points(left_, right_, frame, 1.5 * feature_reduction() + 1);
    pointing_ =
        geometry::estimate_pointing(frame, points, right_.size(), *options_.pointing, nullptr);
    right_.correct(pointing_->correction);
    *pointing_ = geometry::joined(rough_, *pointing_);
    for (const std::string& warning : pointing_->warnings) {
        warnings_.push_back("pointing: " + warning);
    }
}

PairGeometry Search::finish()
{
    const auto left = left_.camera(map_);
    const auto right = right_.camera(map_);
    const MapProjection output =
        options_.crs.empty() ? MapProjection::from_text(map_.text(), options_.vertical)
                             : MapProjection::from_text(options_.crs, options_.vertical);
    EpipolarFrame frame = frame_at(level_m_, heights_, kFrameStep);
    if (!options_.region.empty()) {
        frame = frame_at(level_m_, heights_, kFrameStep,
                         region(output, kRegionMarginPx * frame.gsd_m));
    }
    const tiling::DisparityRange disparity{
        static_cast<int>(std::floor((heights_.low_m - level_m_) * frame.px_per_m)),
        static_cast<int>(std::ceil((heights_.high_m - level_m_) * frame.px_per_m))};
    geometry::GroundLattice ground(
        frame, *left, *right, disparity.min, disparity.max,
        [&](const geometry::MapPoint& place) { return output.forward(map_.inverse(place)); },
        relief_ ? kReliefTolerance : kTolerance);
    ReferenceSurface surface = surface_at(level_m_);
    const HeightSpan heights = heights_over(surface);
    std::optional<geometry::Likeness> likeness;
    if (options_.likeness) {
        likeness = measure_likeness(left_, right_, frame, disparity);
    }
    return {left_.model(),    right_.model(),    map_.text(), output.text(), std::move(surface),
            std::move(frame), std::move(ground), disparity,   heights,       pointing_,
            likeness,         warnings_};
}

void Search::begin()
{
    const geometry::Overlap overlap = geometry::find_overlap(
        *left_.camera(map_), left_.size(), *right_.camera(map_), right_.size(),
        possible_heights(left_.model(), right_.model(), options_));
    level_m_ = relief_ ? relief_->surface.level_m() : overlap.level_m;
    heights_ = relief_            ? heights_round(*relief_, options_)
               : options_.heights ? *options_.heights
                                  : overlap.shared;
    const bool known = relief_ ? options_.above_dem.has_value() : options_.heights.has_value();
    if (!known || options_.pointing) {
        reduction_ = std::max(reduction_of(left_.size()), reduction_of(right_.size()));
        left_.reduce(reduction_);
        right_.reduce(reduction_);
        find_rough_pointing();
        give_back_freed_memory(); // the plan counts steps one by one
    }
    if (!known) {
        find_heights();
        give_back_freed_memory();
    }
    if (relief_) {
        smooth_relief(known);
    }
}

PairGeometry Search::run()
{
    begin();
    level_m_ = std::round((heights_.low_m + heights_.high_m) / 2);
    if (options_.pointing) {
        find_pointing();
        give_back_freed_memory();
    }
    return finish();
}

std::string Search::word_on_masks() const
{
    constexpr double kMuchShare = 0.8;
    if (std::min(left_.valid_share(), right_.valid_share()) > kMuchShare) {
        return "";
    }
    return fmt::format(
        "; {:.0f} % of the left image's and {:.0f} % of the right image's pixels "
        "are valid, the others nodata or masked",
        100 * left_.valid_share(), 100 * right_.valid_share());
}

HeightSpan Search::run_for_heights()
{
    begin();
    return heights_;
}

} // namespace

geometry::PairGeometry find_pair_geometry(const SensorImage& left, const SensorImage& right,
                                          const PairGeometryOptions& options)
{
    std::string word_on_masks;
    try {
        Search search(left, right, options);
        try {
            return search.run();
        } catch (const geometry::GeometryError&) {
            word_on_masks = search.word_on_masks();
            throw;
        }
    } catch (const geometry::GeometryError& error) {
        PairGeometryOptions without = options;
        without.heights.reset();
        throw io::InputError(
            fmt::format("{} and {}: {}{}{}", left.image.path, right.image.path, error.what(),
                        word_on_masks, word_on_heights(options.heights, [&] {
                            return Search(left, right, without).run_for_heights();
                        })));
    } catch (const std::invalid_argument& error) {
        throw io::ConfigError(error.what());
    }
}

} // namespace hsgm::pipeline
