#include "tests/catch.h"

#include "pipeline/bench/peer.h"

#include <cmath>

using namespace hsgm;
using namespace hsgm::bench;
using Catch::Matchers::Contains;

namespace {

matcher::PairShape shape_of(tiling::Size size, tiling::DisparityRange asked)
{
    return {size, size, asked};
}

} // namespace

TEST_CASE("peers are found by their names")
{
    CHECK(all_peers().size() == 4);
    for (const Peer peer : all_peers()) {
        CHECK(peer_from_name(name(peer)) == peer);
        CHECK_THAT(title(peer), Contains("OpenCV"));
    }
    CHECK_THROWS_WITH(peer_from_name("HH"), Contains("hh, hh4, sgbm, 3way, not 'HH'"));
}

TEST_CASE("columns without a counterpart for some disparity are not compared")
{
    const auto columns = [](tiling::DisparityRange asked) {
        const ColumnRange range = compared_columns(shape_of({10, 100}, asked));
        return std::pair(range.first, range.end);
    };
    CHECK(columns({0, 15}) == std::pair(16, 100));
    CHECK(columns({8, 23}) == std::pair(24, 100));
    CHECK(columns({-8, 7}) == std::pair(8, 92));
    CHECK(columns({-32, -17}) == std::pair(0, 68));
    CHECK(compared_columns(shape_of({10, 100}, {0, 127})).count() == 0);
}

TEST_CASE("peers give values only in the columns that are compared, and good ones there")
{
    BenchPair pair = render_pair("town", 192, 48);
    pair.asked = GENERATE(tiling::DisparityRange{0, 47}, tiling::DisparityRange{-16, 47});
    const ColumnRange columns = compared_columns(pair.shape());
    PeerPair peers(pair);
    for (const Peer peer : all_peers()) {
        CAPTURE(name(peer), pair.asked.min);
        peers.match(peer, 1);
        const tiling::Image<float> found = peers.disparity_px();
        int outside = 0;
        int inside = 0;
        int good = 0;
        for (int row = 0; row < found.rows(); ++row) {
            for (int col = 0; col < found.cols(); ++col) {
                const bool has_value = !std::isnan(found(row, col));
                const bool compared = col >= columns.first && col < columns.end;
                outside += has_value && !compared;
                inside += has_value && compared;
                good += compared && std::abs(found(row, col) - pair.truth_px(row, col)) <= 1;
            }
        }
        CHECK(outside == 0);
        CHECK(inside > found.rows() * columns.count() / 2);
        CHECK(good > inside * 7 / 10);
    }
}

TEST_CASE("pairs that OpenCV cannot match are told apart")
{
    CHECK_FALSE(why_not(shape_of({10, 100}, {0, 15})));
    CHECK_THAT(*why_not(shape_of({10, 100}, {0, 16})), Contains("sixteens, and these are 17"));
    CHECK_THAT(*why_not(shape_of({10, 100}, {0, 111})), Contains("all of them"));
    CHECK_THAT(*why_not({{10, 100}, {10, 90}, {0, 15}}), Contains("equal width"));
}

TEST_CASE("modes with sums of every pixel are known to take about four bytes a cell")
{
    const auto shape = shape_of({4096, 4096}, {0, 127});
    const double cells = 4096.0 * (4096 - 128) * 128;
    CHECK(static_cast<double>(peer_bytes(Peer::hh, shape)) / cells == Approx(4).epsilon(0.05));
    CHECK(peer_bytes(Peer::three_way, shape) < peer_bytes(Peer::hh, shape) / 20);
}
