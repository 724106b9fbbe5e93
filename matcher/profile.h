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

std::string_view name(Profile profile);
/// The profile of that name; throws std::invalid_argument listing the names there are.
Profile profile_from_name(std::string_view name);

} // namespace hsgm::matcher
