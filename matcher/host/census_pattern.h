#pragma once

#include "matcher/options.h"

#include <vector>

namespace hsgm::matcher::host {

/// A pixel of a neighbourhood, seen from its centre.
struct Offset {
    int row;
    int col;
    bool operator==(const Offset&) const = default;
};

/// One bit of a census: whether the pixel at `less` is darker than the one at `more`, by more
/// than the census's tolerance.
struct CensusBit {
    Offset less;
    Offset more;
};

/// The bits of a census cost (docs/algorithm.md, section 3); none for other costs.
std::vector<CensusBit> census_bits(Cost cost);

} // namespace hsgm::matcher::host
