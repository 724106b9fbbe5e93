#pragma once

#include "pipeline/evaluate/confidence_score.h"

#include <nlohmann/json_fwd.hpp>

namespace hsgm::pipeline {

/// Curve, areas and calibration as a table for people.
void print_confidence(const evaluate::ConfidenceScore& score);

/// The same, and every class, for programs.
nlohmann::ordered_json confidence_json(const evaluate::ConfidenceScore& score);

} // namespace hsgm::pipeline
