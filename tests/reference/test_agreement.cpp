#include "tests/catch.h"

#include "matcher/reasons.h"
#include "tests/reference/agreement.h"

#include <cstdlib>
#include <string>
#include <utility>

using namespace hsgm::reference;

namespace {

/// Runs seeds first.. of a theme. HSGM_REFERENCE_SEED repeats a single one,
/// HSGM_REFERENCE_CASES sets how many there are.
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

/// True shifts, several windows and levels, ranges well above what pruning leaves.
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

/// Ranges far beyond what narrow images can meet.
Theme wide_ranges()
{
    Theme theme;
    theme.most_side_px = 20;
    theme.least_count = 200;
    theme.most_count = 2049;
    theme.most_work = 400'000;
    return theme;
}

/// Penalties whose path costs need sixteen bits, and the last ones that fit eight.
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

Theme defaults()
{
    Theme theme;
    theme.most_side_px = 150;
    theme.most_count = 64;
    theme.most_work = 4'000'000;
    theme.vary = [](Random&, Options& o) { o = Options{}; };
    return theme;
}

} // namespace

// Agreement says little where nothing happens.
TEST_CASE("random cases prune ranges, use the prior and meet every reason")
{
    int windows = 0;
    int pruned_windows = 0;
    int changes = 0; // of the range from one window to the next
    int flat = 0;
    int found = 0;
    int pixels = 0;
    std::uint16_t reasons = 0;
    for (std::uint64_t seed = 300'000; seed < 300'040; ++seed) {
        const Case c = random_case(seed, pruned());
        const MatchResult twin = match(c.pair.left, c.pair.right, c.asked, c.tone_left,
                                       c.tone_right, c.options, &c.hmi);
        const auto& cells = twin.levels[0].windows;
        for (std::size_t w = 0; w < cells.size(); ++w) {
            ++windows;
            pruned_windows += cells[w].range.count() < c.asked.count();
            changes += w > 0 && !(cells[w].range == cells[w - 1].range);
        }
        const RefineResult refined = refine(twin, c.asked, c.options);
        for (int row = 0; row < c.pair.left.rows(); ++row) {
            for (int col = 0; col < c.pair.left.cols(); ++col) {
                ++pixels;
                flat += c.options.prior && is_flat(twin.levels[0].pair, row, col);
                found += refined.confidence(row, col) > 0;
                reasons |= refined.reasons(row, col);
            }
        }
    }
    CHECK(pruned_windows > windows / 2);
    CHECK(changes > windows / 4);
    CHECK(flat > pixels / 100);
    CHECK(found > pixels / 4);
    CHECK(found < pixels);
    for (const auto& [reason, name] : hsgm::matcher::kReasonNames) {
        INFO(name);
        CHECK((reasons & reason) != 0);
    }
}

TEST_CASE("matcher and twin agree on tiny images")
{
    compare(tiny(), 100'000, 1000);
}

TEST_CASE("matcher and twin agree on small images, whatever the options")
{
    compare(small(), 200'000, 800);
}

TEST_CASE("matcher and twin agree where ranges are pruned")
{
    compare(pruned(), 300'000, 100);
}

TEST_CASE("matcher and twin agree on ranges wider than the images")
{
    compare(wide_ranges(), 400'000, 200);
}

TEST_CASE("matcher and twin agree on penalties beyond eight bits")
{
    compare(dear(), 500'000, 300);
}

TEST_CASE("matcher and twin agree on windows of mode hsgm")
{
    compare(of_mode(Mode::hsgm), 600'000, 150);
}

TEST_CASE("matcher and twin agree on mode hsgm-paper")
{
    compare(of_mode(Mode::hsgm_paper), 700'000, 100);
}

TEST_CASE("matcher and twin agree on mode sgm")
{
    compare(of_mode(Mode::sgm), 800'000, 100);
}

TEST_CASE("matcher and twin agree on mode local")
{
    compare(of_mode(Mode::local), 900'000, 100);
}

TEST_CASE("matcher and twin agree on default options")
{
    compare(defaults(), 1'000'000, 30);
}

// Not part of the default run: test_reference "[.long]".
TEST_CASE("matcher and twin agree on many thousands of cases", "[.long]")
{
    const std::pair<Theme, int> themes[] = {
        {tiny(), 20'000},
        {small(), 8'000},
        {pruned(), 1'000},
        {wide_ranges(), 2'000},
        {dear(), 4'000},
        {of_mode(Mode::hsgm), 2'000},
        {defaults(), 200},
        {of_mode(Mode::hsgm_paper), 1'000},
        {of_mode(Mode::sgm), 1'000},
        {of_mode(Mode::local), 1'000},
    };
    std::uint64_t first = 10'000'000;
    for (const auto& [theme, cases] : themes) {
        compare(theme, first, cases);
        first += 1'000'000;
    }
}
