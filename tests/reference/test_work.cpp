// What the matcher says it worked through, against a count of the twin's windows.

#include "tests/catch.h"

#include "matcher/reduce.h"
#include "tests/reference/level.h"
#include "tests/reference/match.h"
#include "tests/reference/themes.h"

#include <tbb/global_control.h>

#include <algorithm>

using namespace hsgm::reference;
namespace matcher = hsgm::matcher;
namespace tiling = hsgm::tiling;
using matcher::MatchStatistics;

namespace {

// docs/algorithm.md, section 4, counted cell by cell.
MatchStatistics work_of_twin(const MatchResult& twin, const Options& asked)
{
    const Options options = with_mode_applied(asked);
    MatchStatistics work;
    for (std::size_t k = 0; k < twin.levels.size(); ++k) {
        const Level& level = twin.levels[k];
        const Size size = level.pair.left.size();
        const bool whole = k + 1 == twin.levels.size() && options.mode != Mode::local;
        const int halo = whole ? 0 : options.halo_px;
        for (const Window& window : level.windows) {
            ++work.windows;
            for (int row = 0; row < size.rows; ++row) {
                for (int col = 0; col < size.cols; ++col) {
                    const bool costed =
                        row >= window.core.row - halo && row < window.core.row_end() + halo &&
                        col >= window.core.col - halo && col < window.core.col_end() + halo;
                    work.cells += costed ? window.range.count() : 0;
                    for (const Step& step : directions(options.paths)) {
                        work.path_steps +=
                            path_region(window.core, step, halo, size).contains(row, col)
                                ? window.range.count()
                                : 0;
                    }
                }
            }
        }
    }
    return work;
}

// The images as the matcher takes them: every level whole.
std::vector<matcher::LevelImages> images_of(const Case& c, int levels)
{
    const auto lefts = pyramid(c.pair.left, levels);
    const auto rights = pyramid(c.pair.right, levels);
    std::vector<matcher::LevelImages> images(lefts.size());
    for (std::size_t k = 0; k < lefts.size(); ++k) {
        images[k].left.rect = tiling::rect_of(lefts[k].size());
        images[k].left.pixels = lefts[k];
        images[k].right.rect = tiling::rect_of(rights[k].size());
        images[k].right.pixels = rights[k];
    }
    return images;
}

MatchStatistics work_of_matcher(const Case& c)
{
    const matcher::Matcher m(traits_of(c), c.options);
    auto images = images_of(c, m.plan().levels());
    const auto coarse = m.solve_coarse(images.back().left.pixels, images.back().right.pixels);
    MatchStatistics work = work_of(*coarse);
    work += m.match_tile(tiling::rect_of(c.pair.left.size()), images, *coarse).work;
    return work;
}

void compare_work(const Theme& theme, std::uint64_t first, int cases)
{
    for (int i = 0; i < cases; ++i) {
        const Case c = random_case(first + static_cast<std::uint64_t>(i), theme);
        INFO(c.describe());
        const MatchResult twin = match(c.pair.left, c.pair.right, c.asked, c.tone_left,
                                       c.tone_right, c.options, &c.hmi);
        const MatchStatistics expected = work_of_twin(twin, c.options);
        const MatchStatistics counted = work_of_matcher(c);
        CHECK(counted.windows == expected.windows);
        CHECK(counted.cells == expected.cells);
        CHECK(counted.path_steps == expected.path_steps);
    }
}

} // namespace

TEST_CASE("the matcher counts the cells that the twin goes through")
{
    compare_work(tiny(), 2'100'000, 100);
    compare_work(small(), 2'200'000, 60);
    compare_work(pruned(), 2'300'000, 12);
}

TEST_CASE("the count of cells does not depend on the number of threads")
{
    const Case c = random_case(2'300'000, pruned());
    const MatchStatistics many = work_of_matcher(c);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    CHECK(work_of_matcher(c) == many);
}
