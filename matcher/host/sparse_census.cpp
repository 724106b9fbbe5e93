#include "matcher/host/sparse_census.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/sparse_census.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef HSGM_SPARSE_CENSUS_ROWS
#define HSGM_SPARSE_CENSUS_ROWS
namespace hsgm::matcher::host {

// The pixels of a row and of the rows 3 and 1 above it, 1 and 3 below.
struct SparseCensusRows {
    const std::uint16_t* neighbours[4];
    const std::uint16_t* centre;
};

} // namespace hsgm::matcher::host
#endif

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void sparse_census_row(const SparseCensusRows& rows, int cols, std::uint16_t* words)
{
    const hn::ScalableTag<std::uint16_t> d;
    const auto one = hn::Set(d, std::uint16_t{1});
    for (int i = 0; i < cols; i += static_cast<int>(hn::Lanes(d))) {
        const auto centre = hn::LoadU(d, rows.centre + i);
        auto word = hn::Zero(d);
        for (const std::uint16_t* row : rows.neighbours) {
            for (int step = -3; step <= 3; step += 2) {
                // More than nothing is left of the centre where the neighbour is darker.
                const auto darker =
                    hn::Min(hn::SaturatedSub(centre, hn::LoadU(d, row + i + step)), one);
                word = hn::Add(hn::Add(word, word), darker);
            }
        }
        hn::StoreU(word, d, words + i);
    }
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(sparse_census_row);

namespace {

constexpr int kOverrun = 64; // pixels that vectors may touch beyond the last one

} // namespace

SparseCensus::SparseCensus(const tiling::Patch<std::uint16_t>& image, tiling::Size full,
                           int col, int col_end)
    : image_(image), full_(full), col_(col), cols_(col_end - col)
{
    for (auto& row : rows_) {
        row.resize(static_cast<std::size_t>(cols_ + 2 * kRadius + kOverrun));
    }
}

void SparseCensus::row(int row, std::uint16_t* words)
{
    constexpr std::array<int, 5> kSteps{-3, -1, 0, 1, 3};
    const int first = std::max(col_ - kRadius, 0);
    const int last = std::min(col_ + cols_ + kRadius, full_.cols);
    for (std::size_t i = 0; i < kSteps.size(); ++i) {
        const int from = std::clamp(row + kSteps[i], 0, full_.rows - 1);
        std::uint16_t* to = rows_[i].data() + (first - (col_ - kRadius));
        std::copy_n(&image_.at(from, first), last - first, to);
        std::fill(rows_[i].data(), to, to[0]);
        std::fill_n(to + (last - first), col_ + cols_ + kRadius - last, to[last - first - 1]);
    }
    const auto at = [this](std::size_t i) { return rows_[i].data() + kRadius; };
    HWY_DYNAMIC_DISPATCH(sparse_census_row)
    ({{at(0), at(1), at(3), at(4)}, at(2)}, cols_, words);
}

} // namespace hsgm::matcher::host
#endif
