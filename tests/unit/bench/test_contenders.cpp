#include "tests/catch.h"

#include "pipeline/bench/contenders.h"

using namespace hsgm;
using namespace hsgm::bench;
using matcher::Cost;
using matcher::Instructions;

namespace {

std::vector<std::string> titles(const std::vector<Contender>& all)
{
    std::vector<std::string> found;
    for (const Contender& c : all) {
        found.push_back(c.title + " x" + std::to_string(c.threads));
    }
    return found;
}

} // namespace

TEST_CASE("contenders differ from the base in one thing each")
{
    BenchSettings settings;
    settings.costs = {Cost::census9x7, Cost::census5x5};
    settings.instructions = {Instructions::avx2, Instructions::sse4};
    settings.threads = {1, 4};
    settings.peers = {Peer::hh, Peer::three_way};
    const auto all = contenders(settings);
    CHECK(titles(all) == std::vector<std::string>{
                             "hsgm census9x7, avx2 x1",
                             "hsgm census9x7, avx2, not pruned x1",
                             "hsgm census9x7, sse4 x1",
                             "hsgm census5x5, avx2 x1",
                             "OpenCV HH, 8 paths x1",
                             "OpenCV 3WAY, 3 paths x1",
                             "hsgm census9x7, avx2 x4",
                             "OpenCV HH, 8 paths x4",
                             "OpenCV 3WAY, 3 paths x4",
                         });
    std::vector<std::size_t> bases;
    for (const Contender& c : all) {
        bases.push_back(c.base);
        CHECK(c.peer.has_value() == c.title.starts_with("OpenCV"));
    }
    CHECK(bases == std::vector<std::size_t>{0, 0, 0, 0, 0, 0, 0, 6, 6});
    CHECK(all[0].options.prune);
    CHECK_FALSE(all[1].options.prune);
    CHECK(all[2].options.prune);
    CHECK(all[3].options.cost == Cost::census5x5);
    CHECK(all[3].instructions == Instructions::avx2);
}

TEST_CASE("a device is measured with every cost, and once without pruning, against the base")
{
    BenchSettings settings;
    settings.costs = {Cost::census7x7, Cost::hmi};
    settings.threads = {2};
    settings.devices.resize(1);
    settings.devices[0].number = 3;
    const auto all = contenders(settings);
    CHECK(titles(all) == std::vector<std::string>{
                             "hsgm census7x7 x2",
                             "hsgm census7x7, not pruned x2",
                             "hsgm hmi x2",
                             "hsgm census7x7, cuda:3 x2",
                             "hsgm census7x7, cuda:3, not pruned x2",
                             "hsgm hmi, cuda:3 x2",
                         });
    for (std::size_t i = 0; i < all.size(); ++i) {
        CHECK(all[i].base == 0);
        CHECK(all[i].device.has_value() == (i >= 3));
    }
    CHECK(all[3].options.prune);
    CHECK_FALSE(all[4].options.prune);
    CHECK(all[5].options.cost == Cost::hmi);
}

TEST_CASE("a mode that never prunes has no contender without pruning")
{
    BenchSettings settings;
    settings.options.mode = matcher::Mode::sgm;
    CHECK(titles(contenders(settings)) == std::vector<std::string>{"sgm ternary5x5 x1"});
    settings.options.mode = matcher::Mode::hsgm;
    settings.options.prune = false;
    CHECK(contenders(settings).size() == 1);
    settings.options.prune = true;
    CHECK(contenders(settings).size() == 2);
}
