#include "matcher/host/winner.h"

#include "matcher/kernel.h"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/winner.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Sums = hn::ScalableTag<std::uint16_t>;

std::uint16_t least_of(const std::uint16_t* values, std::size_t count)
{
    const Sums d;
    const std::size_t lanes = hn::Lanes(d);
    auto least = hn::Set(d, 0xFFFF);
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
        least = hn::Min(least, hn::LoadU(d, values + i));
    }
    std::uint16_t result = i > 0 ? hn::GetLane(hn::MinOfLanes(d, least)) : 0xFFFF;
    for (; i < count; ++i) {
        result = std::min(result, values[i]);
    }
    return result;
}

void merge(const std::uint16_t* sums, std::size_t count, std::uint32_t first,
           std::uint32_t* keys)
{
    const hn::ScalableTag<std::uint32_t> d;
    const hn::Rebind<std::uint16_t, decltype(d)> d16;
    const std::size_t lanes = hn::Lanes(d);
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
        const auto sum = hn::PromoteTo(d, hn::LoadU(d16, sums + i));
        const auto number = hn::Iota(d, first + static_cast<std::uint32_t>(i));
        const auto key = hn::Or(hn::ShiftLeft<16>(sum), number);
        hn::StoreU(hn::Min(hn::LoadU(d, keys + i), key), d, keys + i);
    }
    for (; i < count; ++i) {
        const std::uint32_t key =
            std::uint32_t{sums[i]} << 16 | (first + static_cast<std::uint32_t>(i));
        keys[i] = std::min(keys[i], key);
    }
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(least_of);
HWY_EXPORT(merge);

namespace {

std::uint16_t least_of(std::span<const std::uint16_t> values)
{
    return HWY_DYNAMIC_DISPATCH(least_of)(values.data(), values.size());
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
    const std::uint16_t least = least_of(sums);
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
    return std::min(least_of(sums.first(below)), least_of(sums.subspan(above)));
}

void merge_keys(std::span<const std::uint16_t> sums, std::uint32_t first, std::uint32_t* keys)
{
    HWY_DYNAMIC_DISPATCH(merge)(sums.data(), sums.size(), first, keys);
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
#endif
