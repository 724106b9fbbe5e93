#include "pipeline/dsm/cell_block.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

namespace hsgm::dsm {

using tiling::Rect;

CellBlock::CellBlock(const DsmGrid& grid, const Rect& cells, const CellOptions& options)
    : grid_(grid), cells_(cells), options_(options),
      margin_(std::max(1, static_cast<int>(std::ceil(options.radius / grid.cell)))),
      bins_{cells.row - margin_, cells.col - margin_, cells.rows + 2 * margin_,
            cells.cols + 2 * margin_},
      reach_(grid.bounds(bins_))
{
}

void CellBlock::add(double x, double y, double height, std::uint8_t confidence)
{
    const double col =
        std::floor(x / grid_.cell) - static_cast<double>(grid_.first_col + bins_.col);
    const double row =
        std::floor(-y / grid_.cell) - static_cast<double>(grid_.first_row + bins_.row);
    if (col >= 0 && row >= 0 && col < bins_.cols && row < bins_.rows) {
        const auto bin = static_cast<std::uint32_t>(row) * std::uint32_t(bins_.cols) +
                         static_cast<std::uint32_t>(col);
        points_.push_back({x, y, height, bin, confidence});
    }
}

// By bin, and within it by something that does not depend on the order of arrival.
void CellBlock::sort_points()
{
    std::sort(points_.begin(), points_.end(), [](const Point& a, const Point& b) {
        return std::tie(a.bin, a.height, a.x, a.y, a.confidence) <
               std::tie(b.bin, b.height, b.x, b.y, b.confidence);
    });
    first_of_bin_.assign(static_cast<std::size_t>(bins_.area()) + 1, 0);
    for (const Point& point : points_) {
        ++first_of_bin_[point.bin + 1];
    }
    for (std::size_t i = 1; i < first_of_bin_.size(); ++i) {
        first_of_bin_[i] += first_of_bin_[i - 1];
    }
}

void CellBlock::gather(int row, int col, std::vector<Member>& members) const
{
    const double x = grid_.x(col);
    const double y = grid_.y(row);
    const double radius2 = options_.radius * options_.radius;
    members.clear();
    for (int r = row - margin_; r <= row + margin_; ++r) {
        const auto bin = static_cast<std::size_t>(r - bins_.row) * std::size_t(bins_.cols) +
                         static_cast<std::size_t>(col - margin_ - bins_.col);
        const std::size_t end = first_of_bin_[bin + std::size_t(2 * margin_ + 1)];
        for (std::size_t i = first_of_bin_[bin]; i < end; ++i) {
            const Point& p = points_[i];
            const double distance2 = (p.x - x) * (p.x - x) + (p.y - y) * (p.y - y);
            if (distance2 < radius2) {
                const double near = 1 - distance2 / radius2;
                members.push_back(
                    {p.height, p.x, p.y, near * near * p.confidence, double(p.confidence)});
            }
        }
    }
    std::sort(members.begin(), members.end(), [](const Member& a, const Member& b) {
        return std::tie(a.height, a.x, a.y, a.weight) < std::tie(b.height, b.x, b.y, b.weight);
    });
}

namespace {

template <typename Member>
double weight_of(std::span<const Member> layer)
{
    double sum = 0;
    for (const Member& member : layer) {
        sum += member.weight;
    }
    return sum;
}

// The layer of greatest weight; members are in order of height.
template <typename Member>
std::span<const Member> heaviest_layer(std::span<const Member> members, double gap)
{
    std::span<const Member> best;
    double best_weight = -1;
    std::size_t first = 0;
    for (std::size_t i = 1; i <= members.size(); ++i) {
        if (i < members.size() && members[i].height - members[i - 1].height <= gap) {
            continue;
        }
        const auto layer = members.subspan(first, i - first);
        const double weight = weight_of(layer);
        if (weight >= best_weight) {
            best = layer;
            best_weight = weight;
        }
        first = i;
    }
    return best;
}

} // namespace

Cells CellBlock::finish()
{
    sort_points();
    Cells cells(cells_.size());
    std::vector<Member> members;
    for (int r = 0; r < cells_.rows; ++r) {
        for (int c = 0; c < cells_.cols; ++c) {
            gather(cells_.row + r, cells_.col + c, members);
            const auto layer =
                heaviest_layer(std::span<const Member>(members), options_.layer_gap);
            if (layer.empty()) {
                continue;
            }
            const double weight = weight_of(layer);
            const double all = weight_of(std::span<const Member>(members));
            double height = 0;
            double confidence = 0;
            for (const Member& member : layer) {
                height += member.weight * member.height;
                confidence += member.weight * member.confidence;
            }
            height /= weight;
            double square = 0;
            for (const Member& member : layer) {
                square += member.weight * (member.height - height) * (member.height - height);
            }
            cells.height(r, c) = static_cast<float>(height);
            cells.spread(r, c) = static_cast<float>(std::sqrt(square / weight));
            cells.points(r, c) =
                static_cast<std::uint8_t>(std::min<std::size_t>(layer.size(), 255));
            cells.confidence(r, c) =
                static_cast<std::uint8_t>(std::max(1.0, std::floor(confidence / all + 0.5)));
        }
    }
    return cells;
}

} // namespace hsgm::dsm
