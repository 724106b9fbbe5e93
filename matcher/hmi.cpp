#include "matcher/hmi.h"

#include "matcher/matcher.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace hsgm::matcher {

namespace {

constexpr int kTones = 256;
constexpr int kCostMax = 48;
constexpr int kRounds = 3;
constexpr double kMatchedShare = 0.9;
constexpr double kChanceShare = 0.3;

// 7 taps of a Gaussian with sigma 1, normalised.
std::array<double, 7> gaussian()
{
    std::array<double, 7> taps{};
    double sum = 0;
    for (int i = -3; i <= 3; ++i) {
        taps[std::size_t(i + 3)] = std::exp(-0.5 * i * i);
        sum += taps[std::size_t(i + 3)];
    }
    for (double& tap : taps) {
        tap /= sum;
    }
    return taps;
}

// Smooths `count` values that lie `step` apart, replicating the ends.
void smooth_line(double* values, std::ptrdiff_t step, int count)
{
    static const std::array<double, 7> taps = gaussian();
    std::vector<double> in(std::size_t{kTones});
    for (int i = 0; i < count; ++i) {
        in[std::size_t(i)] = values[i * step];
    }
    for (int i = 0; i < count; ++i) {
        double sum = 0;
        for (int t = -3; t <= 3; ++t) {
            sum += taps[std::size_t(t + 3)] * in[std::size_t(std::clamp(i + t, 0, count - 1))];
        }
        values[i * step] = sum;
    }
}

void smooth_plane(std::vector<double>& plane)
{
    for (int k = 0; k < kTones; ++k) {
        smooth_line(plane.data() + k, kTones, kTones);
    }
    for (int i = 0; i < kTones; ++i) {
        smooth_line(plane.data() + std::ptrdiff_t{kTones} * i, 1, kTones);
    }
}

// -ln of a probability, bounded where tones never met.
void to_entropy(std::vector<double>& probabilities)
{
    for (double& p : probabilities) {
        p = -std::log(std::max(p, 1e-7));
    }
}

std::vector<double> mutual_information(const JointHistogram& joint, double total)
{
    std::vector<double> plane(joint.size());
    std::transform(joint.begin(), joint.end(), plane.begin(),
                   [total](std::uint64_t n) { return static_cast<double>(n) / total; });
    smooth_plane(plane);
    std::vector<double> left(std::size_t{kTones});
    std::vector<double> right(std::size_t{kTones});
    for (std::size_t i = 0; i < kTones; ++i) {
        for (std::size_t k = 0; k < kTones; ++k) {
            left[i] += plane[i * kTones + k];
            right[k] += plane[i * kTones + k];
        }
    }
    to_entropy(plane);
    to_entropy(left);
    to_entropy(right);
    smooth_plane(plane);
    smooth_line(left.data(), 1, kTones);
    smooth_line(right.data(), 1, kTones);
    for (std::size_t i = 0; i < kTones; ++i) {
        for (std::size_t k = 0; k < kTones; ++k) {
            plane[i * kTones + k] = left[i] + right[k] - plane[i * kTones + k];
        }
    }
    return plane;
}

// The information that most true matches reach, and the one that chance meetings reach.
struct Quantiles {
    double high;
    double low;
    std::vector<double> information;
};

Quantiles quantiles(const JointHistogram& joint, double total, std::vector<double> information)
{
    std::vector<double> left(std::size_t{kTones});
    std::vector<double> right(std::size_t{kTones});
    for (std::size_t i = 0; i < joint.size(); ++i) {
        left[i / kTones] += static_cast<double>(joint[i]);
        right[i % kTones] += static_cast<double>(joint[i]);
    }
    std::vector<std::size_t> order(joint.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return information[a] < information[b];
    });
    const auto reaching = [&](double share, auto weight) {
        double sum = 0;
        for (const std::size_t i : order) {
            sum += weight(i);
            if (sum >= share) {
                return information[i];
            }
        }
        return information[order.back()];
    };
    const double high = reaching(
        kMatchedShare, [&](std::size_t i) { return static_cast<double>(joint[i]) / total; });
    const double low = reaching(kChanceShare, [&](std::size_t i) {
        return left[i / kTones] * right[i % kTones] / (total * total);
    });
    return {high, low, std::move(information)};
}

JointHistogram matched_tones(const TileMatch& match, const PairTraits& pair,
                             tiling::ImageView<const std::uint16_t> left,
                             tiling::ImageView<const std::uint16_t> right)
{
    JointHistogram joint{};
    for (int row = 0; row < left.rows(); ++row) {
        for (int col = 0; col < left.cols(); ++col) {
            const int other = col - winner_of(match.disparity_q8(row, col));
            if (other < 0 || other >= right.cols() || !is_valid(left(row, col)) ||
                !is_valid(right(row, other))) {
                continue;
            }
            ++joint[pair.left_tone(left(row, col)) * 256u + pair.right_tone(right(row, other))];
        }
    }
    return joint;
}

// The level on its own, as a pair to be solved whole.
Options whole_level_options(const Options& options, Cost cost)
{
    Options o = options;
    o.mode = Mode::sgm;
    o.cost = cost;
    return o;
}

} // namespace

std::shared_ptr<const HmiTable> make_hmi_table(const JointHistogram& joint)
{
    auto table = std::make_shared<HmiTable>();
    table->cost.fill(kCostMax / 2);
    const std::uint64_t total = std::accumulate(joint.begin(), joint.end(), std::uint64_t{0});
    if (total == 0) {
        return table;
    }
    const Quantiles q = quantiles(joint, static_cast<double>(total),
                                  mutual_information(joint, static_cast<double>(total)));
    if (q.high > q.low) {
        std::transform(
            q.information.begin(), q.information.end(), table->cost.begin(), [&q](double mi) {
                const double badness = std::clamp((q.high - mi) / (q.high - q.low), 0.0, 1.0);
                return static_cast<std::uint8_t>(std::floor(kCostMax * badness + 0.5));
            });
    }
    return table;
}

int hmi_level(const PairShape& shape)
{
    return plan_levels(shape, Options{}).levels() - 1;
}

std::shared_ptr<const HmiTable> solve_hmi_table(const PairTraits& pair, const Options& options,
                                                tiling::ImageView<const std::uint16_t> left,
                                                tiling::ImageView<const std::uint16_t> right)
{
    PairTraits level = pair;
    level.shape = {left.size(), right.size(), plan_levels(pair.shape, Options{}).ranges.back()};
    Cost cost = Cost::census5x5;
    for (int round = 0; round < kRounds; ++round) {
        const Matcher matcher(level, whole_level_options(options, cost));
        const auto solution = matcher.solve_coarse(left, right);
        const TileMatch match =
            matcher.match_tile(rect_of(left.size()), std::span<const LevelImages>{}, *solution);
        level.hmi = make_hmi_table(matched_tones(match, level, left, right));
        cost = Cost::hmi;
    }
    return level.hmi;
}

} // namespace hsgm::matcher
