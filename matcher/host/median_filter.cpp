#include "matcher/host/median_filter.h"

#include <algorithm>
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/median_filter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef HSGM_MEDIAN_ROWS
#define HSGM_MEDIAN_ROWS
namespace hsgm::matcher::host {

// A row and its neighbours.
using MedianRows = std::array<const std::int32_t*, 3>;

} // namespace hsgm::matcher::host
#endif

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Values = hn::ScalableTag<std::int32_t>;
using Vector = hn::Vec<Values>;

HWY_INLINE void sort(Vector& a, Vector& b)
{
    const Vector low = hn::Min(a, b);
    b = hn::Max(a, b);
    a = low;
}

HWY_INLINE Vector middle_of(Vector a, Vector b, Vector c)
{
    sort(a, b);
    return hn::Max(a, hn::Min(b, c));
}

// The middle one of nine: of sorted columns, the middle one of the greatest low, the middle
// middle and the least high (Paeth, Graphics Gems 1990).
HWY_INLINE Vector median_of(Vector (&v)[9])
{
    for (int c = 0; c < 3; ++c) {
        sort(v[c], v[3 + c]);
        sort(v[3 + c], v[6 + c]);
        sort(v[c], v[3 + c]);
    }
    return middle_of(hn::Max(hn::Max(v[0], v[1]), v[2]), middle_of(v[3], v[4], v[5]),
                     hn::Min(hn::Min(v[6], v[7]), v[8]));
}

// Holes become, in turns, less and more than every value, less first: so the middle one of all
// nine is the lower middle one of the values.
HWY_INLINE void hide_holes(Vector (&v)[9])
{
    const Values d;
    const auto hole = hn::Set(d, kHole);
    auto turn = hn::Set(d, -kHole);
    for (Vector& value : v) {
        const auto is_hole = hn::Eq(value, hole);
        value = hn::IfThenElse(is_hole, turn, value);
        turn = hn::IfThenElse(is_hole, hn::Neg(turn), turn);
    }
}

void medians_of_nine(const MedianRows& rows, int cols, std::int32_t* out)
{
    const Values d;
    const auto hole = hn::Set(d, kHole);
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int i = 0; i < cols; i += lanes) {
        Vector v[9];
        auto most = hn::Set(d, -kHole);
        for (int k = 0; k < 9; ++k) {
            v[k] = hn::LoadU(d, rows[static_cast<std::size_t>(k / 3)] + i + k % 3 - 1);
            most = hn::Max(most, v[k]);
        }
        const Vector centre = v[4];
        if (!hn::AllTrue(d, hn::Ne(most, hole))) {
            hide_holes(v);
        }
        hn::StoreU(hn::IfThenElse(hn::Eq(centre, hole), hole, median_of(v)), d, out + i);
    }
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(medians_of_nine);

namespace {

std::int32_t median_at(const DisparityPlane& disparities, int row, int col, int radius)
{
    std::array<std::int32_t, 25> values{};
    std::ptrdiff_t count = 0;
    for (int r = row - radius; r <= row + radius; ++r) {
        const std::int32_t* around = disparities.at(r, col);
        for (int step = -radius; step <= radius; ++step) {
            if (around[step] != kHole) {
                values[static_cast<std::size_t>(count++)] = around[step];
            }
        }
    }
    const auto middle = values.begin() + (count - 1) / 2;
    std::nth_element(values.begin(), middle, values.begin() + count);
    return *middle;
}

} // namespace

tiling::Patch<std::int32_t> medians(const DisparityPlane& disparities, int side,
                                    const tiling::Rect& wanted)
{
    constexpr int kOverrun = 64;
    tiling::Patch<std::int32_t> result(wanted, kHole);
    std::vector<std::int32_t> of_row(std::size_t(wanted.cols + kOverrun));
    for (int row = wanted.row; row < wanted.row_end(); ++row) {
        std::int32_t* out = result.pixels.row(row - wanted.row);
        const std::int32_t* values = disparities.at(row, wanted.col);
        if (side == 3) {
            HWY_DYNAMIC_DISPATCH(medians_of_nine)
            ({disparities.at(row - 1, wanted.col), values, disparities.at(row + 1, wanted.col)},
             wanted.cols, of_row.data());
            std::copy_n(of_row.data(), wanted.cols, out);
            continue;
        }
        for (int i = 0; i < wanted.cols; ++i) {
            if (values[i] != kHole) {
                out[i] = median_at(disparities, row, wanted.col + i, side / 2);
            }
        }
    }
    return result;
}

} // namespace hsgm::matcher::host
#endif
