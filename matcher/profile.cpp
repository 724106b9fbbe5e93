#include "matcher/profile.h"

#include <array>
#include <stdexcept>
#include <string>
#include <utility>

namespace hsgm::matcher {

namespace {

constexpr std::array<std::pair<Profile, std::string_view>, 3> kProfiles{{
    {Profile::satellite, "satellite"},
    {Profile::aerial, "aerial"},
    {Profile::close, "close"},
}};

} // namespace

Options options_of(Profile profile)
{
    Options o;
    switch (profile) {
    case Profile::satellite:
        break;
    case Profile::aerial:
        o.p2_half_tone = 10;
        break;
    case Profile::close:
        o.cost = Cost::pairs_bt;
        o.p1 = 20;
        o.paths = 4;
        break;
    }
    return o;
}

std::string_view name(Profile profile)
{
    for (const auto& [entry, text] : kProfiles) {
        if (entry == profile) {
            return text;
        }
    }
    return "?";
}

Profile profile_from_name(std::string_view name)
{
    std::string allowed;
    for (const auto& [entry, text] : kProfiles) {
        if (text == name) {
            return entry;
        }
        allowed += (allowed.empty() ? "" : ", ") + std::string(text);
    }
    throw std::invalid_argument("profile must be one of " + allowed + ", not '" +
                                std::string(name) + "'");
}

} // namespace hsgm::matcher
