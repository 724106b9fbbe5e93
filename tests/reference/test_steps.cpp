#include "tests/catch.h"

#include "matcher/hmi.h"
#include "matcher/noise.h"
#include "matcher/reduce.h"
#include "tests/reference/agreement.h"
#include "tests/reference/hmi.h"

#include <algorithm>

using namespace hsgm::reference;
namespace matcher = hsgm::matcher;

namespace {

bool equal(const matcher::HmiTable& table, const HmiCosts& costs)
{
    return std::equal(costs.pixels().begin(), costs.pixels().end(), table.cost.begin());
}

} // namespace

TEST_CASE("matcher and twin agree on level plans")
{
    Random random(1);
    int most_levels = 0;
    for (int i = 0; i < 20000; ++i) {
        Options options;
        options.mode = random.one_of({Mode::hsgm, Mode::hsgm_paper, Mode::sgm, Mode::local});
        options.levels = random.chance(60) ? 0 : random.between(1, 12);
        const int most = random.one_of({40, 300, 3000, 10000}); // disparities stay within 16000
        matcher::PairShape shape;
        shape.left = {random.between(1, most), random.between(1, most)};
        shape.right = {shape.left.rows, random.between(1, most)};
        const int count = random.between(1, random.one_of({1, 64, 4096}));
        shape.asked.min =
            random.between(-(shape.right.cols - 1) - (count - 1), shape.left.cols - 1);
        shape.asked.max = shape.asked.min + count - 1;

        const matcher::LevelPlan plan = matcher::plan_levels(shape, options);
        const int levels = level_count(shape.left, shape.right, shape.asked, options);
        INFO("case " << i << ": " << shape.left.rows << " x " << shape.left.cols << ", "
                     << shape.right.cols << ", asked " << shape.asked.min << ".."
                     << shape.asked.max << ", mode " << name(options.mode));
        REQUIRE(plan.levels() == levels);
        for (int k = 0; k < levels; ++k) {
            REQUIRE(plan.ranges[static_cast<std::size_t>(k)] ==
                    level_range(shape.asked, k, levels));
        }
        most_levels = std::max(most_levels, options.levels == 0 ? levels : 0);
    }
    CHECK(most_levels > 5);
}

TEST_CASE("matcher and twin agree on reduced images, piece by piece")
{
    Random random(2);
    for (int i = 0; i < 1500; ++i) {
        const Size size{random.between(1, 40), random.between(1, 40)};
        PairLook look;
        look.sixteen_bit = random.chance(50);
        look.holes = random.between(0, 3);
        look.lost_percent = random.one_of({0, 5, 50, 95});
        const auto fine = random_pair(random, size, size.cols, {0, 0}, look).left;
        const auto twin = reduced(fine);
        Image<std::uint16_t> result(twin.size());
        for (const Rect& piece : random_partition(random, twin.size(), 4, 4)) {
            const Rect taps = intersect(Rect{2 * piece.row - 1, 2 * piece.col - 1,
                                             2 * piece.rows + 2, 2 * piece.cols + 2},
                                        rect_of(size));
            hsgm::tiling::Patch<std::uint16_t> patch(taps);
            for (int row = taps.row; row < taps.row_end(); ++row) {
                for (int col = taps.col; col < taps.col_end(); ++col) {
                    patch.at(row, col) = fine(row, col);
                }
            }
            matcher::reduce(patch, size, piece, result.view().part(piece));
        }
        INFO("case " << i << ": " << size.rows << " x " << size.cols);
        REQUIRE(result == twin);
    }
}

TEST_CASE("matcher and twin agree on noise, strip by strip")
{
    Random random(12);
    int noisy = 0;
    for (int i = 0; i < 1500; ++i) {
        const Size size{random.between(1, 90), random.between(1, 90)};
        PairLook look;
        look.noise = random.chance(50);
        look.sixteen_bit = random.chance(50);
        look.grey_levels = random.chance(50) ? random.between(2, 20) : 0;
        look.flat_patches = random.between(0, 4);
        look.holes = random.between(0, 3);
        look.lost_percent = random.one_of({0, 0, 1, 50});
        const auto image = random_pair(random, size, size.cols, {0, 0}, look).left;
        matcher::NoiseCounts counts;
        for (int row = 0; row < size.rows;) {
            const int rows =
                std::min(matcher::kNoiseBlock * random.between(1, 4), size.rows - row);
            counts.add(image.view().part({row, 0, rows, size.cols}));
            row += rows;
        }
        INFO("case " << i << ": " << size.rows << " x " << size.cols);
        REQUIRE(counts.noise() == noise_of(image));
        noisy += counts.noise() > 0 ? 1 : 0;
    }
    CHECK(noisy > 300);
    CHECK(noisy < 1400);
}

TEST_CASE("matcher and twin agree on tones")
{
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        Image<std::uint16_t> image({1, 65536});
        for (int v = 0; v < 65536; ++v) {
            image(0, v) = static_cast<std::uint16_t>(v);
        }
        const int lo = random.between(0, 65534);
        const ToneEnds ends{lo, random.between(lo + 1, 65535)};
        const matcher::Tone tone{ends.lo, ends.hi};
        const auto twin = toned(image, ends);
        bool same = true;
        for (int v = 0; v < 65536; ++v) {
            same = same && tone(static_cast<std::uint16_t>(v)) == twin(0, v);
        }
        INFO("tone " << ends.lo << ".." << ends.hi);
        REQUIRE(same);
    }
}

TEST_CASE("matcher and twin agree on tables of random histograms")
{
    Random random(4);
    for (int i = 0; i < 60; ++i) {
        JointCounts joint({256, 256}, 0);
        matcher::JointHistogram same{};
        const int entries = random.one_of({0, 1, 2, 50, 3000, 100000});
        const int spread = random.one_of({0, 3, 20, 255});
        for (int n = 0; n < entries; ++n) {
            const int left = random.between(0, 255);
            const int right = std::clamp(255 - left + random.between(-spread, spread), 0, 255);
            ++joint(left, right);
            ++same[static_cast<std::size_t>(left * 256 + right)];
        }
        INFO("case " << i << ": " << entries << " entries, spread " << spread);
        REQUIRE(equal(*matcher::make_hmi_table(same), hmi_table(joint)));
    }
}

TEST_CASE("matcher and twin agree on the table of a pair")
{
    Theme theme;
    theme.most_side_px = 80;
    theme.least_count = 4;
    theme.most_count = 32;
    theme.vary = [](Random&, Options& options) { options.cost = Cost::census7x7; };
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const Case c = random_case(seed, theme);
        const matcher::PairTraits pair = traits_of(c);
        const int levels = hmi_level_count(c.pair.left.size(), c.pair.right.size(), c.asked);
        INFO(c.describe());
        REQUIRE(matcher::hmi_level(pair.shape) == levels - 1);
        const auto table =
            matcher::solve_hmi_table(pair, c.options, pyramid(c.pair.left, levels).back(),
                                     pyramid(c.pair.right, levels).back());
        REQUIRE(equal(*table, solve_hmi(c.pair.left, c.pair.right, c.asked, c.tone_left,
                                        c.tone_right, c.options)));
    }
}
