#include "pipeline/stages/evaluate_stage.h"

#include "io/error.h"

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
    for_each_row(inputs, [&](auto test_px, auto truth_px, auto mask) {
        scorer.add_row(test_px, truth_px, mask);
    });
    return scorer.score();
}

std::vector<evaluate::SeamScore> score_seams(const DisparityInputs& inputs,
                                             const std::vector<int>& cells_px)
{
    std::vector<evaluate::SeamScorer> scorers;
    for (const int cell_px : cells_px) {
        scorers.push_back(as_config_error([&] { return seam_scorer(cell_px); }));
    }
    for_each_row(inputs, [&](auto test_px, auto truth_px, auto mask) {
        for (evaluate::SeamScorer& scorer : scorers) {
            scorer.add_row(test_px, truth_px, mask);
        }
    });
    std::vector<evaluate::SeamScore> scores;
    for (const evaluate::SeamScorer& scorer : scorers) {
        scores.push_back(scorer.score());
    }
    return scores;
}

} // namespace hsgm::pipeline
