#include "matcher/host/hamming.h"

#include <algorithm>
#include <bit>
#include <stdexcept>

// The instruction that counts the bits of bytes is worth a target of its own here.
#define HWY_WANT_AVX3_DL
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/hamming.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After Highway: compiled once for every target.
#include "matcher/host/cost_row-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

// How differing bits become a cost.
template <int kFactor, int kMost>
struct Weighing {
    template <class D>
    static HWY_INLINE hn::Vec<D> weigh(D d, hn::Vec<D> bits)
    {
        if constexpr (kFactor == 2) {
            bits = hn::Add(bits, bits);
        }
        if constexpr (kMost < 64) {
            bits = hn::Min(bits, hn::Set(d, std::uint8_t{kMost}));
        }
        return bits;
    }
};

// `kRuns` runs of bytes a pixel. A Run knows how to count the bits in which the byte of a left
// pixel differs from those of right ones.
template <int kRuns, class Run, class Weight>
class Hamming {
public:
    explicit Hamming(const CostRow& row)
        : left_(row.left), left_pitch_(row.left_pitch), right_(row.right),
          right_pitch_(row.right_pitch)
    {
    }

    template <int kVectors, class D, class Writer>
    HWY_INLINE void vectors(D d, int pixel, std::size_t first, std::size_t at,
                            const Writer& writer) const
    {
        const std::size_t lanes = hn::Lanes(d);
        const std::uint8_t* left = left_ + pixel;
        const std::uint8_t* right = right_ + first + at;
        auto sum0 = hn::Zero(d);
        auto sum1 = sum0;
        auto sum2 = sum0;
        auto sum3 = sum0;
        for (int k = 0; k < kRuns; ++k, left += left_pitch_, right += right_pitch_) {
            const auto one = Run::left(d, *left);
            sum0 = hn::Add(sum0, Run::differing(one, hn::LoadU(d, right)));
            if constexpr (kVectors >= 2) {
                sum1 = hn::Add(sum1, Run::differing(one, hn::LoadU(d, right + lanes)));
            }
            if constexpr (kVectors == 4) {
                sum2 = hn::Add(sum2, Run::differing(one, hn::LoadU(d, right + 2 * lanes)));
                sum3 = hn::Add(sum3, Run::differing(one, hn::LoadU(d, right + 3 * lanes)));
            }
        }
        writer.write(d, at, Weight::weigh(d, sum0));
        if constexpr (kVectors >= 2) {
            writer.write(d, at + lanes, Weight::weigh(d, sum1));
        }
        if constexpr (kVectors == 4) {
            writer.write(d, at + 2 * lanes, Weight::weigh(d, sum2));
            writer.write(d, at + 3 * lanes, Weight::weigh(d, sum3));
        }
    }

private:
    const std::uint8_t* left_;
    std::size_t left_pitch_;
    const std::uint8_t* right_;
    std::size_t right_pitch_;
};

#if HWY_TARGET == HWY_AVX3_DL || HWY_ARCH_ARM

// One instruction counts the bits of every byte.
struct CountedBytes {
    template <class D>
    static HWY_INLINE hn::Vec<D> left(D d, std::uint8_t byte)
    {
        return hn::Set(d, byte);
    }
    template <class V>
    static HWY_INLINE V differing(V left, V right)
    {
        return hn::PopulationCount(hn::Xor(left, right));
    }
};

template <int kPlanes, class Weight>
HWY_INLINE void hamming_row(const CostRow& row, std::uint8_t*, std::uint8_t* costs)
{
    fill_row(row, Hamming<kPlanes, CountedBytes, Weight>(row), costs);
}

#else

// differing[16 * a + b]: the bits in which half bytes a and b differ.
alignas(16) constexpr auto kDiffering = [] {
    std::array<std::uint8_t, 256> table{};
    for (unsigned i = 0; i < 256; ++i) {
        table[i] = static_cast<std::uint8_t>(std::popcount((i >> 4) ^ (i & 15)));
    }
    return table;
}();

