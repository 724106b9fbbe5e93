#include "pipeline/evaluate/seam_score.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace hsgm::evaluate {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void require(bool holds, const char* option, double value, const char* allowed)
{
    if (!holds) {
        throw std::invalid_argument(std::string(option) + " is " + std::to_string(value) +
                                    "; allowed: " + allowed);
    }
}

// SplitMix64: our own generator, since the standard library's distributions differ
// between implementations.
std::uint64_t next_random(std::uint64_t& state)
{
    state += 0x9e3779b97f4a7c15u;
    std::uint64_t x = state;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

} // namespace

void SeamOptions::validate() const
{
    require(cell_px >= 2, "cell_px", cell_px, "2 and above");
    require(cap_px > 0, "cap_px", cap_px, "above 0");
    require(far_px >= 0, "far_px", far_px, "0 and above");
    require(resamples >= 1, "resamples", resamples, "1 and above");
}

void SeamScorer::Sums::add(const Sums& other)
{
    border_px += other.border_px;
    far_px += other.far_px;
    border_pairs += other.border_pairs;
    far_pairs += other.far_pairs;
}

double SeamScorer::Sums::ratio() const
{
    if (border_pairs == 0 || far_pairs == 0 || far_px == 0) {
        return kNan;
    }
    return border_px / static_cast<double>(border_pairs) /
           (far_px / static_cast<double>(far_pairs));
}

SeamScorer::SeamScorer(const SeamOptions& options) : options_(options)
{
    options_.validate();
}

// The distance of a pixel centre from the nearest line is offset + 0.5, from either side.
bool SeamScorer::is_far(int index) const
{
    const int offset = index % options_.cell_px;
    return std::min(offset, options_.cell_px - 1 - offset) + 0.5 > options_.far_px;
}

void SeamScorer::add_pair(double a_px, double b_px, bool straddles, bool is_far,
                          Sums& sums) const
{
    const double jump_px = std::min(std::abs(a_px - b_px), options_.cap_px);
    if (std::isnan(a_px) || std::isnan(b_px)) {
        return;
    }
    if (straddles) {
        sums.border_px += jump_px;
        ++sums.border_pairs;
    } else if (is_far) {
        sums.far_px += jump_px;
        ++sums.far_pairs;
    }
}

void SeamScorer::add_row(std::span<const float> test_px, std::span<const float> truth_px,
                         std::span<const std::uint8_t> mask)
{
    assert(truth_px.empty() || truth_px.size() == test_px.size());
    assert(mask.empty() || mask.size() == test_px.size());
    const int cols = static_cast<int>(test_px.size());
    current_.resize(test_px.size());
    for (int c = 0; c < cols; ++c) {
        const double e = static_cast<double>(test_px[c]) - (truth_px.empty() ? 0 : truth_px[c]);
        current_[c] = std::isfinite(e) && (mask.empty() || mask[c] != 0) ? e : kNan;
    }
    const int row = static_cast<int>(rows_.size());
    const bool row_straddles = row % options_.cell_px == 0;
    const bool row_far = is_far(row);
    const bool pair_of_rows_far = row > 0 && row_far && is_far(row - 1);
    Sums sums;
    for (int c = 0; c < cols; ++c) {
        const bool col_far = is_far(c);
        if (c + 1 < cols) {
            add_pair(current_[c], current_[c + 1], (c + 1) % options_.cell_px == 0,
                     row_far && col_far && is_far(c + 1), sums);
        }
        if (row > 0) {
            add_pair(previous_[c], current_[c], row_straddles, pair_of_rows_far && col_far,
                     sums);
        }
    }
    rows_.push_back(sums);
    std::swap(previous_, current_);
}

// Rows are drawn with replacement: neighbouring pixels of a row are far from independent,
// rows are closer to it. Resamples without any pair on one side are left out.
void SeamScorer::bootstrap(SeamScore& score) const
{
    std::vector<double> ratios;
    std::uint64_t state = options_.seed;
    for (int i = 0; i < options_.resamples; ++i) {
        Sums sums;
        for (std::size_t n = 0; n < rows_.size(); ++n) {
            sums.add(rows_[next_random(state) % rows_.size()]);
        }
        if (!std::isnan(sums.ratio())) {
            ratios.push_back(sums.ratio());
        }
    }
    if (ratios.empty()) {
        score.ratio_low = score.ratio_high = kNan;
        return;
    }
    std::sort(ratios.begin(), ratios.end());
    const auto at = [&](double share) {
        return ratios[static_cast<std::size_t>(share * static_cast<double>(ratios.size() - 1))];
    };
    score.ratio_low = at(0.025);
    score.ratio_high = at(0.975);
}

SeamScore SeamScorer::score() const
{
    Sums all;
    for (const Sums& row : rows_) {
        all.add(row);
    }
    SeamScore score;
    score.ratio = all.ratio();
    score.border_pairs = all.border_pairs;
    score.far_pairs = all.far_pairs;
    score.border_jump_px = all.border_px / static_cast<double>(all.border_pairs);
    score.far_jump_px = all.far_px / static_cast<double>(all.far_pairs);
    bootstrap(score);
    return score;
}

} // namespace hsgm::evaluate
