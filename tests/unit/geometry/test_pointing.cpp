#include "tests/catch.h"

#include "pipeline/geometry/error.h"
#include "pipeline/geometry/pointing.h"
#include "tests/unit/geometry/sample_cameras.h"
#include "tests/unit/geometry/words.h"

#include <cmath>
#include <random>

using namespace hsgm;
using namespace hsgm::geometry;
using samples::says;

namespace {

constexpr tiling::Size kSize{800, 1000};

/// A camera whose image points are off by a correction, as a wrong model's are.
class OffCamera final : public GroundCamera {
public:
    OffCamera(const GroundCamera& truth, const ImageCorrection& error)
        : truth_(truth), error_(error)
    {
    }
    ImagePoint project(const MapPoint& place) const override
    {
        const ImagePoint p = truth_.project(place);
        return {p.x + error_.x_px + error_.x_by_x * p.x + error_.x_by_y * p.y,
                p.y + error_.y_px + error_.y_by_x * p.x + error_.y_by_y * p.y};
    }
    std::optional<MapPoint> locate(ImagePoint p, double height_m) const override
    {
        ImagePoint guess = p;
        for (int i = 0; i < 30; ++i) {
            guess = {p.x - error_.x_px - error_.x_by_x * guess.x - error_.x_by_y * guess.y,
                     p.y - error_.y_px - error_.y_by_x * guess.x - error_.y_by_y * guess.y};
        }
        return truth_.locate(guess, height_m);
    }

private:
    const GroundCamera& truth_;
    ImageCorrection error_;
};

samples::ParallelCamera camera(double lean_x, double lean_y)
{
    samples::ParallelCamera c;
    c.west = 300000;
    c.north = 5000000;
    c.lean_x = lean_x;
    c.lean_y = lean_y;
    return c;
}

struct Bench {
    samples::ParallelCamera left = camera(0.1, 0.05);
    samples::ParallelCamera right = camera(0.4, 0.45);
    ReferenceSurface surface{100};
    ImageCorrection error;
    EpipolarFrame frame;

    explicit Bench(const ImageCorrection& model_error) : error(model_error)
    {
        frame = make_epipolar_frame(left, kSize, OffCamera(right, error), kSize, surface, {});
    }

    /// Points seen in both true images, with noise; the first `wrong` of them are anywhere.
    std::vector<TiePoint> points(int count, int wrong, double noise_px) const
    {
        std::mt19937 random(11);
        std::uniform_real_distribution<double> unit(0, 1);
        std::normal_distribution<double> noise(0, noise_px);
        const OffCamera model(right, error);
        std::vector<TiePoint> result;
        while (static_cast<int>(result.size()) < count) {
            const ImagePoint at{unit(random) * kSize.cols, unit(random) * kSize.rows};
            const auto place = left.locate(at, 60 + 80 * unit(random));
            const ImagePoint seen = right.project(*place);
            const auto foot_left = left.locate(at, 100);
            const auto foot_right = model.locate(seen, 100);
            const auto a = frame.frame_at(foot_left->x, foot_left->y);
            const auto b = frame.frame_at(foot_right->x, foot_right->y);
            REQUIRE((a && b));
            TiePoint point{*a, {b->row + noise(random), b->col + noise(random)}};
            if (static_cast<int>(result.size()) < wrong) {
                point.right.row = a->row + (unit(random) - 0.5) * 40;
            }
            result.push_back(point);
        }
        return result;
    }
};

} // namespace

TEST_CASE("the part of a pointing error that can be seen is found, and its direction")
{
    // Rows run along (0.3, 0.4) to the east and north, so along (0.6, -0.8) in the right image,
    // whose y points south; (0.8, 0.6) is across.
    const Bench bench({3, 0, 0, -1, 0, 0});
    const auto points = bench.points(500, 0, 0);
    const Pointing found =
        estimate_pointing(bench.frame, points, kSize, PointingModel::automatic);
    const double across = 3 * 0.8 - 1 * 0.6;
    CHECK(std::abs(found.shift_px) == Approx(across).margin(1e-6));
    // What is added to the model's points undoes the error, as far as it is seen.
    CHECK(found.correction.x_px == Approx(-across * 0.8).margin(1e-6));
    CHECK(found.correction.y_px == Approx(-across * 0.6).margin(1e-6));
    CHECK_FALSE(found.affine);
    CHECK(found.inliers == 500);
    CHECK(found.rms_before_px == Approx(across).margin(1e-6));
    CHECK(found.rms_after_px < 1e-6);
    CHECK(found.warnings.empty());
}

