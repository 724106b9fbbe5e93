// One height from those of several pairs, with answers worked out by hand.

#include "pipeline/dsm/fused_cells.h"

#include "tests/catch.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

using namespace hsgm::dsm;

namespace {

struct Sample {
    float height = 0;
    std::uint8_t confidence = 200;
    float spread = 0.1F;
    std::uint8_t points = 4;
};

/// A pair that has one cell.
ReasonedCells pair_of(const Sample& sample)
{
    ReasonedCells pair{Cells({1, 1}), hsgm::tiling::Image<std::uint8_t>({1, 1})};
    pair.cells.height(0, 0) = sample.height;
    pair.cells.confidence(0, 0) = sample.confidence;
    pair.cells.spread(0, 0) = sample.spread;
    pair.cells.points(0, 0) = sample.points;
    return pair;
}

ReasonedCells without(Missing reason)
{
    ReasonedCells pair{Cells({1, 1}), hsgm::tiling::Image<std::uint8_t>({1, 1})};
    pair.reasons(0, 0) = static_cast<std::uint8_t>(reason);
    return pair;
}

FusedCells fused(const std::vector<ReasonedCells>& pairs)
{
    return fuse(pairs, 1.0, 0.1);
}

} // namespace

TEST_CASE("pairs that agree are averaged by their weights, and their spread grows")
{
    // Equal weights: mean 10.2, spread of the points sqrt(0.1^2 + 0.2^2).
    const FusedCells cell = fused({pair_of({10.0F}), pair_of({10.4F})});
    CHECK(std::abs(double{cell.of.cells.height(0, 0)} - 10.2) < 1e-5);
    CHECK(std::abs(double{cell.of.cells.spread(0, 0)} - std::sqrt(0.05)) < 1e-5);
    CHECK(cell.of.cells.points(0, 0) == 8);
    CHECK(cell.of.cells.confidence(0, 0) == 200);
    CHECK(cell.pairs(0, 0) == 2);
    CHECK(cell.of.reasons(0, 0) == 0);
    // Half the spread with its floor: twice the weight.
    const FusedCells leaning =
        fused({pair_of({10.0F, 200, 0.3F}), pair_of({10.3F, 200, 0.1F})});
    CHECK(std::abs(double{leaning.of.cells.height(0, 0)} - 10.2) < 1e-5);
}

TEST_CASE("a single wrong height among three moves nothing")
{
    const FusedCells cell = fused({pair_of({10.0F}), pair_of({55.0F, 255}), pair_of({10.2F})});
    CHECK(std::abs(double{cell.of.cells.height(0, 0)} - 10.1) < 1e-5);
    CHECK(cell.pairs(0, 0) == 2);
    CHECK(cell.of.cells.points(0, 0) == 8);
}

TEST_CASE("of two heights that disagree the surer one wins")
{
    for (const bool turned : {false, true}) {
        std::vector<ReasonedCells> pairs{pair_of({10.0F, 160}), pair_of({14.0F, 220})};
        if (turned) {
            std::reverse(pairs.begin(), pairs.end());
        }
        const FusedCells cell = fused(pairs);
        CHECK(cell.of.cells.height(0, 0) == 14.0F);
        CHECK(cell.pairs(0, 0) == 1);
        CHECK(cell.of.cells.confidence(0, 0) == 220);
    }
}

TEST_CASE("a cell that one pair sees is filled, one that none sees has the furthest reason")
{
    const FusedCells filled = fused({without(Missing::occluded), pair_of({7.0F})});
    CHECK(filled.of.cells.height(0, 0) == 7.0F);
    CHECK(filled.of.reasons(0, 0) == 0);
    CHECK(filled.pairs(0, 0) == 1);
    const FusedCells empty = fused(
        {without(Missing::outside), without(Missing::uncertain), without(Missing::hidden)});
    CHECK(empty.of.cells.height(0, 0) == kNoHeight);
    CHECK(empty.of.reasons(0, 0) == static_cast<int>(Missing::uncertain));
    CHECK(empty.pairs(0, 0) == 0);
    CHECK(empty.of.cells.points(0, 0) == 0);
}

TEST_CASE("fused cells have the same bits in whatever order the pairs come")
{
    std::vector<ReasonedCells> pairs{pair_of({10.01F, 180, 0.13F}), pair_of({10.3F, 210, 0.4F}),
                                     pair_of({9.77F, 255, 0.07F}), pair_of({12.0F, 250, 0.2F})};
    std::optional<float> first;
    std::vector<int> order{0, 1, 2, 3};
    do {
        std::vector<ReasonedCells> turned;
        for (const int i : order) {
            turned.push_back(pairs[static_cast<std::size_t>(i)]);
        }
        const float height = fused(turned).of.cells.height(0, 0);
        CHECK(first.value_or(height) == height);
        first = height;
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("heights less confident than asked for are taken away, and say so")
{
    for (const int confidence : {149, 150}) {
        CAPTURE(confidence);
        ReasonedCells cell = pair_of({10.0F, static_cast<std::uint8_t>(confidence)});
        remove_uncertain(cell, 150);
        const bool kept = confidence >= 150;
        CHECK((cell.cells.height(0, 0) != kNoHeight) == kept);
        CHECK((cell.cells.points(0, 0) != 0) == kept);
        CHECK(cell.cells.confidence(0, 0) == (kept ? confidence : 0));
        CHECK(cell.reasons(0, 0) ==
              static_cast<std::uint8_t>(kept ? Missing::none : Missing::uncertain));
    }
    // What has no value keeps its reason.
    ReasonedCells hole = without(Missing::occluded);
    remove_uncertain(hole, 150);
    CHECK(hole.reasons(0, 0) == static_cast<std::uint8_t>(Missing::occluded));
    ReasonedCells any = pair_of({10.0F, 1});
    remove_uncertain(any, 0);
    CHECK(any.cells.height(0, 0) == 10.0F);
}

TEST_CASE("an uncertain height stays where two pairs have it and goes where they disagree")
{
    FusedCells agreed = fused({pair_of({10.0F, 100}), pair_of({10.4F, 100})});
    remove_uncertain(agreed, 150);
    CHECK(agreed.of.cells.height(0, 0) != kNoHeight);
    CHECK(agreed.pairs(0, 0) == 2);
    FusedCells disputed = fused({pair_of({10.0F, 100}), pair_of({20.0F, 100})});
    remove_uncertain(disputed, 150);
    CHECK(disputed.of.cells.height(0, 0) == kNoHeight);
    CHECK(disputed.pairs(0, 0) == 0);
    CHECK(disputed.of.reasons(0, 0) == static_cast<std::uint8_t>(Missing::uncertain));
}
