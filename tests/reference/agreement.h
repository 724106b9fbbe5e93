#pragma once

#include "matcher/matcher.h"
#include "tests/reference/random_pair.h"
#include "tests/reference/refine.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace hsgm::reference {

/// Everything that a comparison of matcher and twin needs; a pure function of its seed
/// and theme.
struct Case {
    std::uint64_t seed = 0;
    RandomPair pair;
    DisparityRange asked;
    ToneEnds tone_left;
    ToneEnds tone_right;
    Options options;
    HmiCosts hmi;            ///< for cost `hmi` only
    std::vector<Rect> tiles; ///< partition the left image, as do the pieces
    std::vector<Rect> pieces;

    std::string describe() const;
};

/// Bounds of what a theme's cases look like; `vary` sets what the theme is about.
struct Theme {
    int most_side_px = 40;
    bool thin = false; ///< one side is six pixels at most
    /// Least and most disparities asked for; the range lies anywhere that the images allow.
    int least_count = 1;
    int most_count = 40;
    /// Keeps the twin quick: pixels x disparities x paths of level 0.
    std::int64_t most_work = 1'000'000;
    std::function<void(Random&, Options&)> vary = [](Random&, Options&) {};
};

Case random_case(std::uint64_t seed, const Theme& theme);

/// Cuts a rectangle into at most rows x cols parts at random lines.
std::vector<Rect> random_partition(Random& random, Size size, int most_rows, int most_cols);

matcher::PairTraits traits_of(const Case& c);
std::shared_ptr<const matcher::HmiTable> table_of(const HmiCosts& costs);

/// Empty where matcher and twin give the same bits; otherwise what differs first.
std::string difference(const Case& c);

} // namespace hsgm::reference
