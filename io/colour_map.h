#pragma once

#include "io/png.h"

namespace hsgm::io {

/// The colour of `position` in [0, 1] (clamped) on the map "turbo": dark blue, cyan, green,
/// yellow, dark red. Polynomials of degree 5 after A. Mikhailov and R. Du, "Turbo, An Improved
/// Rainbow Colormap for Visualization", Google AI Blog, 2019.
Rgb turbo(double position);

} // namespace hsgm::io
