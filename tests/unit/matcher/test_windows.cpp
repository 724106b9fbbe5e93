#include "tests/catch.h"

#include "matcher/host/coarse_start.h"
#include "matcher/host/level_result.h"
#include "matcher/host/window_range.h"
#include "matcher/kernel.h"
#include "matcher/matcher.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <set>
#include <vector>

using namespace hsgm;
using namespace hsgm::matcher;
using namespace hsgm::matcher::host;
using tiling::DisparityRange;
using tiling::Rect;

namespace {

// A coarse level in one block, with winners as given.
LevelResult<std::uint8_t> coarse_level(tiling::Size size, int winner)
{
    LevelResult<std::uint8_t> level;
    level.size = size;
    level.windows = rect_of(size);
    auto& block = level.blocks.emplace_back();
    block.core = rect_of(size);
    block.winner = tiling::Image<std::int16_t>(size, static_cast<std::int16_t>(winner));
    return level;
}

std::vector<int> spread(const std::vector<int>& values, DisparityRange coarse,
                        DisparityRange fine, int fill)
{
    std::vector<int> scratch(static_cast<std::size_t>(fine.count() + 6));
    std::vector<int> out(static_cast<std::size_t>(fine.count() + 3));
    spread_disparities(values.data(), coarse, fine, fill, scratch.data(), out.data());
    out.resize(static_cast<std::size_t>(fine.count()));
    return out;
}

} // namespace

TEST_CASE("even disparities take their coarse value and odd ones the rounded mean of two")
{
    CHECK(spread({10, 20, 31}, {0, 2}, {0, 5}, 99) == std::vector{10, 15, 20, 26, 31, 65});
    CHECK(spread({10, 20, 31}, {0, 2}, {1, 4}, 99) == std::vector{15, 20, 26, 31});
}

TEST_CASE("spreading disparities works across zero and outside the searched range")
{
    // Coarse -2..0; fine -4..1 is all that has a value; disparity 1 lies between 0 and 1.
    CHECK(spread({8, 6, 4}, {-2, 0}, {-5, 2}, 50) == std::vector{29, 8, 7, 6, 5, 4, 27, 50});
    CHECK(spread({8, 6, 4}, {-2, 0}, {10, 12}, 50) == std::vector{50, 50, 50});
}

TEST_CASE("spreading follows its definition for any two ranges")
{
    for (int coarse_min = -4; coarse_min < 4; ++coarse_min) {
        const DisparityRange coarse{coarse_min, coarse_min + 4};
        const std::vector<int> values{3, 14, 15, 92, 65};
        const auto value = [&](int d) {
            return coarse.contains(d) ? values[static_cast<std::size_t>(d - coarse.min)] : 77;
        };
        for (int fine_min = -12; fine_min < 12; ++fine_min) {
            for (const int count : {1, 2, 7, 16}) {
                const DisparityRange fine{fine_min, fine_min + count - 1};
                const auto out = spread(values, coarse, fine, 77);
                for (int d = fine.min; d <= fine.max; ++d) {
                    const int below = tiling::floor_div(d, 2);
                    const int expected = d == 2 * below
                                             ? value(below)
                                             : (value(below) + value(below + 1) + 1) / 2;
                    CHECK(out[static_cast<std::size_t>(d - fine.min)] == expected);
                }
            }
        }
    }
}

TEST_CASE("a window searches round its coarse disparities, in whole groups of 16")
{
    auto coarse = coarse_level({64, 64}, 20);
    const DisparityRange level{0, 255};
    // 2 * 20 - 4 .. 2 * 20 + 1 + 4 are 10 disparities; 16 with 3 more below and 3 above.
    CHECK(window_range(coarse, Rect{0, 0, 64, 64}, level) == DisparityRange{33, 48});
    for (int row = 8; row < 24; ++row) {
        for (int col = 8; col < 24; ++col) {
            coarse.blocks[0].winner(row, col) = 40;
        }
    }
    // 36 .. 85 are 50; 64 with 7 more below.
    CHECK(window_range(coarse, Rect{0, 0, 64, 64}, level) == DisparityRange{29, 92});
    // A window elsewhere does not see them.
    CHECK(window_range(coarse, Rect{64, 64, 64, 64}, level) == DisparityRange{33, 48});
}

