#include "pipeline/stages/plan_stage.h"

#include "io/error.h"
#include "io/raster_source.h"
#include "pipeline/stages/output_check.h"
#include "pipeline/stages/satellite_stage.h"

#include <fmt/format.h>

#include <algorithm>

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

// A matcher for planning: the table that cost hmi needs comes later and takes no part in it.
matcher::PairTraits planning_traits(const matcher::PairShape& shape)
{
    matcher::PairTraits pair;
    pair.shape = shape;
    pair.hmi = std::make_shared<matcher::HmiTable>();
    return pair;
}

} // namespace

PlannedJob plan_job(const Job& job)
{
    const io::RasterSource left(job.left);
    const io::RasterSource right(job.right);
    check_outputs(job);
    PlannedJob planned;
    planned.job = job;
    if (job.satellite) {
        plan_satellite(planned.job);
        const tiling::Size frame = planned.job.satellite->pair->frame.size;
        planned.shape = {frame, frame, planned.job.disparity};
    } else {
        check_sizes(left, right);
        planned.shape = {left.size(), right.size(), job.disparity};
        planned.geo = left.geo_reference();
    }
    try {
        const Matcher matcher(planning_traits(planned.shape), planned.job.matcher);
        planned.levels = matcher.plan();
        planned.pyramid_levels = levels_to_prepare(planned.shape, planned.levels, job);
        planned.budget = make_budget(matcher, planned.job, planned.pyramid_levels);
        planned.devices = plan_devices(device_choice(job.run.device), matcher, planned.budget);
    } catch (const std::invalid_argument& error) {
        throw io::ConfigError(error.what());
    }
    return planned;
}

} // namespace hsgm::pipeline
