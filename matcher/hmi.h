#pragma once

#include <array>
#include <cstdint>
#include <memory>

namespace hsgm::matcher {

/// Matching costs 0..48 by tone of the left and of the right pixel, from the mutual
/// information of a coarse match (docs/algorithm.md, section 7; Hirschmueller 2008).
struct HmiTable {
    std::array<std::uint8_t, 65536> cost;

    std::uint8_t operator()(std::uint8_t left, std::uint8_t right) const
    {
        return cost[left * 256u + right];
    }
};

/// How often each pair of tones was matched: joint[left * 256 + right].
using JointHistogram = std::array<std::uint64_t, 65536>;

/// The table of a joint histogram. IEEE doubles in a fixed order: the same table on every
/// machine whose `log` and `exp` agree, which is why a run makes it once and stores it.
std::shared_ptr<const HmiTable> make_hmi_table(const JointHistogram& joint);

} // namespace hsgm::matcher
