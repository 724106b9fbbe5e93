#include "tests/catch.h"

#include "matcher/host/coarse_start.h"
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

using Winners = tiling::Patch<std::int16_t>;

Winners coarse_winners(tiling::Size size, int winner)
{
    return Winners(rect_of(size), static_cast<std::int16_t>(winner));
}

// The range of a window over a whole coarse level.
DisparityRange range_over(const Winners& winners, const Rect& window, DisparityRange level)
{
    const tiling::Size size = winners.rect.size();
    return window_range(winner_medians(winners, size), size, window, level);
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
    auto coarse = coarse_winners({64, 64}, 20);
    const DisparityRange level{0, 255};
    // 2 * 20 - 4 .. 2 * 20 + 1 + 4 are 10 disparities; 16 with 3 more below and 3 above.
    CHECK(range_over(coarse, Rect{0, 0, 64, 64}, level) == DisparityRange{33, 48});
    for (int row = 8; row < 24; ++row) {
        for (int col = 8; col < 24; ++col) {
            coarse.at(row, col) = 40;
        }
    }
    // 36 .. 85 are 50; 64 with 7 more below.
    CHECK(range_over(coarse, Rect{0, 0, 64, 64}, level) == DisparityRange{29, 92});
    // A window elsewhere does not see them.
    CHECK(range_over(coarse, Rect{64, 64, 64, 64}, level) == DisparityRange{33, 48});
}

TEST_CASE("single outliers do not widen a window's range")
{
    auto coarse = coarse_winners({64, 64}, 20);
    coarse.at(5, 5) = 100;
    coarse.at(20, 20) = 0;
    CHECK(range_over(coarse, Rect{0, 0, 64, 64}, {0, 255}) == DisparityRange{33, 48});
}

TEST_CASE("a window's range stays inside its level's")
{
    CHECK(range_over(coarse_winners({32, 32}, 0), Rect{0, 0, 64, 64}, {0, 63}) ==
          DisparityRange{0, 15});
    CHECK(range_over(coarse_winners({32, 32}, 31), Rect{0, 0, 64, 64}, {0, 63}) ==
          DisparityRange{48, 63});
    CHECK(range_over(coarse_winners({32, 32}, -20), Rect{0, 0, 64, 64}, {-40, 23}) ==
          DisparityRange{-40, -25});
    // As wide as the level: the level's range itself, though no multiple of 16.
    CHECK(range_over(coarse_winners({32, 32}, 4), Rect{0, 0, 64, 64}, {0, 9}) ==
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

TEST_CASE("medians of winners are those of the whole level wherever a part has them")
{
    const tiling::Size size{23, 41};
    Winners winners(rect_of(size));
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            winners.at(row, col) = static_cast<std::int16_t>((row * 37 + col * 101) % 61 - 30);
        }
    }
    const auto whole = winner_medians(winners, size);
    REQUIRE(whole.rect == rect_of(size));
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            std::vector<std::int16_t> around;
            for (int r = row - 1; r <= row + 1; ++r) {
                for (int c = col - 1; c <= col + 1; ++c) {
                    around.push_back(winners.at(std::clamp(r, 0, size.rows - 1),
                                                std::clamp(c, 0, size.cols - 1)));
                }
            }
            std::nth_element(around.begin(), around.begin() + 4, around.end());
            CHECK(whole.at(row, col) == around[4]);
        }
    }
    for (const Rect part : {Rect{4, 7, 9, 20}, Rect{0, 0, 5, 41}, Rect{20, 30, 3, 11}}) {
        Winners cut(part);
        for (int row = part.row; row < part.row_end(); ++row) {
            std::copy_n(&winners.at(row, part.col), part.cols, &cut.at(row, part.col));
        }
        const auto medians = winner_medians(cut, size);
        CHECK(medians.rect.contains(part.row + 1, part.col + 1));
        for (int row = medians.rect.row; row < medians.rect.row_end(); ++row) {
            for (int col = medians.rect.col; col < medians.rect.col_end(); ++col) {
                CHECK(medians.at(row, col) == whole.at(row, col));
            }
        }
    }
}