TEST_CASE("single outliers do not widen a window's range")
{
    auto coarse = coarse_level({64, 64}, 20);
    coarse.blocks[0].winner(5, 5) = 100;
    coarse.blocks[0].winner(20, 20) = 0;
    CHECK(window_range(coarse, Rect{0, 0, 64, 64}, {0, 255}) == DisparityRange{33, 48});
}

TEST_CASE("a window's range stays inside its level's")
{
    CHECK(window_range(coarse_level({32, 32}, 0), Rect{0, 0, 64, 64}, {0, 63}) ==
          DisparityRange{0, 15});
    CHECK(window_range(coarse_level({32, 32}, 31), Rect{0, 0, 64, 64}, {0, 63}) ==
          DisparityRange{48, 63});
    CHECK(window_range(coarse_level({32, 32}, -20), Rect{0, 0, 64, 64}, {-40, 23}) ==
          DisparityRange{-40, -25});
    // As wide as the level: the level's range itself, though no multiple of 16.
    CHECK(window_range(coarse_level({32, 32}, 4), Rect{0, 0, 64, 64}, {0, 9}) ==
          DisparityRange{0, 9});
}

TEST_CASE("lines are kept where the finer level's paths start")
{
    for (const int window : {16, 32, 64}) {
        for (const int halo : {0, 2, 8, 16}) {
            const StartLines lines{window, halo};
            for (const int step : {-2, -1, 1, 2}) {
                // What fine windows in the middle of an image start from, one by one.
                std::set<int> wanted;
                for (int first = 0; first < 20 * window; first += window) {
                    const int outside = step > 0 ? first - halo - 1 : first + window + halo;
                    wanted.insert(tiling::floor_div(outside, 2));
                }
                for (int line = window; line < 8 * window; ++line) {
                    INFO("window " << window << ", halo " << halo << ", step " << step
                                   << ", line " << line);
                    CHECK(lines.holds(line, step) == (wanted.count(line) == 1));
                    CHECK(lines.first(line, step) == *wanted.lower_bound(line));
                }
            }
            CHECK_FALSE(lines.holds(0, 0));
        }
    }
}

TEST_CASE("every kept pixel has a place of its own")
{
    const Rect core{64, 128, 64, 50};
    const int stride = 16;
    for (const Direction direction :
         {Direction{0, 1}, {0, -1}, {1, 0}, {-1, 0}, {1, -1}, {-1, 1}, {2, 1}, {-1, -2}}) {
        LineStore<std::uint8_t> store(core, direction, {64, 8}, stride);
        std::set<std::ptrdiff_t> places;
        std::size_t kept = 0;
        const std::uint8_t* least = nullptr;
        for (int row = core.row; row < core.row_end(); ++row) {
            for (int col = core.col; col < core.col_end(); ++col) {
                if (store.holds_row(row) || store.holds_col(col)) {
                    const std::uint8_t* place = store.at(row, col);
                    least = least == nullptr ? place : std::min(least, place);
                    places.insert(place - store.at(core.row, core.col));
                    ++kept;
                }
            }
        }
        CHECK(kept > 0);
        CHECK(places.size() == kept);
        CHECK((*places.rbegin() - *places.begin()) + stride <= store.bytes());
        for (auto at = places.begin(), next = std::next(at); next != places.end();
             ++at, ++next) {
            CHECK(*next - *at >= stride);
        }
    }
}

TEST_CASE("a sub-pixel value always tells its winner")
{
    for (const int d : {-300, -1, 0, 1, 17}) {
        for (int below = 0; below < 300; ++below) {
            for (const int above : {0, 1, 2, 100, 1000, 65000}) {
                CHECK(winner_of(subpixel_q8(d, below, 0, above)) == d);
            }
        }
    }
    CHECK(subpixel_q8(5, 40, 10, 40) == 5 * 256);
    CHECK(subpixel_q8(5, 7, 7, 7) == 5 * 256);
    CHECK(subpixel_q8(5, 10, 10, 90) == 5 * 256 - 127);
    CHECK(subpixel_q8(5, 90, 10, 10) == 5 * 256 + 128);
}

TEST_CASE("confidence is 1 to 255 and grows with the rival's distance")
{
    CHECK(confidence_of(100, 100) == 1);
    CHECK(confidence_of(0, 0) == 1);
    CHECK(confidence_of(0, 50) == 255);
    CHECK(confidence_of(50, 100) == 127);
}
