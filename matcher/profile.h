#pragma once

#include "matcher/options.h"

#include <string>
#include <string_view>

namespace hsgm::matcher {

/// Sets of options for kinds of scenes: what an option is where nobody says otherwise.
/// docs/quality.md has the measurements they come from.
enum class Profile {
    satellite, ///< terrain and towns from afar; the defaults of Options
    aerial,    ///< cities from the air: roofs, deep shadows, large disparities
    close,     ///< textured things near by, in one exposure
};

Options options_of(Profile profile);

/// Makes `p1` and `p2` fit images that look alike: down to a half and a quarter of what they
/// are where no more than a twentieth of the matched windows correlates badly, and not at all
/// from a fifth on. Where the texture says clearly what belongs together, penalties only round
/// off what is small; where noise, haze or change leave little of it, they carry the result.
/// `unlike_share`: 0 to 1. Mode hsgm-paper, whose rule for p2 is another one, stays as it is.
void fit_penalties(Options& options, double unlike_share);

std::string_view name(Profile profile);
/// The profile of that name; throws std::invalid_argument listing the names there are.
Profile profile_from_name(std::string_view name);

} // namespace hsgm::matcher
