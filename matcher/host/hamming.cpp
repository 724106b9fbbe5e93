#include "matcher/host/hamming.h"

#include <stdexcept>

// The instruction that counts the bits of bytes is worth a target of its own here.
#define HWY_WANT_AVX3_DL
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/hamming.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After Highway: compiled once for every target.
#include "matcher/host/cost_row-inl.h"
#include "matcher/host/sampling-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

// The number of bits set in each byte.
template <class D>
HWY_INLINE hn::Vec<D> count_bits(D d, hn::Vec<D> bytes)
{
#if HWY_TARGET == HWY_AVX3_DL || HWY_ARCH_ARM
    (void)d;
    return hn::PopulationCount(bytes);
#else
    alignas(16) static constexpr std::uint8_t kBits[16] = {0, 1, 1, 2, 1, 2, 2, 3,
                                                           1, 2, 2, 3, 2, 3, 3, 4};
    const auto table = hn::LoadDup128(d, kBits);
    const auto low = hn::And(bytes, hn::Set(d, std::uint8_t{15}));
    return hn::Add(hn::TableLookupBytes(table, low),
                   hn::TableLookupBytes(table, hn::ShiftRight<4>(bytes)));
#endif
}

// Counts the bits in which `planes` bytes of a left pixel differ from those of right ones. A
// Weight makes a cost of the number, and of what the planes after these hold. (Were the number
// of planes known to the compiler, it would unroll the loop and add up what it then cannot
// keep in registers.)
template <class Weight>
class Hamming {
public:
    Hamming(const CostRow& row, int planes) : row_(row), planes_(planes) {}

    template <int kVectors, class D, class Writer>
    HWY_INLINE void vectors(D d, int pixel, std::size_t first, std::size_t at,
                            const Writer& writer) const
    {
        const std::size_t lanes = hn::Lanes(d);
        const std::uint8_t* left = row_.left + pixel;
        const std::uint8_t* right = row_.right + first + at;
        auto sum0 = hn::Zero(d);
        auto sum1 = sum0;
        auto sum2 = sum0;
        auto sum3 = sum0;
        for (int k = 0; k < planes_; ++k, left += row_.left_pitch, right += row_.right_pitch) {
            const auto byte = hn::Set(d, *left);
            sum0 = hn::Add(sum0, differing(d, byte, right));
            if constexpr (kVectors >= 2) {
                sum1 = hn::Add(sum1, differing(d, byte, right + lanes));
            }
            if constexpr (kVectors == 4) {
                sum2 = hn::Add(sum2, differing(d, byte, right + 2 * lanes));
                sum3 = hn::Add(sum3, differing(d, byte, right + 3 * lanes));
            }
        }
        const Weight weight(row_, left, right);
        writer.write(d, at, weight.cost(d, sum0, 0));
        if constexpr (kVectors >= 2) {
            writer.write(d, at + lanes, weight.cost(d, sum1, lanes));
        }
        if constexpr (kVectors == 4) {
            writer.write(d, at + 2 * lanes, weight.cost(d, sum2, 2 * lanes));
            writer.write(d, at + 3 * lanes, weight.cost(d, sum3, 3 * lanes));
        }
    }

private:
    template <class D>
    static HWY_INLINE hn::Vec<D> differing(D d, hn::Vec<D> byte, const std::uint8_t* right)
    {
        return count_bits(d, hn::Xor(byte, hn::LoadU(d, right)));
    }

    const CostRow& row_;
    int planes_;
};

struct Once {
    Once(const CostRow&, const std::uint8_t*, const std::uint8_t*) {}

    template <class D>
    HWY_INLINE hn::Vec<D> cost(D, hn::Vec<D> bits, std::size_t) const
    {
        return bits;
    }
};

struct Twice {
    Twice(const CostRow&, const std::uint8_t*, const std::uint8_t*) {}

    template <class D>
    HWY_INLINE hn::Vec<D> cost(D, hn::Vec<D> bits, std::size_t) const
    {
        return hn::Add(bits, bits);
    }
};

template <int kMost>
struct AtMost {
    AtMost(const CostRow&, const std::uint8_t*, const std::uint8_t*) {}

