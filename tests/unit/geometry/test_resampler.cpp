#include "tests/catch.h"

#include "pipeline/geometry/resampler.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace hsgm;
using namespace hsgm::geometry;
using tiling::Image;
using tiling::ImageView;
using tiling::Rect;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// x = x0 + a col + b row, y = y0 + c col + d row, over a frame of 200 x 300.
Lattice affine(double x0, double a, double b, double y0, double c, double d)
{
    Lattice lattice(-50, -50, 50, 8, 10, 2);
    for (int i = 0; i < 8; ++i) {
        for (int j = 0; j < 10; ++j) {
            const double row = -50 + i * 50;
            const double col = -50 + j * 50;
            lattice.node(i, j)[0] = x0 + a * col + b * row;
            lattice.node(i, j)[1] = y0 + c * col + d * row;
        }
    }
    return lattice;
}

ReadPixels reader(const Image<double>& image)
{
    return [&image](const Rect& window, ImageView<double> values) {
        for (int r = 0; r < window.rows; ++r) {
            for (int c = 0; c < window.cols; ++c) {
                values(r, c) = image(window.row + r, window.col + c);
            }
        }
    };
}

/// A picture of waves no shorter than 7 px, and its value between pixels.
double waves(double x, double y)
{
    return 1000 + 300 * std::sin(x * 0.8 + 0.3 * y) + 200 * std::cos(y * 0.7 - 0.2 * x);
}

Image<double> picture(tiling::Size size)
{
    Image<double> image(size);
    for (int r = 0; r < size.rows; ++r) {
        for (int c = 0; c < size.cols; ++c) {
            image(r, c) = waves(c, r);
        }
    }
    return image;
}

Image<double> drawn(const Resampler& resampler, const Image<double>& source, const Rect& window)
{
    Image<double> result(window.size());
    resampler.resample(window, reader(source), result);
    return result;
}

double rms_error(const Lattice& lattice, const Image<double>& source, Kernel kernel)
{
    const Rect window{20, 20, 100, 100};
    const Image<double> result = drawn({lattice, source.size(), kernel}, source, window);
    double squares = 0;
    for (int r = 0; r < window.rows; ++r) {
        for (int c = 0; c < window.cols; ++c) {
            std::array<double, 2> xy{};
            lattice.at(window.row + r, window.col + c, xy);
            squares += std::pow(result(r, c) - waves(xy[0], xy[1]), 2);
        }
    }
    return std::sqrt(squares / static_cast<double>(window.area()));
}

} // namespace

TEST_CASE("a frame on the pixels of its source shows them unchanged")
{
    const Image<double> source = picture({60, 80});
    const Lattice same = affine(7, 1, 0, 5, 0, 1);
    for (const Kernel kernel : {Kernel::bicubic, Kernel::lanczos}) {
        const Image<double> result =
            drawn({same, source.size(), kernel}, source, {0, 0, 40, 50});
        for (int r = 0; r < 40; ++r) {
            for (int c = 0; c < 50; ++c) {
                REQUIRE(result(r, c) == source(r + 5, c + 7));
            }
        }
    }
}

TEST_CASE("between pixels Lanczos' kernel is closer to the truth than Keys'")
{
    const Image<double> source = picture({300, 300});
    const double s = std::sin(0.3);
    const double c = std::cos(0.3);
    const Lattice turned = affine(40, c, -s, 30, s, c);
    // The waves have an amplitude of 300 and 200.
    const double sharp = rms_error(turned, source, Kernel::lanczos);
    const double soft = rms_error(turned, source, Kernel::bicubic);
    CHECK(sharp < 4);
    CHECK(soft < 9);
    CHECK(sharp < soft);
}

TEST_CASE("a pixel has the same bits in whatever window it is asked for")
{
    const Image<double> source = picture({300, 900});
    const Lattice turned = affine(-40, 1.1, 0.4, 10, -0.3, 1.2);
    const Resampler resampler(turned, source.size(), Kernel::lanczos);
    const Rect whole{0, 0, 150, 600};
    const Image<double> all = drawn(resampler, source, whole);
    for (const Rect part : {Rect{0, 0, 1, 600}, Rect{17, 41, 83, 97}, Rect{149, 599, 1, 1},
                            Rect{3, 500, 140, 60}}) {
        const Image<double> some = drawn(resampler, source, part);
        for (int r = 0; r < part.rows; ++r) {
            for (int c = 0; c < part.cols; ++c) {
                const double a = all(part.row + r, part.col + c);
                const double b = some(r, c);
                REQUIRE((a == b || (std::isnan(a) && std::isnan(b))));
            }
        }
    }
}

