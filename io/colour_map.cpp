#include "io/colour_map.h"

#include <algorithm>
#include <cmath>

namespace hsgm::io {

namespace {

using Polynomial = std::array<double, 6>; // lowest power first

constexpr Polynomial kRed{0.13572138,   4.61539260,    -42.66032258,
                          132.13108234, -152.94239396, 59.28637943};
constexpr Polynomial kGreen{0.09140261,   2.19418839, 4.84296658,
                            -14.18503333, 4.27729857, 2.82956604};
constexpr Polynomial kBlue{0.10667330,   12.64194608,  -60.58204836,
                           110.36276771, -89.90310912, 27.34824973};

std::uint8_t level(const Polynomial& polynomial, double x)
{
    double y = 0;
    for (auto factor = polynomial.rbegin(); factor != polynomial.rend(); ++factor) {
        y = y * x + *factor;
    }
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(y, 0.0, 1.0)));
}

} // namespace

Rgb turbo(double position)
{
    const double x = std::clamp(position, 0.0, 1.0);
    return {level(kRed, x), level(kGreen, x), level(kBlue, x)};
}

} // namespace hsgm::io
