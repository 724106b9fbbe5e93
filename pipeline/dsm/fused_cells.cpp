#include "pipeline/dsm/fused_cells.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

namespace hsgm::dsm {

namespace {

struct Vote {
    double height = 0;
    double weight = 0;
    double spread = 0;
    double confidence = 0;
    int points = 0;
};

double weight_of(double confidence, double spread, double floor)
{
    return confidence * confidence / (spread + floor);
}

/// The votes of one cell, in order of height.
void gather(std::span<const ReasonedCells> pairs, int row, int col, double floor,
            std::vector<Vote>& votes)
{
    votes.clear();
    for (const ReasonedCells& pair : pairs) {
        const Cells& cells = pair.cells;
        if (cells.height(row, col) != kNoHeight) {
            const double confidence = std::max<double>(cells.confidence(row, col), 1);
            const double spread = double{cells.spread(row, col)};
            votes.push_back({double{cells.height(row, col)},
                             weight_of(confidence, spread, floor), spread, confidence,
                             cells.points(row, col)});
        }
    }
    std::sort(votes.begin(), votes.end(), [](const Vote& a, const Vote& b) {
        return std::tie(a.height, a.weight, a.spread, a.points) <
               std::tie(b.height, b.weight, b.spread, b.points);
    });
}

double weighted_median(const std::vector<Vote>& votes)
{
    double all = 0;
    for (const Vote& vote : votes) {
        all += vote.weight;
    }
    double sum = 0;
    for (const Vote& vote : votes) {
        sum += vote.weight;
        if (2 * sum >= all) {
            return vote.height;
        }
    }
    return votes.back().height; // rounding alone brings us here
}

void put(const std::vector<Vote>& votes, double gap_m, int row, int col, FusedCells& fused)
{
    const double median = weighted_median(votes);
    double weight = 0;
    double height = 0;
    double confidence = 0;
    int points = 0;
    int count = 0;
    const auto agrees = [&](const Vote& vote) {
        return std::abs(vote.height - median) <= gap_m;
    };
    for (const Vote& vote : votes) {
        if (agrees(vote)) {
            weight += vote.weight;
            height += vote.weight * vote.height;
            confidence += vote.weight * vote.confidence;
            points += vote.points;
            ++count;
        }
    }
    height /= weight;
    double square = 0;
    for (const Vote& vote : votes) {
        if (agrees(vote)) {
            const double off = vote.height - height;
            square += vote.weight * (vote.spread * vote.spread + off * off);
        }
    }
    Cells& cells = fused.of.cells;
    cells.height(row, col) = static_cast<float>(height);
    cells.spread(row, col) = static_cast<float>(std::sqrt(square / weight));
    cells.points(row, col) = static_cast<std::uint8_t>(std::min(points, 255));
    cells.confidence(row, col) =
        static_cast<std::uint8_t>(std::floor(confidence / weight + 0.5));
    fused.pairs(row, col) = static_cast<std::uint8_t>(std::min(count, 255));
}

} // namespace

FusedCells fuse(std::span<const ReasonedCells> pairs, double gap_m, double spread_floor_m)
{
    const tiling::Size size = pairs.front().reasons.size();
    FusedCells fused{{Cells(size), tiling::Image<std::uint8_t>(size)},
                     tiling::Image<std::uint8_t>(size)};
    std::vector<Vote> votes;
    for (int r = 0; r < size.rows; ++r) {
        for (int c = 0; c < size.cols; ++c) {
            gather(pairs, r, c, spread_floor_m, votes);
            if (!votes.empty()) {
                put(votes, gap_m, r, c, fused);
                continue;
            }
            for (const ReasonedCells& pair : pairs) {
                fused.of.reasons(r, c) = std::max(fused.of.reasons(r, c), pair.reasons(r, c));
            }
        }
    }
    return fused;
}

namespace {

template <typename Exempt>
void remove_below(ReasonedCells& cells, int least, const Exempt& exempt)
{
    for (int row = 0; row < cells.reasons.rows(); ++row) {
        for (int col = 0; col < cells.reasons.cols(); ++col) {
            if (cells.cells.height(row, col) != kNoHeight &&
                cells.cells.confidence(row, col) < least && !exempt(row, col)) {
                cells.cells.clear(row, col);
                cells.reasons(row, col) = static_cast<std::uint8_t>(Missing::uncertain);
            }
        }
    }
}

} // namespace

void remove_uncertain(ReasonedCells& cells, int least)
{
    remove_below(cells, least, [](int, int) { return false; });
}

void remove_uncertain(FusedCells& cells, int least)
{
    remove_below(cells.of, least, [&](int row, int col) { return cells.pairs(row, col) > 1; });
    for (std::int64_t i = 0; i < cells.pairs.size().area(); ++i) {
        if (cells.of.reasons.data()[i] != static_cast<std::uint8_t>(Missing::none)) {
            cells.pairs.data()[i] = 0;
        }
    }
}

} // namespace hsgm::dsm
