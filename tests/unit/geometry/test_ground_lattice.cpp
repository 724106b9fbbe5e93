#include "tests/catch.h"

#include "pipeline/geometry/error.h"
#include "pipeline/geometry/ground_lattice.h"
#include "tests/unit/geometry/sample_cameras.h"
#include "tests/unit/geometry/sample_models.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace hsgm;
using namespace hsgm::geometry;

namespace {

constexpr tiling::Size kSize{3000, 4000};

MapPoint unchanged(const MapPoint& place)
{
    return place;
}

double distance(const MapPoint& a, const MapPoint& b)
{
    return std::hypot(a.x - b.x, a.y - b.y, a.height_m - b.height_m);
}

/// The pixel of the frame that shows a pixel of the right image, near a first guess.
FramePoint shown_at(const EpipolarFrame& frame, ImagePoint image, FramePoint guess)
{
    for (int step = 0; step < 10; ++step) {
        const ImagePoint here = frame.right_at(guess);
        const ImagePoint below = frame.right_at({guess.row + 1, guess.col});
        const ImagePoint beside = frame.right_at({guess.row, guess.col + 1});
        const double a = beside.x - here.x;
        const double b = below.x - here.x;
        const double c = beside.y - here.y;
        const double d = below.y - here.y;
        const double dx = image.x - here.x;
        const double dy = image.y - here.y;
        guess.col += (d * dx - b * dy) / (a * d - b * c);
        guess.row += (a * dy - c * dx) / (a * d - b * c);
    }
    return guess;
}

/// Random points of the ground, put into the frame by the cameras and brought back by the
/// lattice: the worst distance between where they were and where they come out.
double worst_error_m(const EpipolarFrame& frame, const GroundLattice& lattice,
                     const GroundCamera& left, const GroundCamera& right,
                     const ReferenceSurface& surface)
{
    std::mt19937 random(9);
    std::uniform_real_distribution<double> unit(0, 1);
    double worst = 0;
    for (int i = 0; i < 500; ++i) {
        const FramePoint at{unit(random) * frame.size.rows, unit(random) * frame.size.cols};
        const auto place =
            meet_surface(left, frame.left_at(at), surface,
                         frame.below_m + unit(random) * (frame.above_m - frame.below_m));
        REQUIRE(place.has_value());
        const ImagePoint seen = right.project(*place);
        const auto foot = meet_surface(right, seen, surface);
        REQUIRE(foot.has_value());
        const auto guess = frame.frame_at(foot->x, foot->y);
        REQUIRE(guess.has_value());
        const FramePoint partner = shown_at(frame, seen, *guess);
        worst = std::max(worst, distance(*place, lattice.at(at, at.col - partner.col).place));
    }
    return worst;
}

GroundLattice lattice_of(const EpipolarFrame& frame, const GroundCamera& left,
                         const GroundCamera& right)
{
    return {frame,
            left,
            right,
            frame.below_m * frame.px_per_m - 5,
            frame.above_m * frame.px_per_m + 5,
            unchanged};
}

} // namespace

TEST_CASE("two rays meet where a hand finds it")
{
    samples::ParallelCamera left;
    samples::ParallelCamera right;
    left.lean_x = 0.2;
    right.lean_x = -0.3;
    right.lean_y = 0.1;
    const MapPoint place{120, -80, 37};
    const auto meeting =
        meet_rays(left, left.project(place), right, right.project(place), {100, -100, 0});
    REQUIRE(meeting.has_value());
    CHECK(distance(meeting->place, place) < 1e-9);
    CHECK(meeting->residual_px < 1e-9);
    // Parted by 2 px across the epipolar line (along y, for cameras that lean along x alone),
    // the rays meet in the middle: 1 px from each.
    right.lean_y = 0;
    ImagePoint off = right.project(place);
    off.y += 2;
    const auto parted = meet_rays(left, left.project(place), right, off, {100, -100, 0});
    REQUIRE(parted.has_value());
    CHECK(parted->place.x == Approx(120));
    CHECK(parted->place.y == Approx(-80.5));
    CHECK(parted->place.height_m == Approx(37));
    CHECK(parted->residual_px == Approx(std::sqrt(2.0 / 4)));
}

TEST_CASE("parallel rays do not meet")
{
    const samples::ParallelCamera camera;
    CHECK_FALSE(meet_rays(camera, {10, 10}, camera, {12, 10}, {0, 0, 0}).has_value());
}

TEST_CASE("matched pixels of satellite images become their ground points, swapped or turned")
{
    const MapProjection map = MapProjection::automatic(7, 45);
    const RpcModel a = crop(samples::model(0.3, 0.1), {8000, 8500});
    const RpcModel b = crop(samples::model(-0.25, 0.2), {8000, 8500});
    RpcModel turned = b;
    turned.samp_off = kSize.cols - 1 - b.samp_off;
    turned.line_off = kSize.rows - 1 - b.line_off;
    turned.samp_scale = -b.samp_scale;
    turned.line_scale = -b.line_scale;
    const ReferenceSurface surface(600);
    FrameOptions options;
    options.below_m = -200;
    options.above_m = 300;
    for (const auto& [first, second] :
         {std::pair(a, b), std::pair(b, a), std::pair(a, turned), std::pair(turned, a)}) {
        const RpcGroundCamera left(RpcCamera(first), map);
        const RpcGroundCamera right(RpcCamera(second), map);
        const EpipolarFrame frame =
            make_epipolar_frame(left, kSize, right, kSize, surface, options);
        const GroundLattice lattice = lattice_of(frame, left, right);
        CHECK(lattice.error_m() < 0.01 * frame.gsd_m);
        CHECK(worst_error_m(frame, lattice, left, right, surface) < 0.01 * frame.gsd_m);
    }
}

