// Differences that do not mind where between its pixels an image was sampled (S. Birchfield,
// C. Tomasi, PAMI 20(4), 1998). Compiled once for every instruction set: the guard below is
// Highway's, which lets each of its targets include this file again.
#if defined(HSGM_MATCHER_HOST_SAMPLING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HSGM_MATCHER_HOST_SAMPLING_INL_H_
#undef HSGM_MATCHER_HOST_SAMPLING_INL_H_
#else
#define HSGM_MATCHER_HOST_SAMPLING_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A value of a left pixel and its least and largest within half a pixel, from three planes.
template <class D>
class Sample {
public:
    HWY_INLINE Sample(D d, const std::uint8_t* left, std::size_t pitch)
        : value_(hn::Set(d, left[0])), least_(hn::Set(d, left[pitch])),
          most_(hn::Set(d, left[2 * pitch]))
    {
    }

    // How far the value of either pixel lies outside what the other one's may be, the smaller
    // of both.
    HWY_INLINE hn::Vec<D> difference(D d, const std::uint8_t* right, std::size_t pitch) const
    {
        const auto value = hn::LoadU(d, right);
        const auto least = hn::LoadU(d, right + pitch);
        const auto most = hn::LoadU(d, right + 2 * pitch);
        return hn::Min(outside(value_, least, most), outside(value, least_, most_));
    }

private:
    static HWY_INLINE hn::Vec<D> outside(hn::Vec<D> value, hn::Vec<D> least, hn::Vec<D> most)
    {
        return hn::Max(hn::SaturatedSub(value, most), hn::SaturatedSub(least, value));
    }

    hn::Vec<D> value_;
    hn::Vec<D> least_;
    hn::Vec<D> most_;
};

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
