#include "matcher/host/hamming.h"

#include <algorithm>

// The instruction that counts bits in vectors is worth a target of its own here.
#define HWY_WANT_AVX3_DL
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/hamming.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Differing bits of one left word and `count` right ones.
HWY_INLINE void count_bits(std::uint64_t left, const std::uint64_t* HWY_RESTRICT right,
                           int count, std::uint8_t* HWY_RESTRICT bits)
{
    const hn::CappedTag<std::uint64_t, 8> d64;
    const hn::Rebind<std::uint8_t, decltype(d64)> d8;
    const auto word = hn::Set(d64, left);
    for (int j = 0; j < count; j += static_cast<int>(hn::Lanes(d64))) {
        const auto differing = hn::PopulationCount(hn::Xor(word, hn::LoadU(d64, right + j)));
        hn::StoreU(hn::TruncateTo(d8, differing), d8, bits + j);
    }
}

HWY_INLINE void bits_to_costs(const HammingRow& row, const std::uint8_t* HWY_RESTRICT valid,
                              std::uint8_t* HWY_RESTRICT costs)
{
    const hn::CappedTag<std::uint8_t, 16> d;
    const auto most = hn::Set(d, row.most);
    const auto half = hn::Set(d, row.half);
    for (int j = 0; j < row.count; j += static_cast<int>(hn::Lanes(d))) {
        auto cost = hn::LoadU(d, costs + j);
        cost = hn::Min(row.doubled ? hn::Add(cost, cost) : cost, most);
        const auto no_counterpart = hn::Eq(hn::LoadU(d, valid + j), hn::Zero(d));
        hn::StoreU(hn::IfThenElse(no_counterpart, half, cost), d, costs + j);
    }
}

void hamming_row(const HammingRow& row, std::uint8_t* costs)
{
    for (int i = 0; i < row.cols; ++i, costs += row.stride) {
        if (row.left_valid[i] == 0) {
            std::fill_n(costs, row.count, row.half);
        } else {
            const int first = row.cols - 1 - i;
            count_bits(row.left[i], row.right + first, row.count, costs);
            bits_to_costs(row, row.right_valid + first, costs);
        }
        std::fill(costs + row.count, costs + row.stride, std::uint8_t{255});
    }
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(hamming_row);

void hamming_costs(const HammingRow& row, std::uint8_t* costs)
{
    HWY_DYNAMIC_DISPATCH(hamming_row)(row, costs);
}

} // namespace hsgm::matcher::host
#endif
