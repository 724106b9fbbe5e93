// What the matcher says it worked through, against a count of the twin's windows.

#include "tests/catch.h"

#include "tests/reference/themes.h"
#include "tests/reference/work.h"

#include <tbb/global_control.h>

using namespace hsgm::reference;
namespace matcher = hsgm::matcher;
namespace tiling = hsgm::tiling;
using matcher::MatchStatistics;

namespace {

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
    MatchStatistics work = matcher::work_of(*coarse);
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
        const Work expected = work_of(twin, c.options);
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
