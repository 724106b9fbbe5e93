#include "tests/catch.h"

#include "tests/seam/stereo.h"

#include <string>
#include <tuple>

using namespace hsgm;
using namespace hsgm::matcher;
using hsgm::seam::difference;
using hsgm::seam::Match;
using hsgm::seam::StereoPair;
using tiling::TileOrder;

namespace {

struct Tiling {
    int tile_size_px;
    TileOrder order;
};

std::string text(const Options& o)
{
    return std::string(name(o.mode)) + ", " + std::string(name(o.cost)) + ", paths " +
           std::to_string(o.paths) + ", levels " + std::to_string(o.levels) + ", prior " +
           std::to_string(o.prior) + ", prune " + std::to_string(o.prune);
}

// Every tiling gives the bits of the untiled match, in both passes.
void check_tilings(const StereoPair& pair, const Options& options,
                   std::initializer_list<Tiling> tilings)
{
    INFO(text(options));
    const Match match(pair, options);
    const seam::Whole untiled = match.match_all(0);
    const Refined refined = match.refine_all(untiled, 0);
    for (const auto& [tile_size_px, order] : tilings) {
        INFO("tiles of " << tile_size_px << " px");
        const seam::Whole tiled = match.match_all(tile_size_px, order);
        CHECK(difference(untiled, tiled) == "");
        CHECK(difference(refined, match.refine_all(tiled, tile_size_px)) == "");
    }
}

const StereoPair& small_city()
{
    static const StereoPair pair = seam::render(seam::city({150, 232}, 5));
    return pair;
}

Options of(Mode mode, Cost cost, int paths, int levels)
{
    Options options;
    options.mode = mode;
    options.cost = cost;
    options.paths = paths;
    options.levels = levels;
    return options;
}

} // namespace

TEST_CASE("the default match of a city is the same for every tiling")
{
    const StereoPair pair = seam::render(seam::city({300, 400}, 5));
    REQUIRE(pair.asked.min < 0);
    REQUIRE(pair.asked.max > 0);
    check_tilings(pair, Options{},
                  {{33, TileOrder::rows},
                   {64, TileOrder::columns},
                   {100, TileOrder::shuffled},
                   {256, TileOrder::reversed}});
}

TEST_CASE("mode hsgm is the same for every tiling, whatever its other options")
{
    for (const Cost cost : {Cost::census7x7, Cost::hmi}) {
        for (const int paths : {8, 16}) {
            for (const int levels : {0, 4}) {
                Options options = of(Mode::hsgm, cost, paths, levels);
                for (const bool prior : {true, false}) {
                    for (const bool prune : {true, false}) {
                        options.prior = prior;
                        options.prune = prune;
                        check_tilings(small_city(), options, {{100, TileOrder::shuffled}});
                    }
                }
            }
        }
    }
}

TEST_CASE("small odd tiles give the same bits in every mode")
{
    for (const Mode mode : {Mode::hsgm, Mode::hsgm_paper, Mode::sgm, Mode::local}) {
        Options options = of(mode, Cost::census7x7, 8, mode == Mode::hsgm ? 4 : 0);
        check_tilings(small_city(), options, {{33, TileOrder::shuffled}});
    }
}

TEST_CASE("the paper's mode is the same for every tiling")
{
    for (const Cost cost : {Cost::census7x7, Cost::hmi}) {
        for (const int paths : {8, 16}) {
            for (const int levels : {0, 4}) {
                check_tilings(small_city(), of(Mode::hsgm_paper, cost, paths, levels),
                              {{100, TileOrder::shuffled}, {64, TileOrder::reversed}});
            }
        }
    }
}

TEST_CASE("modes local and sgm are the same for every tiling")
{
    for (const Mode mode : {Mode::local, Mode::sgm}) {
        for (const Cost cost : {Cost::census7x7, Cost::hmi}) {
            for (const int paths : {8, 16}) {
                check_tilings(small_city(), of(mode, cost, paths, 0),
                              {{100, TileOrder::shuffled}, {256, TileOrder::rows}});
            }
        }
    }
}

TEST_CASE("other costs, paths, windows and penalties keep the bits as well")
{
    Options options = of(Mode::hsgm, Cost::census5x5, 4, 2);
    options.window_px = 32;
    options.halo_px = 4;
    check_tilings(small_city(), options, {{45, TileOrder::shuffled}});
    options = of(Mode::hsgm, Cost::census9x7, 5, 3);
    options.halo_px = 0;
    options.median = 5;
    check_tilings(small_city(), options, {{90, TileOrder::shuffled}});
    options = of(Mode::hsgm, Cost::census7x7, 16, 3); // path costs of 16 bits
    options.p2 = 700;
    options.halo_px = 30;
    options.left_right_px = -1;
    check_tilings(small_city(), options, {{90, TileOrder::shuffled}});
    for (const Cost cost : matcher::all_costs()) {
        if (cost != Cost::hmi) { // above, with its table
            check_tilings(small_city(), of(Mode::hsgm, cost, 8, 3),
                          {{70, TileOrder::shuffled}});
        }
    }
}

TEST_CASE("checks, filters and made-up values keep the bits, however far they look")
{
    for (const auto& [speckle_px, fill, fill_px] : {std::tuple{0, Fill::none, 1},
                                                    {3, Fill::all, 5},
                                                    {60, Fill::occluded, 256},
                                                    {500, Fill::all, 40}}) {
        for (const Subpixel subpixel : {Subpixel::census, Subpixel::sums}) {
            Options options;
            options.levels = 3;
            options.speckle_px = speckle_px;
            options.speckle_range_px = speckle_px == 60 ? 3 : 1;
            options.min_confidence = speckle_px == 3 ? 0 : 170;
            options.median = speckle_px == 60 ? 5 : 3;
            options.fill = fill;
            options.fill_px = fill_px;
            options.subpixel = subpixel;
            INFO(speckle_px << " px, " << name(fill) << ", " << name(subpixel));
            check_tilings(small_city(), options,
                          {{33, TileOrder::shuffled}, {100, TileOrder::rows}});
        }
    }
}

TEST_CASE("the second pass refuses less than it depends on")
{
    const StereoPair& pair = small_city();
    const Match match(pair, Options{});
    const seam::Whole whole = match.match_all(0);
    RefineInput input;
    input.disparity_q8.rect = input.confidence.rect = input.reasons.rect =
        rect_of(pair.left.size());
    input.disparity_q8.pixels = whole.disparity_q8;
    input.confidence.pixels = whole.confidence;
    input.reasons.pixels = whole.reasons;
    input.right_keys.rect = rect_of(pair.right.size());
    input.right_keys.pixels = whole.right_keys;
    const tiling::Rect piece{10, 20, 30, 40};
    CHECK_THROWS_WITH(refine(piece, input, pair.shape(), Options{}),
                      Catch::Contains("the left image"));
    Options options;
    options.subpixel = Subpixel::sums;
    CHECK_NOTHROW(refine(piece, input, pair.shape(), options));
    input.right_keys = {};
    CHECK_THROWS_WITH(refine(piece, input, pair.shape(), options), Catch::Contains("keys"));
}

TEST_CASE("right images of another width and far ranges keep the bits")
{
    for (const auto& [cols, asked] :
         {std::pair{90, tiling::DisparityRange{-30, 140}}, {300, {-150, -20}}, {200, {9, 9}}}) {
        const StereoPair pair = seam::noise({100, 170}, cols, asked, 3);
        Options options;
        options.window_px = 32;
        check_tilings(pair, options, {{50, TileOrder::shuffled}, {33, TileOrder::reversed}});
    }
}
