#include "tests/catch.h"

#include "pipeline/evaluate/seam_score.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

using namespace hsgm::evaluate;

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

SeamOptions cells_of(int cell_px, int far_px)
{
    SeamOptions options;
    options.cell_px = cell_px;
    options.far_px = far_px;
    return options;
}

// Windows that each have their own offset, on a ramp: jumps of 0.25 inside, and of 0.25 + 1
// across the vertical borders.
float value(int row, int col, int cell)
{
    return 0.25f * static_cast<float>(row + col) + static_cast<float>(col / cell);
}

} // namespace

TEST_CASE("pairs are counted as straddling, far, or neither")
{
    // 4 x 8 pixels, cells of 4: the only inner border lies between columns 3 and 4.
    SeamScorer scorer(cells_of(4, 1));
    for (int row = 0; row < 4; ++row) {
        scorer.add_row(std::vector<float>(8, 1.0f));
    }
    const SeamScore s = scorer.score();
    CHECK(s.border_pairs == 4);
    // Far by more than 1 px: offsets 1 and 2 of each cell, so two 2 x 2 squares.
    CHECK(s.far_pairs == 2 * 4);
    CHECK(s.border_jump_px == 0);
    CHECK(std::isnan(s.ratio)); // 0 / 0
}

TEST_CASE("the ratio is the mean jump at borders over the mean jump elsewhere")
{
    const int cell = 16;
    SeamScorer scorer(cells_of(cell, 4));
    for (int row = 0; row < cell; ++row) {
        std::vector<float> test(2 * cell);
        for (int col = 0; col < 2 * cell; ++col) {
            test[col] = value(row, col, cell);
        }
        scorer.add_row(test);
    }
    const SeamScore s = scorer.score();
    CHECK(s.border_pairs == cell);
    CHECK(s.border_jump_px == Approx(1.25));
    CHECK(s.far_jump_px == Approx(0.25));
    CHECK(s.ratio == Approx(5));
    // Every row has the same border jumps and the far ones are all alike.
    CHECK(s.ratio_low == Approx(5));
    CHECK(s.ratio_high == Approx(5));
    CHECK(s.far_pairs == 2 * 2 * 8 * 7); // two squares of 8 x 8: offsets 4 to 11
}

TEST_CASE("horizontal borders count like vertical ones")
{
    const int cell = 16;
    SeamScorer scorer(cells_of(cell, 4));
    for (int row = 0; row < 2 * cell; ++row) {
        std::vector<float> test(cell);
        for (int col = 0; col < cell; ++col) {
            test[col] = value(col, row, cell);
        }
        scorer.add_row(test);
    }
    CHECK(scorer.score().border_pairs == cell);
    CHECK(scorer.score().ratio == Approx(5));
}

TEST_CASE("what the truth has is no seam, and jumps are capped")
{
    SeamScorer with_truth(cells_of(4, 1));
    const std::vector<float> test{0, 0.5f, 0, 0.5f, 20, 20.5f, 20, 20.5f};
    const std::vector<float> truth{0, 0, 0, 0, 20, 20, 20, 20};
    with_truth.add_row(test, truth);
    with_truth.add_row(test, truth);
    CHECK(with_truth.score().border_jump_px == Approx(0.5));
    SeamScorer without(cells_of(4, 1));
    without.add_row(test);
    without.add_row(test);
    CHECK(without.score().border_jump_px == Approx(8));
    CHECK(without.score().ratio == Approx(8 / 0.5));
}

TEST_CASE("pixels without a value, without truth, or masked are in no pair")
{
    SeamScorer scorer(cells_of(2, 0));
    const std::vector<float> test{1, kNone, 1, 1, 1, 1, 1, 1};
    const std::vector<float> truth{1, 1, 1, 1, 1, kNone, 1, 1};
    const std::vector<std::uint8_t> mask{1, 1, 1, 1, 1, 1, 1, 0};
    scorer.add_row(test, truth, mask);
    const SeamScore s = scorer.score();
    CHECK(s.border_pairs == 1); // (3, 4); (1, 2) and (5, 6) lack a pixel
    CHECK(s.far_pairs == 1);    // (2, 3)
}

TEST_CASE("the bootstrap interval brackets the ratio and repeats")
{
    SeamScorer scorer(cells_of(8, 2));
    for (int row = 0; row < 64; ++row) {
        std::vector<float> test(64);
        for (int col = 0; col < 64; ++col) {
            test[col] = static_cast<float>((row * 7919 + col * 104729 + row * col) % 13);
        }
        scorer.add_row(test);
    }
    const SeamScore s = scorer.score();
    CHECK(s.ratio_low < s.ratio);
    CHECK(s.ratio_high > s.ratio);
    CHECK(s.ratio_high - s.ratio_low < 0.2);
    CHECK(scorer.score().ratio_low == s.ratio_low);
}

TEST_CASE("a grid without borders has no ratio")
{
    SeamScorer scorer(cells_of(512, 4));
    scorer.add_row(std::vector<float>(20, 1.0f));
    CHECK(std::isnan(scorer.score().ratio));
    CHECK(std::isnan(scorer.score().ratio_low));
    CHECK_THROWS_AS(SeamScorer(cells_of(1, 4)), std::invalid_argument);
}