// Half bytes: that of the left pixel, times 16, chooses a row of the table, and one
// instruction looks up those of right pixels in it.
struct LookedUpHalves {
    template <class D>
    static HWY_INLINE hn::Vec<D> left(D d, std::uint8_t half_byte)
    {
        return hn::LoadDup128(d, kDiffering.data() + half_byte);
    }
    template <class V>
    static HWY_INLINE V differing(V table, V right)
    {
        return hn::TableLookupBytes(table, right);
    }
};

// Planes of whole bytes to twice as many of half bytes; the left ones stay times 16.
HWY_INLINE void split_left(const std::uint8_t* HWY_RESTRICT bytes, std::size_t count,
                           std::uint8_t* HWY_RESTRICT low, std::uint8_t* HWY_RESTRICT high)
{
    for (std::size_t i = 0; i < count; ++i) {
        low[i] = static_cast<std::uint8_t>(bytes[i] << 4);
        high[i] = static_cast<std::uint8_t>(bytes[i] & 0xF0);
    }
}

HWY_INLINE void split_right(const std::uint8_t* HWY_RESTRICT bytes, std::size_t count,
                            std::uint8_t* HWY_RESTRICT low, std::uint8_t* HWY_RESTRICT high)
{
    for (std::size_t i = 0; i < count; ++i) {
        low[i] = static_cast<std::uint8_t>(bytes[i] & 15);
        high[i] = static_cast<std::uint8_t>(bytes[i] >> 4);
    }
}

template <int kPlanes, class Weight>
HWY_INLINE void hamming_row(const CostRow& row, std::uint8_t* split, std::uint8_t* costs)
{
    CostRow halves = row;
    halves.left_pitch = static_cast<std::size_t>(row.cols);
    halves.right_pitch = static_cast<std::size_t>(row.met()) + 64;
    halves.left = split;
    std::uint8_t* right = split + 2 * kPlanes * halves.left_pitch;
    halves.right = right;
    for (std::size_t k = 0; k < kPlanes; ++k) {
        std::uint8_t* left = split + 2 * k * halves.left_pitch;
        split_left(row.left + k * row.left_pitch, halves.left_pitch, left,
                   left + halves.left_pitch);
        split_right(row.right + k * row.right_pitch, static_cast<std::size_t>(row.met()), right,
                    right + halves.right_pitch);
        right += 2 * halves.right_pitch;
    }
    fill_row(halves, Hamming<2 * kPlanes, LookedUpHalves, Weight>(halves), costs);
}

#endif

void census5x5_row(const CostRow& row, std::uint8_t* split, std::uint8_t* costs)
{
    hamming_row<3, Weighing<2, 64>>(row, split, costs);
}

void census7x7_row(const CostRow& row, std::uint8_t* split, std::uint8_t* costs)
{
    hamming_row<6, Weighing<1, 64>>(row, split, costs);
}

void census9x7_row(const CostRow& row, std::uint8_t* split, std::uint8_t* costs)
{
    hamming_row<8, Weighing<1, 59>>(row, split, costs);
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(census5x5_row);
HWY_EXPORT(census7x7_row);
HWY_EXPORT(census9x7_row);

void hamming_costs(Cost cost, const CostRow& row, Buffer<std::uint8_t>& split,
                   std::uint8_t* costs)
{
    constexpr std::size_t kMostPlanes = 8;
    std::uint8_t* room = split.need(
        2 * kMostPlanes * (static_cast<std::size_t>(row.cols + row.met()) + 64) + kMostPlanes);
    switch (cost) {
    case Cost::census5x5:
        return HWY_DYNAMIC_DISPATCH(census5x5_row)(row, room, costs);
    case Cost::census7x7:
        return HWY_DYNAMIC_DISPATCH(census7x7_row)(row, room, costs);
    case Cost::census9x7:
        return HWY_DYNAMIC_DISPATCH(census9x7_row)(row, room, costs);
    default:
        throw std::logic_error("hamming_costs: no census cost");
    }
}

} // namespace hsgm::matcher::host
#endif