TEST_CASE("no pixel is read outside the window that is named")
{
    const Image<double> source = picture({300, 300});
    const Lattice turned = affine(-40, 1.1, 0.4, 10, -0.3, 1.2);
    const Resampler resampler(turned, source.size(), Kernel::lanczos);
    const Rect window{10, 20, 60, 70};
    const Rect named = resampler.source_window(window);
    CHECK(rect_of(source.size()).contains(named));
    Rect read;
    Image<double> result(window.size());
    resampler.resample(
        window,
        [&](const Rect& part, ImageView<double> values) {
            read = unite(read, part);
            reader(source)(part, values);
        },
        result);
    CHECK(read == named);
}

TEST_CASE("pixels without a value take away those of the frame nearest to them, and no more")
{
    Image<double> source = picture({60, 80});
    source(20, 30) = kNone;
    const Lattice shifted = affine(0.25, 1, 0, 0.25, 0, 1);
    const Resampler resampler(shifted, source.size(), Kernel::lanczos);
    const Image<double> result = drawn(resampler, source, {0, 0, 60, 80});
    int missing = 0;
    for (int r = 0; r < 60; ++r) {
        for (int c = 0; c < 80; ++c) {
            missing += std::isnan(result(r, c));
        }
    }
    CHECK(missing == 1);
    CHECK(std::isnan(result(20, 30)));
    // A neighbour whose kernel covers the missing pixel stays within the values round it.
    CHECK(std::abs(result(20, 31) - waves(31.25, 20.25)) < 60);
}

TEST_CASE("the frame ends half a pixel beyond the centres of the source's outermost pixels")
{
    const Image<double> source = picture({10, 10});
    const Lattice fine = affine(-2, 0.25, 0, 4, 0, 0.25);
    const Resampler resampler(fine, source.size(), Kernel::bicubic);
    const Image<double> row = drawn(resampler, source, {0, 0, 1, 60});
    // Column c shows x = -2 + c / 4, valid from -0.5 (c = 6) to below 9.5 (c = 46).
    CHECK(std::isnan(row(0, 5)));
    CHECK_FALSE(std::isnan(row(0, 6)));
    CHECK_FALSE(std::isnan(row(0, 45)));
    CHECK(std::isnan(row(0, 46)));
}

TEST_CASE("a coarser frame shows means and no aliases")
{
    Image<double> stripes({240, 300});
    for (int r = 0; r < 240; ++r) {
        for (int c = 0; c < 300; ++c) {
            stripes(r, c) = (c % 2) * 200 + (r % 3 == 0 ? 300 : 0);
        }
    }
    const Lattice coarse = affine(9.3, 3.5, 0, 8.1, 0, 3.5);
    for (const Kernel kernel : {Kernel::bicubic, Kernel::lanczos}) {
        const Resampler resampler(coarse, stripes.size(), kernel);
        CHECK(resampler.span_x() == Approx(3.5));
        const Image<double> result = drawn(resampler, stripes, {0, 0, 60, 75});
        for (int r = 2; r < 58; ++r) {
            for (int c = 2; c < 73; ++c) {
                REQUIRE(result(r, c) == Approx(100 + 100).margin(12));
            }
        }
    }
}

TEST_CASE("a frame beside its source is empty and reads nothing")
{
    const Lattice away = affine(5000, 1, 0, 5000, 0, 1);
    const Resampler resampler(away, {60, 80}, Kernel::lanczos);
    CHECK(resampler.source_window({0, 0, 30, 30}).empty());
    Image<double> result({30, 30}, 1.0);
    resampler.resample(
        {0, 0, 30, 30}, [](const Rect&, ImageView<double>) { FAIL("nothing to read"); },
        result);
    CHECK(std::isnan(result(0, 0)));
    CHECK(std::isnan(result(29, 29)));
}
