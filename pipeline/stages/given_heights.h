#pragma once

#include "pipeline/geometry/epipolar_frame.h"
#include "pipeline/geometry/overlap.h"
#include "pipeline/geometry/tie_points.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// Adds a warning with figures where many tie points (of a frame on a plane at `level_m`) lie
/// outside the heights that were given.
void warn_of_heights(const geometry::HeightSpan& given,
                     std::span<const geometry::TiePoint> points,
                     const geometry::EpipolarFrame& frame, double level_m,
                     std::vector<std::string>& warnings);

/// What to add to a refusal where heights were given, since they may be its cause: where the
/// ground lies by the images alone, which `find` finds out, or throws GeometryError. Empty
/// where none were given.
std::string word_on_heights(const std::optional<geometry::HeightSpan>& given,
                            const std::function<geometry::HeightSpan()>& find);

} // namespace hsgm::pipeline
