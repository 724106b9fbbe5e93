#include "matcher/host/prior.h"

#include "matcher/kernel.h"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/prior.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Vectors are of kBytes, which `stride` is a multiple of.
template <int kBytes, bool kOddFirst>
struct Adding {
    using D = hn::CappedTag<std::uint8_t, kBytes>;
    using D16 = hn::Repartition<std::uint16_t, D>;
    using Half = hn::Rebind<std::uint8_t, D16>;

    // Prior of the disparities 2j and 2j + 1 above the first, or, beginning with an odd one,
    // the other way round, in one 16-bit lane each.
    static HWY_INLINE hn::Vec<D16> spread(const std::uint8_t* HWY_RESTRICT q)
    {
        const D16 d16;
        const Half half;
        const auto lower = hn::LoadU(half, q);
        const auto upper = hn::LoadU(half, q + 1);
        const auto odd = hn::PromoteTo(d16, hn::AverageRound(lower, upper));
        const auto even = hn::PromoteTo(d16, kOddFirst ? upper : lower);
        return kOddFirst ? hn::Or(odd, hn::ShiftLeft<8>(even))
                         : hn::Or(even, hn::ShiftLeft<8>(odd));
    }

    // Values are at most 16, so the mask takes away no bit but those from the byte above.
    static HWY_INLINE void add(hn::Vec<D16> prior, int shift, std::uint8_t* HWY_RESTRICT costs)
    {
        const D d;
        const D16 d16;
        const auto part = hn::And(hn::ShiftRightSame(prior, shift), hn::Set(d16, 0x0707));
        hn::StoreU(hn::SaturatedAdd(hn::LoadU(d, costs), hn::BitCast(d, part)), d, costs);
    }

    // One or two pixels that share a coarse one.
    static HWY_INLINE void pixels(const std::uint8_t* HWY_RESTRICT q, int stride,
                                  const std::uint8_t* low_texture, int count,
                                  std::uint8_t* HWY_RESTRICT costs)
    {
        const int shift = low_texture[0] != 0 ? kPriorShift : kPriorShiftTextured;
        const int next_shift = low_texture[count - 1] != 0 ? kPriorShift : kPriorShiftTextured;
        for (int i = 0; i < stride; i += static_cast<int>(hn::Lanes(D()))) {
            const auto prior = spread(q + i / 2);
            add(prior, shift, costs + i);
            if (count > 1) {
                add(prior, next_shift, costs + stride + i);
            }
        }
    }
};

// The coarse values that the fine range meets, with the cap where none was searched.
HWY_INLINE const std::uint8_t* widened(const PriorRun& run, const std::uint8_t* values,
                                       int first, int count, std::uint8_t* HWY_RESTRICT room)
{
    std::fill_n(room, count, std::uint8_t{kPriorCap});
    const int begin = std::max(first, run.coarse.min);
    const int end = std::min(first + count - 1, run.coarse.max);
    if (begin <= end) {
        std::copy_n(values + (begin - run.coarse.min), end - begin + 1, room + (begin - first));
    }
    return room;
}

template <int kBytes, bool kOddFirst>
void add_to_run(const PriorRun& run, std::uint8_t* HWY_RESTRICT costs, int stride,
                std::uint8_t* HWY_RESTRICT room)
{
    const int first = tiling::floor_div(run.fine.min, 2);
    const int count = run.fine.count() / 2 + 2; // coarse values met, one more than a pair each
    const int read = stride / 2 + kBytes;       // whole vectors of them
    const bool inside = first >= run.coarse.min && first + count - 1 <= run.coarse.max;
    const std::uint8_t* values = run.values;
    for (int i = 0; i < run.cols;) {
        const int pixels = (run.col + i) % 2 == 0 && i + 1 < run.cols ? 2 : 1;
        const std::uint8_t* q = values + (first - run.coarse.min);
        if (!inside || q + read > run.end) {
            q = widened(run, values, first, count, room);
        }
        Adding<kBytes, kOddFirst>::pixels(q, stride, run.low_texture + i, pixels,
                                          costs + std::ptrdiff_t{i} * stride);
        i += pixels;
        values += run.pitch;
    }
}

template <int kBytes>
HWY_INLINE void add_in_vectors(const PriorRun& run, std::uint8_t* costs, int stride,
                               std::uint8_t* room)
{
    if (run.fine.min % 2 == 0) {
        add_to_run<kBytes, false>(run, costs, stride, room);
    } else {
        add_to_run<kBytes, true>(run, costs, stride, room);
    }
}

void add_to_pixels(const PriorRun& run, std::uint8_t* costs, int stride, std::uint8_t* room)
{
    if (stride % 64 == 0) {
        add_in_vectors<64>(run, costs, stride, room);
    } else if (stride % 32 == 0) {
        add_in_vectors<32>(run, costs, stride, room);
    } else {
        add_in_vectors<16>(run, costs, stride, room);
    }
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(add_to_pixels);

void add_prior(const PriorRun& run, std::uint8_t* costs, int stride, Buffer<std::uint8_t>& room)
{
    constexpr std::size_t kBeyond = 66; // whole vectors are read
    std::uint8_t* q = room.need(static_cast<std::size_t>(stride) / 2 + kBeyond);
    HWY_DYNAMIC_DISPATCH(add_to_pixels)(run, costs, stride, q);
}

} // namespace hsgm::matcher::host
#endif
