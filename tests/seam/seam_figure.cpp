#include "tests/seam/seam_figure.h"

#include <cstdio>
#include <limits>

namespace hsgm::seam {

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

// Scenes come one below the other, whole cells apart.
class Tally {
public:
    void add(const StereoPair& pair, const tiling::Image<float>& disparity_px)
    {
        const auto truth = pair.truth_px.view();
        const auto visible = pair.visible.view();
        for (int row = 0; row < disparity_px.rows(); ++row) {
            scorer_.add_row(disparity_px.view().row_span(row), truth.row_span(row),
                            visible.row_span(row));
        }
        const int cell = evaluate::SeamOptions{}.cell_px;
        const std::vector<float> none(static_cast<std::size_t>(disparity_px.cols()), kNone);
        for (int row = disparity_px.rows(); row % cell != 0 || row == disparity_px.rows();
             ++row) {
            scorer_.add_row(none, none);
        }
    }
    evaluate::SeamScore score() const { return scorer_.score(); }

private:
    evaluate::SeamScorer scorer_{evaluate::SeamOptions{}};
};

std::string text(const evaluate::SeamScore& s)
{
    char line[96];
    std::snprintf(line, sizeof line, "%.3f [%.3f, %.3f] (%.4f / %.4f px)", s.ratio, s.ratio_low,
                  s.ratio_high, s.border_jump_px, s.far_jump_px);
    return line;
}

} // namespace

SeamFigures seam_figures(const std::vector<StereoPair>& pairs, const matcher::Options& options)
{
    Tally raw_tally;
    Tally refined_tally;
    for (const StereoPair& pair : pairs) {
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
        raw_tally.add(pair, raw);
        refined_tally.add(pair, checked);
    }
    return {raw_tally.score(), refined_tally.score()};
}

std::string text(const SeamFigures& figures)
{
    return "raw " + text(figures.raw) + ", refined " + text(figures.refined);
}

synth::Scene ramps(tiling::Size size, std::uint64_t seed)
{
    const int shift = static_cast<int>(seed * 37 % 229);
    synth::Scene scene;
    scene.size = size;
    scene.seed = seed;
    scene.terrain.offset_px = -10;
    scene.terrain.slope_x = 0.03;
    scene.terrain.slope_y = 0.02;
    scene.terrain.waves = {{1.5, 160, 15, double(10 * shift % 360)}};
    scene.terrain.texture.contrast = 0.08;
    // Rows of gables and pent roofs, each at its own angle.
    int n = 0;
    for (int y = shift; y < size.rows; y += 229) {
        for (int x = shift; x < size.cols; x += 229, ++n) {
            const auto roof = n % 2 == 0 ? synth::Roof::gable : synth::Roof::slope;
            scene.objects.push_back({synth::Shape::rectangle,
                                     double(x),
                                     double(y),
                                     140,
                                     90,
                                     double(35 * n % 360),
                                     5,
                                     roof,
                                     8,
                                     {}});
        }
    }
    scene.left.noise_gray = 1;
    scene.right.noise_gray = 1;
    return scene;
}

std::vector<StereoPair> render_series(synth::Scene (*make)(tiling::Size, std::uint64_t),
                                      tiling::Size size, int count)
{
    std::vector<StereoPair> pairs;
    for (int seed = 1; seed <= count; ++seed) {
        pairs.push_back(render(make(size, static_cast<std::uint64_t>(seed))));
    }
    return pairs;
}

matcher::Options with_mode(matcher::Mode mode, int halo_px)
{
    matcher::Options options;
    options.mode = mode;
    options.halo_px = halo_px;
    return options;
}

} // namespace hsgm::seam
