#include "tests/catch.h"

#include "pipeline/geometry/epipolar_frame.h"
#include "pipeline/geometry/error.h"
#include "tests/unit/geometry/sample_cameras.h"
#include "tests/unit/geometry/sample_models.h"
#include "tests/unit/geometry/words.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

using namespace hsgm;
using namespace hsgm::geometry;
using samples::ParallelCamera;
using samples::says;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

ParallelCamera leaning(double lean_x, double lean_y)
{
    ParallelCamera camera;
    camera.west = 300000;
    camera.north = 5000000;
    camera.lean_x = lean_x;
    camera.lean_y = lean_y;
    return camera;
}

struct RowParallax {
    double rms_px = 0;
    double most_px = 0;
    double most_off_line_px = 0; ///< of disparities from px_per_m times the height
    int points = 0;
};

// Random points over the frame and its heights, seen through both cameras.
RowParallax row_parallax(const EpipolarFrame& frame, const GroundCamera& left,
                         const GroundCamera& right, const ReferenceSurface& surface)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    RowParallax result;
    double squares = 0;
    for (; result.points < 2000; ++result.points) {
        const FramePoint at{unit(random) * frame.size.rows, unit(random) * frame.size.cols};
        const double above_m = frame.below_m + unit(random) * (frame.above_m - frame.below_m);
        const auto point = meet_surface(left, frame.left_at(at), surface, above_m);
        REQUIRE(point.has_value());
        const auto foot = meet_surface(right, right.project(*point), surface);
        REQUIRE(foot.has_value());
        const auto there = frame.frame_at(foot->x, foot->y);
        REQUIRE(there.has_value());
        squares += std::pow(at.row - there->row, 2);
        result.most_px = std::max(result.most_px, std::abs(at.row - there->row));
        result.most_off_line_px = std::max(
            result.most_off_line_px, std::abs(at.col - there->col - above_m * frame.px_per_m));
    }
    result.rms_px = std::sqrt(squares / result.points);
    return result;
}

template <typename Make>
std::string refusal(Make make)
{
    try {
        make();
    } catch (const GeometryError& error) {
        return error.what();
    }
    return "no refusal";
}

} // namespace

TEST_CASE("the frame of two parallel cameras is the one that a hand works out")
{
    // The right camera leans further east by 0.3 m/m and north by 0.4 m/m: rows run that way,
    // and a metre of height is half a metre of parallax.
    const ParallelCamera left = leaning(0.1, 0.05);
    const ParallelCamera right = leaning(0.4, 0.45);
    const ReferenceSurface surface(200);
    FrameOptions options;
    options.below_m = -20;
    options.above_m = 40;
    const EpipolarFrame frame =
        make_epipolar_frame(left, {800, 1000}, right, {900, 1100}, surface, options);
    CHECK(frame.angle_rad == Approx(std::atan2(0.4, 0.3)));
    CHECK(frame.gsd_m == Approx(0.5));
    CHECK(frame.px_per_m == Approx(1.0));
    CHECK(frame.lattice_error_px < 1e-6);
    const RowParallax parallax = row_parallax(frame, left, right, surface);
    CHECK(parallax.most_px < 1e-6);
    CHECK(parallax.most_off_line_px < 1e-6);
}

TEST_CASE("a pixel of the frame shows the same place of the surface in both images")
{
    const ParallelCamera left = leaning(0.1, 0.05);
    const ParallelCamera right = leaning(-0.2, 0.15);
    const ReferenceSurface surface(200);
    const EpipolarFrame frame =
        make_epipolar_frame(left, {800, 1000}, right, {800, 1000}, surface, {});
    const FramePoint at{123.25, 456.5};
    const MapPoint place = frame.map_at(at);
    CHECK(place.height_m == Approx(200));
    CHECK(frame.left_at(at).x == Approx(left.project(place).x));
    CHECK(frame.left_at(at).y == Approx(left.project(place).y));
    CHECK(frame.right_at(at).x == Approx(right.project(place).x));
    const auto back = frame.frame_at(place.x, place.y);
    REQUIRE(back.has_value());
    CHECK(back->row == Approx(at.row));
    CHECK(back->col == Approx(at.col));
}

TEST_CASE("the frame holds all that both images see at any of the heights, and little more")
{
    const ParallelCamera left = leaning(0.1, 0.05);
    ParallelCamera right = leaning(0.4, 0.45);
    right.west += 30;
    const ReferenceSurface surface(0);
    FrameOptions options;
    options.below_m = -50;
    options.above_m = 80;
    const EpipolarFrame frame =
        make_epipolar_frame(left, {800, 1000}, right, {800, 1000}, surface, options);
    double least = 1e9;
    for (const double height : {-50.0, 0.0, 80.0}) {
        for (int row = 0; row < 800; row += 17) {
            for (int col = 0; col < 1000; col += 13) {
                const auto place = left.locate({double(col), double(row)}, height);
                const ImagePoint other = right.project(*place);
                if (other.x < 0 || other.y < 0 || other.x > 999 || other.y > 799) {
                    continue;
                }
                for (const GroundCamera* camera :
                     {(const GroundCamera*)&left, (const GroundCamera*)&right}) {
                    const auto foot = camera->locate(camera->project(*place), 0);
                    const auto at = frame.frame_at(foot->x, foot->y);
                    REQUIRE(at.has_value());
                    least = std::min({least, at->row, at->col, frame.size.rows - 1 - at->row,
                                      frame.size.cols - 1 - at->col});
                }
            }
        }
    }
    CHECK(least > 0);
    CHECK(least < 20);
}

