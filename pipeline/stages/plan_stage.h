#pragma once

#include "io/geo_reference.h"
#include "pipeline/budget.h"
#include "pipeline/device_plan.h"
#include "pipeline/job.h"

namespace hsgm::pipeline {

/// A job whose inputs were opened and found good, and whose budget is known.
struct PlannedJob {
    Job job;
    matcher::PairShape shape;
    matcher::LevelPlan levels;
    Budget budget;
    DevicePlan devices;
    io::GeoReference geo; ///< of a rectified left image; its rasters inherit it
    int pyramid_levels = 1;
};

/// Opens the inputs, checks everything that can be checked before the first pixel (exist,
/// sizes, range, outputs writable, memory) and plans. Throws InputError, ConfigError,
/// StorageError or BudgetError.
PlannedJob plan_job(const Job& job);

} // namespace hsgm::pipeline
