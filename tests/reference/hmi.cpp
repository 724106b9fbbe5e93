#include "tests/reference/hmi.h"

#include "tests/reference/level.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace hsgm::reference {

std::vector<double> smoothed(const std::vector<double>& line)
{
    double weights[7];
    double sum = 0;
    for (int t = -3; t <= 3; ++t) {
        weights[t + 3] = std::exp(-t * t / 2.0);
        sum += weights[t + 3];
    }
    for (double& weight : weights) {
        weight /= sum;
    }
    const int n = static_cast<int>(line.size());
    std::vector<double> result(line.size());
    for (int i = 0; i < n; ++i) {
        double value = 0;
        for (int t = -3; t <= 3; ++t) {
            const int j = std::clamp(i + t, 0, n - 1);
            value += weights[t + 3] * line[static_cast<std::size_t>(j)];
        }
        result[static_cast<std::size_t>(i)] = value;
    }
    return result;
}

Image<double> smoothed(const Image<double>& plane)
{
    Image<double> result = plane;
    for (int k = 0; k < plane.cols(); ++k) {
        std::vector<double> line;
        for (int i = 0; i < plane.rows(); ++i) {
            line.push_back(plane(i, k));
        }
        line = smoothed(line);
        for (int i = 0; i < plane.rows(); ++i) {
            result(i, k) = line[static_cast<std::size_t>(i)];
        }
    }
    for (int i = 0; i < plane.rows(); ++i) {
        const std::vector<double> line =
            smoothed(std::vector<double>(result.row(i), result.row(i) + result.cols()));
        std::copy(line.begin(), line.end(), result.row(i));
    }
    return result;
}

namespace {

/// Goes through all pairs of tones by rising mi and adds up their shares; the mi where the
/// sum first reaches `goal`.
double mi_where_sum_reaches(double goal, const Image<double>& shares, const Image<double>& mi)
{
    std::vector<std::pair<double, std::size_t>> order; // mi, 256 i + k
    for (std::size_t index = 0; index < 65536; ++index) {
        order.emplace_back(mi.pixels()[index], index);
    }
    std::sort(order.begin(), order.end());
    double sum = 0;
    for (const auto& [value, index] : order) {
        sum += shares.pixels()[index];
        if (sum >= goal) {
            return value;
        }
    }
    throw std::logic_error("the shares do not add up to one");
}

} // namespace

HmiCosts hmi_table(const JointCounts& joint)
{
    const Size size{256, 256};
    std::uint64_t total = 0;
    for (const std::uint64_t count : joint.pixels()) {
        total += count;
    }
    if (total == 0) {
        return HmiCosts(size, 24);
    }

    Image<double> P(size);
    for (int i = 0; i < 256; ++i) {
        for (int k = 0; k < 256; ++k) {
            P(i, k) = static_cast<double>(joint(i, k)) / static_cast<double>(total);
        }
    }
    P = smoothed(P);
    std::vector<double> P1(256, 0.0);
    std::vector<double> P2(256, 0.0);
    for (std::size_t i = 0; i < 256; ++i) {
        for (std::size_t k = 0; k < 256; ++k) {
            P1[i] += P(static_cast<int>(i), static_cast<int>(k));
            P2[k] += P(static_cast<int>(i), static_cast<int>(k));
        }
    }

    const auto minus_log = [](double p) { return -std::log(std::max(p, 1e-7)); };
    Image<double> h(size);
    for (int i = 0; i < 256; ++i) {
        std::transform(P.row(i), P.row(i) + 256, h.row(i), minus_log);
    }
    std::vector<double> h1(256);
    std::vector<double> h2(256);
    std::transform(P1.begin(), P1.end(), h1.begin(), minus_log);
    std::transform(P2.begin(), P2.end(), h2.begin(), minus_log);
    h = smoothed(h);
    h1 = smoothed(h1);
    h2 = smoothed(h2);

    Image<double> mi(size);
    for (int i = 0; i < 256; ++i) {
        for (int k = 0; k < 256; ++k) {
            mi(i, k) =
                h1[static_cast<std::size_t>(i)] + h2[static_cast<std::size_t>(k)] - h(i, k);
        }
    }
    // How often two tones meet: in the matches, and by chance.
    std::vector<double> H1(256, 0.0);
    std::vector<double> H2(256, 0.0);
    for (std::size_t i = 0; i < 256; ++i) {
        for (std::size_t k = 0; k < 256; ++k) {
            const auto count =
                static_cast<double>(joint(static_cast<int>(i), static_cast<int>(k)));
            H1[i] += count;
            H2[k] += count;
        }
    }
    const auto all = static_cast<double>(total);
    Image<double> matched(size);
    Image<double> chance(size);
    for (int i = 0; i < 256; ++i) {
        for (int k = 0; k < 256; ++k) {
            matched(i, k) = static_cast<double>(joint(i, k)) / all;
            chance(i, k) =
                H1[static_cast<std::size_t>(i)] * H2[static_cast<std::size_t>(k)] / (all * all);
        }
    }
    const double high = mi_where_sum_reaches(0.9, matched, mi);
    const double low = mi_where_sum_reaches(0.3, chance, mi);
    if (high <= low) {
        return HmiCosts(size, 24);
    }
    HmiCosts table(size);
    for (int i = 0; i < 256; ++i) {
        for (int k = 0; k < 256; ++k) {
            const double share = std::clamp((high - mi(i, k)) / (high - low), 0.0, 1.0);
            table(i, k) = static_cast<std::uint8_t>(std::floor(48 * share + 0.5));
        }
    }
    return table;
}

JointCounts joint_counts(const LevelPair& pair, const Image<int>& winners)
{
    JointCounts joint({256, 256}, 0);
    for (int row = 0; row < pair.left.rows(); ++row) {
        for (int x = 0; x < pair.left.cols(); ++x) {
            const int xr = x - winners(row, x);
            if (pair.left(row, x) != kNodata && xr >= 0 && xr < pair.right.cols() &&
                pair.right(row, xr) != kNodata) {
                ++joint(pair.tone_left(row, x), pair.tone_right(row, xr));
            }
        }
    }
    return joint;
}

int hmi_level_count(Size left, Size right, DisparityRange asked)
{
    Options automatic;
    automatic.mode = Mode::hsgm;
    automatic.levels = 0;
    return level_count(left, right, asked, automatic);
}

HmiCosts solve_hmi(const Image<std::uint16_t>& left, const Image<std::uint16_t>& right,
                   DisparityRange asked, ToneEnds tone_left, ToneEnds tone_right,
                   const Options& options)
{
    const int levels = hmi_level_count(left.size(), right.size(), asked);
    const Image<std::uint16_t> small_left = pyramid(left, levels).back();
    const Image<std::uint16_t> small_right = pyramid(right, levels).back();
    const DisparityRange range = level_range(asked, levels - 1, levels);

    Options gradient = options; // paths and penalties as configured
    gradient.mode = Mode::hsgm;
    HmiCosts table;
    for (int iteration = 0; iteration < 3; ++iteration) {
        gradient.cost = iteration == 0 ? Cost::census5x5 : Cost::hmi;
        const Level level = solve_level(make_level_pair(small_left, small_right, tone_left,
                                                        tone_right, gradient.cost, &table),
                                        range, true, gradient, nullptr);
        table = hmi_table(joint_counts(level.pair, level.winners));
    }
    return table;
}

} // namespace hsgm::reference
