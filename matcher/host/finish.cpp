#include "matcher/host/finish.h"

#include "matcher/host/disparity_plane.h"
#include "matcher/reasons.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/finish.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void finish_pixels(const FinishedRow& row, float nodata, std::uint8_t interpolated,
                   float* disparity_px, std::uint8_t* confidence)
{
    const hn::ScalableTag<float> df;
    const hn::RebindToSigned<decltype(df)> d;
    const hn::Rebind<std::uint16_t, decltype(d)> d16;
    const hn::Rebind<std::uint8_t, decltype(d)> d8;
    const auto one = [&](int i) HWY_ATTR {
        const auto value = hn::LoadU(d, row.disparity_q8 + i);
        const auto hole = hn::Eq(value, hn::Set(d, kHole));
        const auto px = hn::Mul(hn::ConvertTo(df, value), hn::Set(df, 1.0F / 256.0F));
        hn::StoreU(hn::IfThenElse(hn::RebindMask(df, hole), hn::Set(df, nodata), px), df,
                   disparity_px + i);
        const auto bits = hn::PromoteTo(d, hn::LoadU(d16, row.reasons + i));
        const auto made_up = hn::Ne(hn::And(bits, hn::Set(d, kInterpolated)), hn::Zero(d));
        const auto measured = hn::PromoteTo(d, hn::LoadU(d8, row.measured + i));
        const auto trust = hn::IfThenZeroElse(
            hole, hn::IfThenElse(made_up, hn::Set(d, interpolated), measured));
        hn::StoreU(hn::DemoteTo(d8, trust), d8, confidence + i);
    };
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int i = 0; i + lanes <= row.cols; i += lanes) {
        one(i);
    }
    if (row.cols >= lanes) {
        one(row.cols - lanes); // some once more
    }
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(finish_pixels);

namespace {

constexpr int kMostLanes = 64;

template <typename T>
T* copy(const T* from, int count, T* to)
{
    std::copy_n(from, count, to);
    return to;
}

// Rows that may be shorter than a vector.
void finish_short_row(const FinishedRow& row, float nodata, std::uint8_t interpolated,
                      float* disparity_px, std::uint8_t* confidence)
{
    std::int32_t values[kMostLanes] = {};
    std::uint16_t reasons[kMostLanes] = {};
    std::uint8_t measured[kMostLanes] = {};
    float px[kMostLanes];
    std::uint8_t trust[kMostLanes];
    const FinishedRow padded{copy(row.disparity_q8, row.cols, values),
                             copy(row.reasons, row.cols, reasons),
                             copy(row.measured, row.cols, measured), kMostLanes};
    HWY_DYNAMIC_DISPATCH(finish_pixels)(padded, nodata, interpolated, px, trust);
    std::copy_n(px, row.cols, disparity_px);
    std::copy_n(trust, row.cols, confidence);
}

} // namespace

void finish_row(const FinishedRow& row, float nodata, std::uint8_t interpolated,
                float* disparity_px, std::uint8_t* confidence)
{
    if (row.cols < kMostLanes) {
        finish_short_row(row, nodata, interpolated, disparity_px, confidence);
        return;
    }
    HWY_DYNAMIC_DISPATCH(finish_pixels)(row, nodata, interpolated, disparity_px, confidence);
}

} // namespace hsgm::matcher::host
#endif
