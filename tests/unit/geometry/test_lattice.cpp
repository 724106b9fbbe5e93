#include "tests/catch.h"

#include "pipeline/geometry/lattice.h"

#include <array>
#include <cmath>

using namespace hsgm::geometry;

namespace {

Lattice filled(double (*first)(double, double), double (*second)(double, double))
{
    Lattice lattice(-10, 20, 10, 7, 6, 2);
    for (int i = 0; i < 7; ++i) {
        for (int j = 0; j < 6; ++j) {
            lattice.node(i, j)[0] = first(-10 + i * 10, 20 + j * 10);
            lattice.node(i, j)[1] = second(-10 + i * 10, 20 + j * 10);
        }
    }
    return lattice;
}

double a_cubic(double r, double c)
{
    return 3 + r - 2 * c + 0.1 * r * r * c - 0.003 * c * c * c + 1e-5 * r * r * r * c * c * c;
}

double a_wave(double r, double c)
{
    return std::sin(r / 40) + std::cos(c / 50);
}

} // namespace

TEST_CASE("a lattice is exact for cubics, and close for what is smooth")
{
    const Lattice lattice = filled(a_cubic, a_wave);
    for (double row = 0; row <= 40; row += 1.7) {
        for (double col = 30; col <= 60; col += 1.3) {
            std::array<double, 2> value{};
            lattice.at(row, col, value);
            CHECK(value[0] == Approx(a_cubic(row, col)).epsilon(1e-12));
            CHECK(value[1] == Approx(a_wave(row, col)).margin(2e-4));
        }
    }
}

TEST_CASE("a row of a lattice has the lattice's bits")
{
    const Lattice lattice = filled(a_cubic, a_wave);
    LatticeRow along(lattice);
    for (double row = -3; row <= 44; row += 4.7) {
        along.set(row);
        for (double col = 25; col <= 66; col += 3.1) {
            std::array<double, 2> a{};
            std::array<double, 2> b{};
            lattice.at(row, col, a);
            along.at(col, b);
            REQUIRE(a == b);
        }
    }
}

TEST_CASE("a lattice with another origin has the same values elsewhere")
{
    const Lattice lattice = filled(a_cubic, a_wave);
    Lattice moved = lattice;
    moved.move_origin(5, 30);
    std::array<double, 2> a{};
    std::array<double, 2> b{};
    lattice.at(12, 41, a);
    moved.at(7, 11, b);
    CHECK(a == b);
}
