#include "pipeline/stages/evaluate_stage.h"

#include "io/error.h"

#include <array>
#include <stdexcept>

namespace hsgm::pipeline {

namespace {

// The accumulators know nothing of our errors: what they refuse is the user's mistake.
template <typename Make>
auto as_config_error(Make make)
{
    try {
        return make();
    } catch (const std::invalid_argument& refused) {
        throw io::ConfigError(refused.what());
    }
}

evaluate::SeamScorer seam_scorer(int cell_px)
{
    evaluate::SeamOptions options;
    options.cell_px = cell_px;
    return evaluate::SeamScorer(options);
}

} // namespace

evaluate::DisparityScore score_disparity(const DisparityInputs& inputs,
                                         const std::vector<double>& thresholds_px)
{
    if (inputs.truth.empty()) {
        throw io::ConfigError("a disparity score needs a truth");
    }
    auto scorer = as_config_error([&] { return evaluate::DisparityScorer(thresholds_px); });
    for_each_row(inputs, [&](const DisparityRow& row) {
        scorer.add_row(row.test_px, row.truth_px, row.mask);
    });
    return scorer.score();
}

evaluate::ConfidenceScore score_confidence(const DisparityInputs& inputs, double threshold_px)
{
    if (inputs.truth.empty() || inputs.confidence.empty()) {
        throw io::ConfigError("a confidence score needs a confidence and a truth");
    }
    constexpr std::array<double, 5> kDropped{0, 10, 20, 30, 50};
    auto scorer = as_config_error([&] { return evaluate::ConfidenceScorer(threshold_px); });
    try {
        for_each_row(inputs, [&](const DisparityRow& row) {
            scorer.add_row(row.test_px, row.truth_px, row.confidence, row.mask);
        });
    } catch (const std::invalid_argument& refused) {
        throw io::InputError(inputs.confidence + ": " + refused.what());
    }
    return scorer.score(kDropped);
}

std::vector<evaluate::SeamScore> score_seams(const DisparityInputs& inputs,
                                             const std::vector<int>& cells_px)
{
    std::vector<evaluate::SeamScorer> scorers;
    for (const int cell_px : cells_px) {
        scorers.push_back(as_config_error([&] { return seam_scorer(cell_px); }));
    }
    for_each_row(inputs, [&](const DisparityRow& row) {
        for (evaluate::SeamScorer& scorer : scorers) {
            scorer.add_row(row.test_px, row.truth_px, row.mask);
        }
    });
    std::vector<evaluate::SeamScore> scores;
    for (const evaluate::SeamScorer& scorer : scorers) {
        scores.push_back(scorer.score());
    }
    return scores;
}

} // namespace hsgm::pipeline
