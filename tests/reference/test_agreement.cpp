#include "tests/catch.h"

#include "matcher/reasons.h"
#include "tests/reference/themes.h"

using namespace hsgm::reference;

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
    CHECK(flat > pixels / 200);
    CHECK(found > pixels / 4);
    CHECK(found < pixels);
    for (const auto& [reason, name] : hsgm::matcher::kReasonNames) {
        INFO(name);
        // A run's reason, not the matcher's.
        CHECK(((reasons & reason) != 0) == (reason != hsgm::matcher::kFailedTile));
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

TEST_CASE("matcher and twin agree on thin images")
{
    compare(thin(), 250'000, 600);
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
