#include "tests/catch.h"

#include "tests/reference/level.h"
#include "tests/unit/reference/images.h"

#include <cstdlib>

using namespace hsgm::reference;

namespace {

/// A pair of one row, with a ragged texture shifted by three pixels.
Image<std::uint16_t> ragged(int cols, int shift)
{
    Image<std::uint16_t> image({1, cols});
    for (int c = 0; c < cols; ++c) {
        image(0, c) = static_cast<std::uint16_t>((c + shift) * (c + shift) * 37 % 101);
    }
    return image;
}

LevelPair pair_of(const Image<std::uint16_t>& left, const Image<std::uint16_t>& right)
{
    return make_level_pair(left, right, {}, {}, Cost::census5x5, nullptr);
}

constexpr DisparityRange kFine{-4, 11};
constexpr DisparityRange kCoarse{-2, 5};
constexpr std::size_t kRightward = 0; // direction (0, 1)

} // namespace

TEST_CASE("the twin's path costs enter a window from the coarser level")
{
    Options options;
    options.mode = Mode::hsgm;
    options.cost = Cost::census5x5;
    options.window_px = 16;
    options.halo_px = 0;
    options.prior = false;
    options.prune = false;
    const auto left = ragged(40, 0);
    const auto right = ragged(40, 3);
    const Level coarse =
        solve_level(pair_of(reduced(left), reduced(right)), kCoarse, true, options, nullptr);
    const Level fine = solve_level(pair_of(left, right), kFine, false, options, &coarse);
    const auto& path = fine.paths[kRightward];
    CHECK(fine.windows.size() == 3);
    CHECK(fine.window_at(0, 15) == 0);
    CHECK(fine.window_at(0, 16) == 1);

    const int a = std::abs(left(0, 16) - left(0, 15));
    const PixelCosts entering = path_costs(
        fine.matching(0, 16), coarse_start(coarse.paths[kRightward](0, 7), kFine, 192, true),
        24, gradient_penalty(24, 192, 5, a));
    CHECK(path(0, 16) == entering);
    CHECK(path(0, 0) == fine.matching(0, 0));

    SECTION("eq. 3 compares the tones of both levels where a path enters")
    {
        options.mode = Mode::hsgm_paper;
        const Level paper = solve_level(pair_of(left, right), kFine, false, options, &coarse);
        const int across = std::abs(left(0, 16) - coarse.pair.left(0, 7));
        CHECK(paper.paths[kRightward](0, 16) ==
              path_costs(paper.matching(0, 16),
                         coarse_start(coarse.paths[kRightward](0, 7), kFine, 192, true), 24,
                         paper_penalty(24, 192, across)));
        const int along = std::abs(left(0, 17) - left(0, 16));
        CHECK(paper.paths[kRightward](0, 17) == path_costs(paper.matching(0, 17),
                                                           paper.paths[kRightward](0, 16), 24,
                                                           paper_penalty(24, 192, along)));
    }
    SECTION("a halo lets the path run up before it enters the core")
    {
        options.halo_px = 2;
        const Level haloed = solve_level(pair_of(left, right), kFine, false, options, &coarse);
        PixelCosts run = coarse_start(coarse.paths[kRightward](0, 6), kFine, 192, true);
        for (int c = 14; c <= 16; ++c) {
            run =
                path_costs(haloed.matching(0, c), run, 24,
                           gradient_penalty(24, 192, 5, std::abs(left(0, c) - left(0, c - 1))));
        }
        CHECK(haloed.paths[kRightward](0, 16) == run);
    }
    SECTION("a whole level has no windows to enter")
    {
        const Level whole = solve_level(pair_of(left, right), kFine, true, options, nullptr);
        CHECK(whole.paths[kRightward](0, 15) == path(0, 15));
        CHECK(whole.paths[kRightward](0, 16) == path_costs(fine.matching(0, 16), path(0, 15),
                                                           24,
                                                           gradient_penalty(24, 192, 5, a)));
    }
    SECTION("mode local starts afresh")
    {
        options.mode = Mode::local;
        const Level local = solve_level(pair_of(left, right), kFine, false, options, nullptr);
        CHECK(local.paths[kRightward](0, 16) == local.matching(0, 16));
        CHECK(local.paths[kRightward](0, 15) == path(0, 15));
    }
}

TEST_CASE("the twin's prior adds four at most to flat pixels and one to others")
{
    Options options;
    options.cost = Cost::census5x5;
    options.window_px = 16;
    options.prune = false;
    Image<std::uint16_t> left = ragged(32, 0);
    Image<std::uint16_t> right = ragged(32, 2);
    for (int c = 8; c < 20; ++c) {
        left(0, c) = 50;
        right(0, c) = 50;
    }
    left(0, 20) = 200;
    const Level coarse =
        solve_level(pair_of(reduced(left), reduced(right)), kCoarse, true, options, nullptr);
    const Level with = solve_level(pair_of(left, right), kFine, false, options, &coarse);
    options.prior = false;
    const Level without = solve_level(pair_of(left, right), kFine, false, options, &coarse);
    std::uint32_t most = 0;
    for (const int col : {10, 13, 17}) { // the first sees column 7, the last column 20
        const int shift = col == 13 ? 2 : 4;
        for (int d = kFine.min; d <= kFine.max; ++d) {
            CAPTURE(col, d);
            const std::uint32_t added =
                with.matching(0, col).at(d) - without.matching(0, col).at(d);
            CHECK(added == prior_at(coarse.priors(0, col / 2), d) >> shift);
            most = std::max(most, added << shift);
        }
    }
    CHECK(most == 16);
}

TEST_CASE("the twin's path costs are eight bits wide up to a sum of 255")
{
    Options options;
    options.p2 = 203;
    CHECK(has_eight_bits(options)); // 48 + 4 + 203
    options.p2 = 204;
    CHECK(!has_eight_bits(options));
    options.prior = false;
    CHECK(has_eight_bits(options));
    options.cost = Cost::census9x7;
    CHECK(!has_eight_bits(options));
}
