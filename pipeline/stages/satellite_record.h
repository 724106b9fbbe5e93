#pragma once

#include "pipeline/geometry/pair_geometry.h"
#include "pipeline/stages/dsm_stage.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace hsgm::pipeline {

/// What was found of a raw pair, in one line for people.
std::string describe_geometry(const geometry::PairGeometry& pair);

/// The same for run.json.
nlohmann::ordered_json geometry_json(const geometry::PairGeometry& pair);

/// A finished DSM, for run.json.
nlohmann::ordered_json dsm_json(const DsmSummary& dsm);

} // namespace hsgm::pipeline
