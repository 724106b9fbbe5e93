#include "tests/catch.h"

#include "tests/seam/stereo.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

using namespace hsgm;
using namespace hsgm::seam;

// Fractions of a pixel on planes without an end, whose truth takes every fraction.
namespace {

struct Slope {
    double along_x; // px of disparity a column
    double along_y;
};

constexpr Slope kSlopes[] = {{0.005, 0.001}, {0.01, 0.003}, {0.02, 0.01},
                             {0.05, 0.02},   {0.1, 0.03},   {-0.03, 0.05}};

StereoPair plane(const Slope& slope, double noise_gray)
{
    synth::Scene scene;
    scene.size = {360, 480};
    scene.seed = 3;
    scene.terrain.offset_px = 4;
    scene.terrain.slope_x = slope.along_x;
    scene.terrain.slope_y = slope.along_y;
    scene.terrain.texture.contrast = 0.08;
    scene.left.noise_gray = scene.right.noise_gray = noise_gray;
    return render(scene, 4);
}

struct FractionFigures {
    double deviation_px = 0; ///< standard deviation of the errors
    double locking_px = 0;   ///< half of the range of mean errors over the truth's fraction
};

// Errors of one pair, sorted by the truth's fraction.
class Errors {
public:
    void add(double truth_px, double error_px)
    {
        const double fraction = truth_px - std::floor(truth_px);
        auto& bin = bins_[std::min(static_cast<std::size_t>(fraction * kBins), kBins - 1)];
        ++bin.count;
        bin.sum += error_px;
        bin.squares += error_px * error_px;
    }
    FractionFigures figures() const
    {
        Bin all;
        double least = 1;
        double most = -1;
        for (const Bin& bin : bins_) {
            all.count += bin.count;
            all.sum += bin.sum;
            all.squares += bin.squares;
            least = std::min(least, bin.sum / bin.count);
            most = std::max(most, bin.sum / bin.count);
        }
        REQUIRE(all.count > 50'000);
        const double mean = all.sum / all.count;
        return {std::sqrt(all.squares / all.count - mean * mean), (most - least) / 2};
    }

private:
    static constexpr std::size_t kBins = 32;
    struct Bin {
        double count = 0;
        double sum = 0;
        double squares = 0;
    };
    std::vector<Bin> bins_ = std::vector<Bin>(kBins);
};

// Pixels near the image's border see less of the plane; gross errors are not fractions.
FractionFigures figures_of(const StereoPair& pair, const matcher::Options& options)
{
    constexpr int kBorder = 16;
    const Match match(pair, options);
    const matcher::Refined refined = match.refine_all(match.match_all(0), 0);
    Errors errors;
    for (int row = kBorder; row < pair.left.rows() - kBorder; ++row) {
        for (int col = kBorder; col < pair.left.cols() - kBorder; ++col) {
            const double truth = pair.truth_px(row, col);
            const double error = refined.disparity_px(row, col) - truth;
            if (pair.visible(row, col) != 0 && std::abs(error) < 1) {
                errors.add(truth, error);
            }
        }
    }
    return errors.figures();
}

FractionFigures worst(double noise_gray, const matcher::Options& options, const char* name)
{
    FractionFigures worst;
    for (const Slope& slope : kSlopes) {
        const FractionFigures f = figures_of(plane(slope, noise_gray), options);
        std::printf("%-20s noise %g, slope %6.3f %6.3f: std %.3f px, locking %.3f px\n", name,
                    noise_gray, slope.along_x, slope.along_y, f.deviation_px, f.locking_px);
        worst.deviation_px = std::max(worst.deviation_px, f.deviation_px);
        worst.locking_px = std::max(worst.locking_px, f.locking_px);
    }
    return worst;
}

} // namespace

TEST_CASE("fractions on slopes are 0.1 px true and hardly stick to whole pixels")
{
    const FractionFigures census = worst(1, {}, "census, median");
    CHECK(census.deviation_px <= 0.10);
    CHECK(census.locking_px <= 0.05);
    // The figures can tell: fractions of the sums of path costs do stick.
    matcher::Options options;
    options.subpixel = matcher::Subpixel::sums;
    const FractionFigures sums = worst(1, options, "sums, median");
    CHECK(sums.locking_px > 0.1);
    CHECK(sums.deviation_px > census.deviation_px);
}