TEST_CASE("matched pixels over hills become their ground points")
{
    samples::ParallelCamera left;
    samples::ParallelCamera right;
    left.lean_x = 0.3;
    left.lean_y = 0.2;
    right.lean_x = -0.2;
    right.lean_y = 0.25;
    tiling::Image<double> posts({30, 36});
    for (int row = 0; row < 30; ++row) {
        for (int col = 0; col < 36; ++col) {
            posts(row, col) = 300 + 60 * std::sin(col * 0.5) * std::cos(row * 0.4);
        }
    }
    const ReferenceSurface surface(-200, 200, 100, posts);
    FrameOptions options;
    options.below_m = -50;
    options.above_m = 80;
    const EpipolarFrame frame =
        make_epipolar_frame(left, kSize, right, kSize, surface, options);
    const GroundLattice lattice = lattice_of(frame, left, right);
    CHECK(worst_error_m(frame, lattice, left, right, surface) < 0.01 * frame.gsd_m);
}

TEST_CASE("heights come out above the datum that is asked for")
{
    const MapProjection map = MapProjection::automatic(7, 45);
    const MapProjection above_sea = MapProjection::from_text("EPSG:32632", "EGM96");
    const RpcGroundCamera left(RpcCamera(crop(samples::model(0.3, 0.1), {8000, 8500})), map);
    const RpcGroundCamera right(RpcCamera(crop(samples::model(-0.25, 0.2), {8000, 8500})), map);
    const ReferenceSurface surface(600);
    const EpipolarFrame frame =
        make_epipolar_frame(left, kSize, right, kSize, surface, FrameOptions{});
    const GroundLattice ellipsoidal(frame, left, right, -30, 30, unchanged);
    const GroundLattice orthometric(frame, left, right, -30, 30, [&](const MapPoint& place) {
        return above_sea.forward(map.inverse(place));
    });
    const MapPoint a = ellipsoidal.at({1000, 1500}, 7).place;
    const MapPoint b = orthometric.at({1000, 1500}, 7).place;
    CHECK(b.x == Approx(a.x));
    CHECK(b.y == Approx(a.y));
    const double undulation = a.height_m - above_sea.forward(map.inverse(a)).height_m;
    CHECK(a.height_m - b.height_m == Approx(undulation).margin(0.005));
    CHECK(undulation > 40); // in the west of the Alps
}

TEST_CASE("a row of points is the points one by one, in whatever pieces, and NaN where none is")
{
    samples::ParallelCamera left;
    samples::ParallelCamera right;
    left.lean_x = 0.3;
    right.lean_x = -0.2;
    const EpipolarFrame frame =
        make_epipolar_frame(left, {300, 400}, right, {300, 400}, ReferenceSurface(0), {});
    const GroundLattice lattice = lattice_of(frame, left, right);
    std::vector<float> disparity(100, 3.5f);
    disparity[40] = std::numeric_limits<float>::quiet_NaN();
    disparity[99] = -12;
    std::vector<double> x(100);
    std::vector<double> y(100);
    std::vector<double> h(100);
    std::vector<float> residual(100);
    lattice.points(77, 20, disparity, {x, y, h, residual});
    for (std::size_t i = 0; i < 100; ++i) {
        if (i == 40) {
            CHECK(std::isnan(x[i]));
            CHECK(std::isnan(h[i]));
            CHECK(std::isnan(residual[i]));
            continue;
        }
        const Meeting one = lattice.at({77, 20 + static_cast<double>(i)}, disparity[i]);
        REQUIRE(x[i] == one.place.x);
        REQUIRE(y[i] == one.place.y);
        REQUIRE(h[i] == one.place.height_m);
    }
    CHECK(h[0] == Approx(3.5 / frame.px_per_m));
    const Meeting before = lattice.at({77, 119}, -12);
    CHECK(h[99] == before.place.height_m);
}

TEST_CASE("a stored lattice gives the same points")
{
    samples::ParallelCamera left;
    samples::ParallelCamera right;
    left.lean_x = 0.3;
    right.lean_x = -0.2;
    const EpipolarFrame frame =
        make_epipolar_frame(left, {300, 400}, right, {300, 400}, ReferenceSurface(0), {});
    const GroundLattice made = lattice_of(frame, left, right);
    const GroundLattice stored(made.nodes(), made.disparity_min_px(), made.disparity_max_px(),
                               made.error_m());
    CHECK(stored.at({10.5, 20.25}, 4.75).place.x == made.at({10.5, 20.25}, 4.75).place.x);
}
