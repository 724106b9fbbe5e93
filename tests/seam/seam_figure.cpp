#include "tests/seam/seam_figure.h"

#include <cstdio>
#include <limits>

namespace hsgm::seam {

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

evaluate::SeamScore score(const StereoPair& pair, const tiling::Image<float>& disparity_px)
{
    evaluate::SeamScorer scorer(evaluate::SeamOptions{});
    for (int row = 0; row < disparity_px.rows(); ++row) {
        scorer.add_row(disparity_px.view().row_span(row), pair.truth_px.view().row_span(row),
                       pair.visible.view().row_span(row));
    }
    return scorer.score();
}

std::string text(const evaluate::SeamScore& s)
{
    char line[96];
    std::snprintf(line, sizeof line, "%.3f [%.3f, %.3f] (%.4f / %.4f px)", s.ratio, s.ratio_low,
                  s.ratio_high, s.border_jump_px, s.far_jump_px);
    return line;
}

} // namespace

SeamFigures seam_figures(const StereoPair& pair, const matcher::Options& options)
{
    const Match match(pair, options);
    const Whole whole = match.match_all(0);
    const matcher::Refined refined = match.refine_all(whole, 0);
    tiling::Image<float> raw(pair.left.size());
    tiling::Image<float> checked(pair.left.size());
    for (int row = 0; row < raw.rows(); ++row) {
        for (int col = 0; col < raw.cols(); ++col) {
            raw(row, col) = static_cast<float>(whole.disparity_q8(row, col)) / 256.0F;
            const float d = refined.disparity_px(row, col);
            checked(row, col) = d == matcher::kNodataDisparity ? kNone : d;
        }
    }
    return {score(pair, raw), score(pair, checked)};
}

std::string text(const SeamFigures& figures)
{
    return "raw " + text(figures.raw) + ", refined " + text(figures.refined);
}

synth::Scene ramps(tiling::Size size)
{
    synth::Scene scene;
    scene.size = size;
    scene.seed = 3;
    scene.terrain.offset_px = -10;
    scene.terrain.slope_x = 0.03;
    scene.terrain.slope_y = 0.02;
    scene.terrain.waves = {{1.5, 160, 15, 0}};
    scene.terrain.texture.contrast = 0.08;
    // Rows of gables and pent roofs, each at its own angle.
    int n = 0;
    for (int y = 130; y < size.rows; y += 230) {
        for (int x = 150; x < size.cols; x += 230, ++n) {
            const auto roof = n % 2 == 0 ? synth::Roof::gable : synth::Roof::slope;
            scene.objects.push_back({synth::Shape::rectangle, double(x), double(y), 140, 90,
                                     35.0 * n, 5, roof, 8, {}});
        }
    }
    scene.left.noise_gray = 1;
    scene.right.noise_gray = 1;
    return scene;
}

matcher::Options with_mode(matcher::Mode mode, int halo_px)
{
    matcher::Options options;
    options.mode = mode;
    options.halo_px = halo_px;
    return options;
}

} // namespace hsgm::seam
