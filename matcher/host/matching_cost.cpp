#include "matcher/host/matching_cost.h"

#include "matcher/host/coarse_start.h"
#include "matcher/host/hamming.h"
#include "matcher/host/lookup.h"
#include "matcher/kernel.h"

#include <algorithm>
#include <cstring>

namespace hsgm::matcher::host {

namespace {

// The right runs of a row, of which left pixel i meets entry cols - 1 - i + j at disparity
// number j: in place where the image reaches that far, else copied, with entries that are not
// valid where there is no image.
void set_right(const FeaturePlanes& planes, const CostVolume& volume, int row, CostRow& out,
               Buffer<std::uint8_t>& room)
{
    const int met = out.met();
    const int last_col = volume.rect.col_end() - 1 - volume.range.min;
    const int at = planes.rect().col_end() - 1 - last_col; // of the first entry in the runs
    const int begin = std::clamp(-at, 0, met);             // entries with a pixel
    const int end = std::clamp(planes.rect().cols - at, begin, met);
    if (begin == 0 && end == met) {
        out.right = planes.run(0, row) + at;
        out.right_pitch = static_cast<std::size_t>(planes.rect().cols);
        out.right_valid = planes.validity(row) + at;
        return;
    }
    out.right_pitch = static_cast<std::size_t>(met) + FeaturePlanes::kReadBeyond;
    const auto size = out.right_pitch * static_cast<std::size_t>(planes.planes() + 1);
    std::uint8_t* to = room.need(size);
    std::fill_n(to, size, std::uint8_t{0});
    out.right = to;
    out.right_valid = to + out.right_pitch * static_cast<std::size_t>(planes.planes());
    for (int plane = 0; begin < end && plane <= planes.planes(); ++plane) {
        std::copy_n(planes.run(plane, row) + at + begin, end - begin, to + begin);
        to += out.right_pitch;
    }
}

const std::uint8_t* padding(const CostRow& row, Buffer<std::uint8_t>& room)
{
    std::uint8_t* bytes = room.need(static_cast<std::size_t>(row.stride));
    std::fill_n(bytes, row.count, std::uint8_t{0});
    std::fill(bytes + row.count, bytes + row.stride, std::uint8_t{255});
    return bytes;
}

} // namespace

void matching_cost_row(const LevelFeatures& features, const PairTraits& pair, Cost cost,
                       const CostVolume& volume, int row, std::uint8_t* costs,
                       CostWorkspace& workspace)
{
    const FeaturePlanes& left = features.left;
    const int left_at = volume.rect.col - left.rect().col;
    CostRow r;
    r.cols = volume.rect.cols;
    r.count = volume.range.count();
    r.stride = volume.stride;
    r.half = static_cast<std::uint8_t>(traits(cost).max / 2);
    r.left = left.run(0, row) + left_at;
    r.left_pitch = static_cast<std::size_t>(left.rect().cols);
    r.left_valid = left.validity(row) + left_at;
    set_right(features.right, volume, row, r, workspace.right);
    r.plain = r.count == r.stride &&
              std::memchr(r.right_valid, 0, static_cast<std::size_t>(r.met())) == nullptr;
    if (!r.plain) {
        r.padding = padding(r, workspace.padding);
    }
    if (cost == Cost::hmi) {
        lookup_costs(*pair.hmi, r, costs);
    } else {
        hamming_costs(cost, r, workspace.split, costs);
    }
}

template <typename L>
void add_prior_row(const LevelFeatures& features, const LevelResult<L>& coarser,
                   const CostVolume& volume, int row, std::uint8_t* costs,
                   CostWorkspace& workspace)
{
    const int count = volume.range.count();
    std::uint8_t* prior = workspace.prior.need(2 * std::size_t(count) + 16);
    std::uint8_t* scratch = prior + count + 4;
    for (int i = 0; i < volume.rect.cols; ++i, costs += volume.stride) {
        const int col = volume.rect.col + i;
        if (features.low_texture.at(row, col) == 0) {
            continue;
        }
        const auto& block = coarser.block_at(row / 2, col / 2);
        spread_disparities(block.prior_at(row / 2, col / 2), block.range, volume.range,
                           std::uint8_t{kPriorCap}, scratch, prior);
        for (int d = 0; d < count; ++d) {
            costs[d] = static_cast<std::uint8_t>(costs[d] + (prior[d] >> 2));
        }
    }
}

template void add_prior_row(const LevelFeatures&, const LevelResult<std::uint8_t>&,
                            const CostVolume&, int, std::uint8_t*, CostWorkspace&);
template void add_prior_row(const LevelFeatures&, const LevelResult<std::uint16_t>&,
                            const CostVolume&, int, std::uint8_t*, CostWorkspace&);

} // namespace hsgm::matcher::host
