#include "matcher/host/matching_cost.h"

#include "matcher/host/birchfield_tomasi.h"
#include "matcher/host/hamming.h"
#include "matcher/host/lookup.h"
#include "matcher/host/prior.h"

#include <algorithm>
#include <cstring>

namespace hsgm::matcher::host {

namespace {

// The right runs of a row, of which left pixel i meets entry cols - 1 - i + j at disparity
// number j: in place where the image reaches that far, else copied, with entries that are not
// valid where there is no image. `last_col` is the column of the first entry. Returns whether
// all entries are valid.
bool set_right(const FeaturePlanes& planes, int row, int last_col, CostRow& out,
               Buffer<std::uint8_t>& room)
{
    const int met = out.met();
    const int at = planes.rect().col_end() - 1 - last_col;
    const int begin = std::clamp(-at, 0, met); // entries with a pixel
    const int end = std::clamp(planes.rect().cols - at, begin, met);
    if (begin == 0 && end == met) {
        out.right = planes.run(0, row) + at;
        out.right_pitch = static_cast<std::size_t>(planes.rect().cols);
        out.right_valid = planes.validity(row) + at;
        return !planes.has_gaps() ||
               std::memchr(out.right_valid, 0, static_cast<std::size_t>(met)) == nullptr;
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
    return false;
}

const std::uint8_t* padding(const CostRow& row, Buffer<std::uint8_t>& room)
{
    std::uint8_t* bytes = room.need(static_cast<std::size_t>(row.stride));
    std::fill_n(bytes, row.count, std::uint8_t{0});
    std::fill(bytes + row.count, bytes + row.stride, std::uint8_t{255});
    return bytes;
}

// The pixels [col, col_end) of a row.
CostRow cost_row(const LevelFeatures& features, const CostVolume& volume, int row, int col,
                 int col_end, int half, CostWorkspace& workspace)
{
    const FeaturePlanes& left = features.left;
    const int left_at = col - left.rect().col;
    CostRow r;
    r.cols = col_end - col;
    r.count = volume.range.count();
    r.stride = volume.stride;
    r.half = static_cast<std::uint8_t>(half);
    r.left = left.run(0, row) + left_at;
    r.left_pitch = static_cast<std::size_t>(left.rect().cols);
    r.left_valid = left.validity(row) + left_at;
    const bool all_valid =
        set_right(features.right, row, col_end - 1 - volume.range.min, r, workspace.right);
    r.plain = all_valid && r.count == r.stride;
    if (!r.plain) {
        r.padding = padding(r, workspace.padding);
    }
    return r;
}

// Sums over three columns of the rows round `row`, of which those known from the rows before
// are not made again.
void block_row(const LevelFeatures& features, const CostVolume& volume, int row,
               std::uint8_t* costs, CostWorkspace& workspace)
{
    BlockRows& block = workspace.block;
    const tiling::Rect& rect = volume.rect;
    const tiling::Size image = features.left_size;
    const bool known = block.features == features.number && block.rect == rect &&
                       block.range == volume.range && block.last_row == row;
    const auto pitch = std::size_t(rect.cols) * std::size_t(volume.stride);
    std::uint8_t* sums = block.sums.need(3 * pitch);
    const int begin = std::max(rect.col - 1, 0);
    const int end = std::min(rect.col_end() + 1, image.cols);
    std::uint8_t* differences =
        block.differences.need(std::size_t(end - begin) * std::size_t(volume.stride));
    const int last = std::min(row + 1, image.rows - 1);
    for (int r = known ? row + 1 : std::max(row - 1, 0); r <= last; ++r) {
        difference_sums(cost_row(features, volume, r, begin, end, kHalfDifference, workspace),
                        rect.col - begin, end - rect.col_end(), differences,
                        sums + std::size_t(r % 3) * pitch);
    }
    block.features = features.number;
    block.rect = rect;
    block.range = volume.range;
    block.last_row = row + 1;
    const auto of_row = [&](int r) { return sums + std::size_t(r % 3) * pitch; };
    const std::uint8_t* const three[3] = {of_row(std::max(row - 1, 0)), of_row(row),
                                          of_row(last)};
    block_costs(three,
                cost_row(features, volume, row, rect.col, rect.col_end(),
                         traits(Cost::birchfield_tomasi).max / 2, workspace),
                costs);
}

} // namespace

void matching_cost_row(const LevelFeatures& features, const PairTraits& pair, Cost cost,
                       const CostVolume& volume, int row, std::uint8_t* costs,
                       CostWorkspace& workspace)
{
    if (cost == Cost::birchfield_tomasi) {
        block_row(features, volume, row, costs, workspace);
        return;
    }
    const CostRow r = cost_row(features, volume, row, volume.rect.col, volume.rect.col_end(),
                               traits(cost).max / 2, workspace);
    if (cost == Cost::hmi) {
        lookup_costs(*pair.hmi, r, costs);
    } else {
        hamming_costs(cost, r, costs);
    }
}

template <typename L>
void add_prior_row(const LevelFeatures& features, const LevelResult<L>& coarser,
                   const CostVolume& volume, int row, std::uint8_t* costs,
                   CostWorkspace& workspace)
{
    const tiling::Rect& rect = volume.rect;
    for (int col = rect.col; col < rect.col_end();) {
        const auto& block = coarser.block_at(row / 2, col / 2);
        PriorRun run;
        run.col = col;
        run.cols = std::min(rect.col_end(), 2 * block.core.col_end()) - col;
        run.low_texture = &features.low_texture.at(row, col);
        run.fine = volume.range;
        run.coarse = block.range;
        run.values = block.prior_at(row / 2, col / 2);
        run.pitch = block.stride;
        run.end = block.prior.data() + block.prior.size();
        add_prior(run, costs + std::ptrdiff_t{col - rect.col} * volume.stride, volume.stride,
                  workspace.prior);
        col += run.cols;
    }
}

template void add_prior_row(const LevelFeatures&, const LevelResult<std::uint8_t>&,
                            const CostVolume&, int, std::uint8_t*, CostWorkspace&);
template void add_prior_row(const LevelFeatures&, const LevelResult<std::uint16_t>&,
                            const CostVolume&, int, std::uint8_t*, CostWorkspace&);

} // namespace hsgm::matcher::host
