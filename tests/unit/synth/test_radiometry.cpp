#include "tests/catch.h"

#include "pipeline/synth/hash.h"
#include "pipeline/synth/texture.h"
#include "tests/unit/synth/scenes.h"

#include <cmath>

using namespace hsgm;
using namespace hsgm::synth;
using namespace hsgm::synth::testing;

namespace {

struct Moments {
    double mean = 0;
    double std = 0;
};

template <typename Value>
Moments moments(const tiling::Rect& part, Value value)
{
    double sum = 0;
    double squares = 0;
    for (int row = part.row; row < part.row_end(); ++row) {
        for (int col = part.col; col < part.col_end(); ++col) {
            const double v = value(row, col);
            sum += v;
            squares += v * v;
        }
    }
    const double n = static_cast<double>(part.area());
    return {sum / n, std::sqrt(squares / n - sum * sum / n / n)};
}

} // namespace

TEST_CASE("hashed noise has the moments of a Gaussian")
{
    const tiling::Rect part{-200, -200, 400, 400};
    const auto noise = [](int row, int col) { return gaussian(hash_at(5, row, col)); };
    const Moments m = moments(part, noise);
    CHECK(m.mean == Approx(0).margin(0.01));
    CHECK(m.std == Approx(1).margin(0.01));
    const Moments neighbours =
        moments(part, [&](int row, int col) { return noise(row, col) - noise(row, col + 1); });
    CHECK(neighbours.std == Approx(std::sqrt(2.0)).margin(0.01)); // uncorrelated
    const Moments fourth =
        moments(part, [&](int row, int col) { return std::pow(noise(row, col), 4); });
    CHECK(fourth.mean == Approx(3).margin(0.15));
}

TEST_CASE("textures have the contrast that they declare")
{
    const Texture texture{0.4, 0.05, 2.5, 3};
    const Moments m = moments(
        {0, 0, 600, 600}, [&](int row, int col) { return brightness(texture, 9, col, row); });
    CHECK(m.mean == Approx(0.4).margin(0.003));
    CHECK(m.std == Approx(0.05).epsilon(0.05));
}

TEST_CASE("sensor noise has its standard deviation, and differs between the images")
{
    Scene scene = plane(0);
    scene.size = {200, 200};
    scene.bits = 12;
    scene.terrain.texture = {0.5, 0, 2.5, 1};
    scene.left.noise_gray = 6;
    scene.right.noise_gray = 9;
    const Renderer r(scene);
    const auto left = image(r, View::left);
    const auto right = image(r, View::right);
    const tiling::Rect whole = tiling::rect_of(scene.size);
    const auto in_left = [&](int row, int col) { return left(row, col); };
    const auto sum = [&](int row, int col) { return left(row, col) + right(row, col); };
    CHECK(moments(whole, in_left).mean == Approx(4095 * 0.5).margin(0.2));
    CHECK(moments(whole, in_left).std == Approx(6).epsilon(0.02));
    CHECK(moments(whole, sum).std == Approx(std::hypot(6, 9)).epsilon(0.02));
}

TEST_CASE("low-texture areas keep the share of contrast that they declare")
{
    Scene scene = plane(0);
    scene.size = {240, 240};
    scene.bits = 16;
    scene.low_texture = {{20, 20, 200, 200, 0.02}};
    const tiling::Rect inside{30, 30, 180, 180};
    const auto with = image(Renderer(scene), View::left);
    scene.low_texture.clear();
    const auto without = image(Renderer(scene), View::left);
    const Moments low = moments(inside, [&](int r, int c) { return with(r, c); });
    const Moments full = moments(inside, [&](int r, int c) { return without(r, c); });
    CHECK(low.std == Approx(0.02 * full.std).epsilon(0.01));
    CHECK(with(5, 100) == without(5, 100));
}

TEST_CASE("the right camera applies gamma, gain and offset in this order")
{
    Scene scene = plane(0);
    scene.terrain.texture = {0.5, 0, 2.5, 1};
    scene.right = {0.8, 0.1, 2, 0, 0, {}};
    const auto right = image(Renderer(scene), View::right);
    CHECK(right(10, 10) == std::floor(255 * (0.8 * 0.25 + 0.1) + 0.5));
}

TEST_CASE("a scene is the same whenever it is rendered, and another with another seed")
{
    Scene scene = small_city();
    const auto first = image(Renderer(scene), View::right);
    CHECK(first == image(Renderer(scene), View::right));
    ++scene.seed;
    CHECK_FALSE(first == image(Renderer(scene), View::right));
}

TEST_CASE("a scene's bits are the same on every machine")
{
    // The hash of both truths and the left image of small_city(). If this changes, so does
    // every synthetic scene: say so in the change log.
    const Renderer r(small_city());
    std::uint64_t hash = 0;
    const auto left = image(r, View::left);
    for (const auto v : left.pixels()) {
        hash = mix(hash + v);
    }
    for (const View view : {View::left, View::right}) {
        const auto disparity = truth(r, view);
        for (const float v : disparity.pixels()) {
            hash = mix(hash + static_cast<std::uint64_t>(std::lround(v * 1024.0)));
        }
    }
    CHECK(hash == 0xf504995d30c5165au);
}
