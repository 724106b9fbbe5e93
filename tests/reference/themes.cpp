#include "tests/reference/themes.h"

#include "tests/catch.h"

#include <cstdlib>
#include <string>

namespace hsgm::reference {

Theme tiny()
{
    Theme theme;
    theme.most_side_px = 9;
    theme.most_count = 20;
    theme.most_work = 20'000;
    return theme;
}

Theme small()
{
    Theme theme;
    theme.most_work = 150'000;
    return theme;
}

Theme thin()
{
    Theme theme;
    theme.most_side_px = 60;
    theme.thin = true;
    theme.most_count = 60;
    theme.most_work = 60'000;
    theme.vary = [](Random& random, Options& o) {
        o.mode = random.one_of({Mode::hsgm, Mode::hsgm, Mode::hsgm_paper, Mode::local});
        o.levels = random.between(2, 5);
        o.window_px = 16;
    };
    return theme;
}

Theme pruned()
{
    Theme theme;
    theme.most_side_px = 90;
    theme.least_count = 40;
    theme.most_count = 120;
    theme.most_work = 1'500'000;
    theme.vary = [](Random& random, Options& o) {
        o.mode = Mode::hsgm;
        o.prune = true;
        o.levels = random.between(2, 4);
        o.window_px = random.one_of({16, 32});
        o.paths = random.one_of({4, 5, 8});
    };
    return theme;
}

Theme wide_ranges()
{
    Theme theme;
    theme.most_side_px = 20;
    theme.least_count = 200;
    theme.most_count = 2049;
    theme.most_work = 400'000;
    return theme;
}

Theme dear()
{
    Theme theme = small();
    theme.vary = [](Random& random, Options& o) {
        o.p2 = random.chance(30) ? random.between(190, 215) : random.between(0, 4000);
        o.p1 = random.between(0, o.p2);
    };
    return theme;
}

Theme of_mode(Mode mode)
{
    Theme theme;
    theme.most_side_px = 80;
    theme.most_count = 40;
    theme.most_work = 400'000;
    theme.vary = [mode](Random& random, Options& o) {
        o.mode = mode;
        o.window_px = random.one_of({16, 16, 32});
    };
    return theme;
}

Theme of_cost(Cost cost, int paths, bool wide)
{
    Theme theme;
    theme.most_count = 70;
    theme.most_work = 40'000;
    theme.vary = [cost, paths, wide](Random& random, Options& o) {
        o.cost = cost;
        o.paths = paths;
        o.p2 = wide ? random.between(300, 4000) : random.between(24, 192);
        o.p1 = random.between(0, 24);
    };
    return theme;
}

Theme defaults()
{
    Theme theme;
    theme.most_side_px = 150;
    theme.most_count = 64;
    theme.most_work = 4'000'000;
    theme.vary = [](Random&, Options& o) { o = Options{}; };
    return theme;
}

void compare(const Theme& theme, std::uint64_t first, int cases)
{
    if (const char* count = std::getenv("HSGM_REFERENCE_CASES")) {
        cases = std::atoi(count);
    }
    if (const char* seed = std::getenv("HSGM_REFERENCE_SEED")) {
        first = std::strtoull(seed, nullptr, 10);
        cases = 1;
    }
    for (int i = 0; i < cases; ++i) {
        const Case c = random_case(first + static_cast<std::uint64_t>(i), theme);
        const std::string found = difference(c);
        INFO(c.describe());
        CHECK(found == "");
    }
}

} // namespace hsgm::reference
