#include "matcher/host/winner.h"

#include "matcher/kernel.h"

#include <algorithm>

namespace hsgm::matcher::host {

namespace {

std::uint16_t least_of(const std::uint16_t* values, std::size_t count)
{
    std::uint16_t least = 0xFFFF;
    for (std::size_t i = 0; i < count; ++i) {
        least = std::min(least, values[i]);
    }
    return least;
}

// The number of paths as a constant lets the compiler divide by multiplying.
template <int kPaths>
void prior_for(std::span<const std::uint16_t> sums, int least, std::uint8_t* prior)
{
    for (std::size_t i = 0; i < sums.size(); ++i) {
        prior[i] = static_cast<std::uint8_t>(prior_of(sums[i], least, kPaths));
    }
}

} // namespace

Winner find_winner(std::span<const std::uint16_t> sums)
{
    const std::uint16_t least = least_of(sums.data(), sums.size());
    const auto at = std::find(sums.begin(), sums.end(), least);
    return {static_cast<int>(at - sums.begin()), least};
}

int rival_sum(std::span<const std::uint16_t> sums, int winner)
{
    const auto below = static_cast<std::size_t>(std::max(winner - 1, 0));
    const auto above = std::min(static_cast<std::size_t>(winner + 2), sums.size());
    if (below == 0 && above == sums.size()) {
        return -1;
    }
    return std::min(least_of(sums.data(), below),
                    least_of(sums.data() + above, sums.size() - above));
}

void merge_keys(std::span<const std::uint16_t> sums, std::uint32_t first, std::uint32_t* keys)
{
    for (std::uint32_t i = 0; i < sums.size(); ++i) {
        keys[i] = std::min(keys[i], std::uint32_t{sums[i]} << 16 | (first + i));
    }
}

void prior_from_sums(std::span<const std::uint16_t> sums, int least, int paths,
                     std::uint8_t* prior)
{
    switch (paths) {
    case 4:
        return prior_for<4>(sums, least, prior);
    case 5:
        return prior_for<5>(sums, least, prior);
    case 8:
        return prior_for<8>(sums, least, prior);
    default:
        return prior_for<16>(sums, least, prior);
    }
}

} // namespace hsgm::matcher::host