TEST_CASE("swapping the images turns the frame round and keeps higher further")
{
    const ParallelCamera a = leaning(0.1, 0.05);
    const ParallelCamera b = leaning(0.4, 0.45);
    const ReferenceSurface surface(200);
    const EpipolarFrame ab = make_epipolar_frame(a, {800, 1000}, b, {800, 1000}, surface, {});
    const EpipolarFrame ba = make_epipolar_frame(b, {800, 1000}, a, {800, 1000}, surface, {});
    CHECK(ba.px_per_m == Approx(ab.px_per_m));
    CHECK(std::cos(ba.angle_rad - ab.angle_rad) == Approx(-1));
    CHECK(row_parallax(ba, b, a, surface).most_off_line_px < 1e-6);
}

TEST_CASE("an image turned by 180 degrees makes the same frame")
{
    const ParallelCamera left = leaning(0.1, 0.05);
    const ParallelCamera right = leaning(0.4, 0.45);
    ParallelCamera turned = right;
    turned.turn_rad = 180 * kDegree;
    turned.west = right.west + 999 * 0.5;
    turned.north = right.north - 799 * 0.5;
    const ReferenceSurface surface(200);
    const EpipolarFrame a =
        make_epipolar_frame(left, {800, 1000}, right, {800, 1000}, surface, {});
    const EpipolarFrame b =
        make_epipolar_frame(left, {800, 1000}, turned, {800, 1000}, surface, {});
    CHECK(a.size == b.size);
    CHECK(a.angle_rad == Approx(b.angle_rad));
    const ImagePoint upright = a.right_at({300, 400});
    const ImagePoint round = b.right_at({300, 400});
    CHECK(round.x == Approx(999 - upright.x));
    CHECK(round.y == Approx(799 - upright.y));
}

TEST_CASE("rows follow the parallax of satellite images, however high the ground")
{
    const MapProjection map = MapProjection::automatic(7, 45);
    const RpcGroundCamera left(RpcCamera(samples::model(0.3, 0.1)), map);
    const RpcGroundCamera right(RpcCamera(samples::model(-0.25, 0.2)), map);
    const ReferenceSurface surface(600);
    FrameOptions options;
    options.below_m = -400;
    options.above_m = 500;
    const EpipolarFrame frame =
        make_epipolar_frame(left, {20000, 20000}, right, {20000, 20000}, surface, options);
    const RowParallax parallax = row_parallax(frame, left, right, surface);
    CHECK(parallax.rms_px < 0.01);
    CHECK(parallax.most_px < 0.05);
    CHECK(frame.lattice_error_px < 0.005);
}

TEST_CASE("rows follow the parallax over a surface with hills")
{
    // Cameras that lean the same way across the rows: epipolar planes are tilted, so rows must
    // wind round the hills.
    const ParallelCamera left = leaning(0.3, 0.25);
    const ParallelCamera right = leaning(-0.2, 0.25);
    tiling::Image<double> posts({14, 16});
    for (int row = 0; row < 14; ++row) {
        for (int col = 0; col < 16; ++col) {
            posts(row, col) = 300 + 60 * std::sin(col * 0.8) * std::cos(row * 0.7);
        }
    }
    const ReferenceSurface surface(299800, 5000200, 60, posts);
    FrameOptions options;
    options.below_m = -30;
    options.above_m = 60;
    const EpipolarFrame frame =
        make_epipolar_frame(left, {1000, 1000}, right, {1000, 1000}, surface, options);
    CHECK(frame.lattice_error_px < 0.005);
    const RowParallax parallax = row_parallax(frame, left, right, surface);
    CHECK(parallax.rms_px < 0.05);
    CHECK(parallax.most_px < 0.2);
}

TEST_CASE("a region of interest makes a smaller frame that holds it")
{
    const ParallelCamera left = leaning(0.1, 0.05);
    const ParallelCamera right = leaning(0.4, 0.45);
    const ReferenceSurface surface(0);
    FrameOptions options;
    options.below_m = -1;
    options.above_m = 1;
    const double x = 300200;
    const double y = 4999800;
    options.region = {{x, y, 0}, {x + 50, y, 0}, {x + 50, y + 25, 0}, {x, y + 25, 0}};
    const EpipolarFrame frame =
        make_epipolar_frame(left, {800, 1000}, right, {800, 1000}, surface, options);
    CHECK(frame.size.area() < 25000);
    for (const MapPoint& corner : options.region) {
        const auto at = frame.frame_at(corner.x, corner.y);
        REQUIRE(at.has_value());
        CHECK(at->row > 0);
        CHECK(at->col > 0);
        CHECK(at->row < frame.size.rows - 1);
        CHECK(at->col < frame.size.cols - 1);
    }
}

TEST_CASE("images that make no pair are refused with figures")
{
    const ParallelCamera left = leaning(0.1, 0.05);
    ParallelCamera away = leaning(0.4, 0.45);
    away.west += 600;
    const ReferenceSurface surface(0);
    const tiling::Size size{800, 1000};
    const auto make = [&](const ParallelCamera& right, const FrameOptions& options = {}) {
        return refusal([&] { make_epipolar_frame(left, size, right, size, surface, options); });
    };
    CHECK(says(make(away), "do not overlap: at 0 m the left one shows x 300000 to 300500 m"));
    CHECK(says(make(away), "the right one x 300600 to 301100 m"));
    CHECK(says(make(leaning(0.115, 0.05)), "ratio is 0.015"));
    CHECK(says(make(leaning(2.2, 0.05)), "nearly opposite sides"));
    FrameOptions elsewhere;
    elsewhere.region = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
    CHECK(says(make(leaning(0.4, 0.45), elsewhere), "lies outside what both images show"));
    FrameOptions upside_down;
    upside_down.below_m = 10;
    upside_down.above_m = 10;
    CHECK_THROWS_AS(
        make_epipolar_frame(left, size, leaning(0.4, 0), size, surface, upside_down),
        std::invalid_argument);
}
