#include "matcher/profile.h"

#include <algorithm>
#include <array>
#include <cmath>
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

void fit_penalties(Options& options, double unlike_share)
{
    constexpr double kAlike = 0.05;
    constexpr double kUnlike = 0.2;
    if (options.mode == Mode::hsgm_paper) {
        return;
    }
    const double part = std::clamp((unlike_share - kAlike) / (kUnlike - kAlike), 0.0, 1.0);
    const auto fitted = [&](int penalty, double least) {
        return static_cast<int>(std::lround(penalty * (least + (1 - least) * part)));
    };
    options.p1 = fitted(options.p1, 1.0 / 2);
    options.p2 = std::max(options.p1, fitted(options.p2, 1.0 / 4));
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