    template <class D>
    HWY_INLINE hn::Vec<D> cost(D d, hn::Vec<D> bits, std::size_t) const
    {
        return hn::Min(bits, hn::Set(d, std::uint8_t{kMost}));
    }
};

// Twice the bits, and half the difference of tones capped at 24.
class WithTones {
public:
    WithTones(const CostRow&, const std::uint8_t* left, const std::uint8_t* right)
        : left_(*left), right_(right)
    {
    }

    template <class D>
    HWY_INLINE hn::Vec<D> cost(D d, hn::Vec<D> bits, std::size_t at) const
    {
        const auto left = hn::Set(d, left_);
        const auto right = hn::LoadU(d, right_ + at);
        const auto difference =
            hn::Or(hn::SaturatedSub(left, right), hn::SaturatedSub(right, left));
        const auto half = hn::ShiftRight<1>(hn::Min(difference, hn::Set(d, std::uint8_t{24})));
        return hn::Min(hn::Add(hn::Add(bits, bits), half), hn::Set(d, std::uint8_t{59}));
    }

private:
    std::uint8_t left_;
    const std::uint8_t* right_;
};

// Three quarters of the bits, and five eighths of the difference of gradients. What saturates
// before it is divided is far above the cap.
class WithGradients {
public:
    WithGradients(const CostRow& row, const std::uint8_t* left, const std::uint8_t* right)
        : row_(row), left_(left), right_(right)
    {
    }

    template <class D>
    HWY_INLINE hn::Vec<D> cost(D d, hn::Vec<D> bits, std::size_t at) const
    {
        const Sample<D> gradient(d, left_, row_.left_pitch);
        const auto difference = gradient.difference(d, right_ + at, row_.right_pitch);
        const auto of_bits = hn::Add(hn::Add(bits, bits), bits);
        const auto of_gradients =
            hn::Add(hn::Add(difference, difference), hn::ShiftRight<1>(difference));
        const auto cost = hn::ShiftRight<2>(hn::SaturatedAdd(of_bits, of_gradients));
        return hn::Min(cost, hn::Set(d, std::uint8_t{59}));
    }

private:
    const CostRow& row_;
    const std::uint8_t* left_;
    const std::uint8_t* right_;
};

void census5x5_row(const CostRow& row, std::uint8_t* costs)
{
    fill_row(row, Hamming<Twice>(row, 3), costs);
}

void six_planes_row(const CostRow& row, std::uint8_t* costs)
{
    fill_row(row, Hamming<Once>(row, 6), costs);
}

void eight_planes_row(const CostRow& row, std::uint8_t* costs)
{
    fill_row(row, Hamming<AtMost<59>>(row, 8), costs);
}

void census_ad_row(const CostRow& row, std::uint8_t* costs)
{
    fill_row(row, Hamming<WithTones>(row, 3), costs);
}

void pairs_bt_row(const CostRow& row, std::uint8_t* costs)
{
    fill_row(row, Hamming<WithGradients>(row, 8), costs);
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(census5x5_row);
HWY_EXPORT(six_planes_row);
HWY_EXPORT(eight_planes_row);
HWY_EXPORT(census_ad_row);
HWY_EXPORT(pairs_bt_row);

void hamming_costs(Cost cost, const CostRow& row, std::uint8_t* costs)
{
    switch (cost) {
    case Cost::census5x5:
        return HWY_DYNAMIC_DISPATCH(census5x5_row)(row, costs);
    case Cost::census7x7:
    case Cost::ternary5x5: // 48 bits both
        return HWY_DYNAMIC_DISPATCH(six_planes_row)(row, costs);
    case Cost::census9x7:
    case Cost::pairs5x5: // 62 and 64 bits
        return HWY_DYNAMIC_DISPATCH(eight_planes_row)(row, costs);
    case Cost::census_ad:
        return HWY_DYNAMIC_DISPATCH(census_ad_row)(row, costs);
    case Cost::pairs_bt:
        return HWY_DYNAMIC_DISPATCH(pairs_bt_row)(row, costs);
    default:
        throw std::logic_error("hamming_costs: no census cost");
    }
}

} // namespace hsgm::matcher::host
#endif