TEST_CASE("corrected, the images have no row parallax left")
{
    const Bench bench({3, 0, 0, -1, 0, 0});
    const Pointing found =
        estimate_pointing(bench.frame, bench.points(500, 0, 0.2), kSize, PointingModel::shift);
    const Bench again(joined(bench.error, found.correction));
    const Pointing rest =
        estimate_pointing(again.frame, again.points(500, 0, 0), kSize, PointingModel::shift);
    CHECK(std::abs(rest.shift_px) < 0.03);
}

TEST_CASE("seven wrong matches of ten do not move the pointing")
{
    const Bench bench({0, 0, 0, 4, 0, 0});
    std::vector<bool> inlier;
    const Pointing found = estimate_pointing(bench.frame, bench.points(1000, 700, 0.2), kSize,
                                             PointingModel::automatic, &inlier);
    CHECK(std::abs(found.shift_px) == Approx(4 * 0.6).margin(0.05));
    CHECK(found.inliers > 280);
    CHECK(found.inliers < 330);
    CHECK(std::count(inlier.begin() + 700, inlier.end(), true) > 280);
}

TEST_CASE("a pointing error that changes over the image asks for an affine correction")
{
    const Bench bench({-1, 2e-3, 1e-3, -0.75, 1.5e-3, 0.75e-3}); // all of it across
    const auto points = bench.points(600, 60, 0.1);
    const Pointing found =
        estimate_pointing(bench.frame, points, kSize, PointingModel::automatic);
    CHECK(found.affine);
    CHECK(found.rms_after_px < 0.13);
    CHECK(found.correction.x_by_x == Approx(-2e-3).epsilon(0.05));
    CHECK(found.correction.y_by_x == Approx(-1.5e-3).epsilon(0.05));
    const Pointing shift = estimate_pointing(bench.frame, points, kSize, PointingModel::shift);
    CHECK_FALSE(shift.affine);
    CHECK(shift.rms_after_px > 0.3);
}

TEST_CASE("points in one corner make no affine correction")
{
    const Bench bench({-1, 2e-3, 1e-3, -0.75, 1.5e-3, 0.75e-3});
    std::vector<TiePoint> corner;
    for (const TiePoint& point : bench.points(8000, 0, 0.02)) {
        const ImagePoint at = bench.frame.right_at(point.right);
        if (at.x < 200 && at.y < 200) {
            corner.push_back(point);
        }
    }
    REQUIRE(corner.size() > 100);
    CHECK_FALSE(estimate_pointing(bench.frame, corner, kSize, PointingModel::automatic).affine);
}

TEST_CASE("pointing that cannot be trusted is refused with figures")
{
    const Bench bench({});
    const auto refusal = [&](const std::vector<TiePoint>& points) -> std::string {
        try {
            estimate_pointing(bench.frame, points, kSize, PointingModel::automatic);
        } catch (const GeometryError& error) {
            return error.what();
        }
        return "no refusal";
    };
    CHECK(says(refusal({}), "only 0 of 0 tie points agree, at least 20 must"));
    CHECK(says(refusal(bench.points(15, 0, 0.1)), "only 15 of 15 tie points agree"));
    CHECK(says(refusal(bench.points(300, 300, 0.1)), "tie points agree"));
    const auto few = estimate_pointing(bench.frame, bench.points(40, 0, 0.1), kSize,
                                       PointingModel::automatic);
    REQUIRE(few.warnings.size() == 1);
    CHECK(says(few.warnings[0], "only"));
    const auto rough = estimate_pointing(bench.frame, bench.points(400, 0, 0.7), kSize,
                                         PointingModel::automatic);
    REQUIRE(rough.warnings.size() == 1);
    CHECK(says(rough.warnings[0], "agree only to 0."));
}

TEST_CASE("two corrections in one are one after the other")
{
    const ImageCorrection a{1, 1e-3, -2e-3, -2, 3e-3, 4e-3};
    const ImageCorrection b{-0.5, 2e-3, 1e-3, 0.25, -1e-3, 5e-3};
    const auto apply = [](const ImageCorrection& c, ImagePoint p) {
        return ImagePoint{p.x + c.x_px + c.x_by_x * p.x + c.x_by_y * p.y,
                          p.y + c.y_px + c.y_by_x * p.x + c.y_by_y * p.y};
    };
    const ImagePoint one = apply(b, apply(a, {123, 456}));
    const ImagePoint both = apply(joined(a, b), {123, 456});
    CHECK(both.x == Approx(one.x));
    CHECK(both.y == Approx(one.y));
}
