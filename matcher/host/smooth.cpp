#include "matcher/host/smooth.h"

#include <algorithm>
#include <cassert>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/smooth.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// `cols` pixels of a row from `centre` on, in whole vectors; rows are `stride` apart.
void smooth_row(const std::int32_t* HWY_RESTRICT centre, std::ptrdiff_t stride, int radius,
                int cols, std::int32_t* HWY_RESTRICT out)
{
    const hn::ScalableTag<std::int32_t> d;
    const hn::RebindToFloat<decltype(d)> real;
    const auto reach = hn::Set(d, 256);
    const auto hole = hn::Set(d, kHole);
    for (int i = 0; i < cols; i += static_cast<int>(hn::Lanes(d))) {
        const auto own = hn::LoadU(d, centre + i);
        auto sum = hn::Zero(d);
        auto count = hn::Zero(d);
        for (int row = -radius; row <= radius; ++row) {
            for (int col = -radius; col <= radius; ++col) {
                // Between a hole and a value this is far away, so a hole is never near.
                const auto off = hn::Sub(hn::LoadU(d, centre + row * stride + i + col), own);
                const auto near = hn::Not(hn::Gt(hn::Abs(off), reach));
                sum = hn::Add(sum, hn::IfThenElseZero(near, off));
                count = hn::Sub(count, hn::VecFromMask(d, near));
            }
        }
        // floor((2 sum + count) / (2 count)). Both are whole and below 2^15, and a quotient
        // that is not whole is 1/50 or more away from being so: the rounded one has the same
        // floor.
        const auto twice = hn::ConvertTo(real, hn::Add(hn::Add(sum, sum), count));
        const auto mean = hn::Div(twice, hn::ConvertTo(real, hn::Add(count, count)));
        const auto value = hn::Add(own, hn::ConvertTo(d, hn::Floor(mean)));
        hn::StoreU(hn::IfThenElse(hn::Eq(own, hole), hole, value), d, out + i);
    }
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(smooth_row);

namespace {

constexpr int kOverrun = 64; // whole vectors are written

} // namespace

tiling::Patch<std::int32_t> smoothed(const tiling::Patch<std::int32_t>& disparities, int side,
                                     const tiling::Rect& wanted)
{
    assert(side / 2 <= DisparityPlane::kFrameRows);
    const tiling::Rect& rect = disparities.rect;
    DisparityPlane plane(rect);
    for (int row = rect.row; row < rect.row_end(); ++row) {
        std::copy_n(disparities.pixels.row(row - rect.row), rect.cols, plane.at(row, rect.col));
    }
    const std::ptrdiff_t stride = plane.at(rect.row + 1, 0) - plane.at(rect.row, 0);
    tiling::Patch<std::int32_t> result(wanted, kHole);
    std::vector<std::int32_t> of_row(std::size_t(wanted.cols + kOverrun));
    for (int row = wanted.row; row < wanted.row_end(); ++row) {
        HWY_DYNAMIC_DISPATCH(smooth_row)
        (plane.at(row, wanted.col), stride, side / 2, wanted.cols, of_row.data());
        std::copy_n(of_row.data(), wanted.cols, result.pixels.row(row - wanted.row));
    }
    return result;
}

std::int64_t smooth_bytes(tiling::Size size)
{
    return DisparityPlane::bytes(size) +
           (size.cols + kOverrun) * static_cast<std::int64_t>(sizeof(std::int32_t));
}

} // namespace hsgm::matcher::host
#endif
