#pragma once

#include <array>

namespace hsgm::geometry {

/// The 20 terms of RPC00B for normalised longitude l, latitude p and height h:
///
///     1 l p h   lp lh ph   ll pp hh   plh   lll lpp lhh llp ppp phh llh pph hhh
///
/// by Horner's scheme, always in this order of operations.
inline double cubic(const std::array<double, 20>& c, double l, double p, double h)
{
    return c[0] +
           l * (c[1] + l * (c[7] + l * c[11] + p * c[14] + h * c[17]) +
                p * (c[4] + p * c[12] + h * c[10]) + h * (c[5] + h * c[13])) +
           p * (c[2] + p * (c[8] + p * c[15] + h * c[18]) + h * (c[6] + h * c[16])) +
           h * (c[3] + h * (c[9] + h * c[19]));
}

/// A value and its derivatives by normalised longitude, latitude and height.
struct Gradient {
    double value = 0;
    double by_l = 0;
    double by_p = 0;
    double by_h = 0;
};

inline Gradient cubic_gradient(const std::array<double, 20>& c, double l, double p, double h)
{
    return {cubic(c, l, p, h),
            c[1] + l * (2 * c[7] + 3 * l * c[11] + 2 * p * c[14] + 2 * h * c[17]) +
                p * (c[4] + p * c[12] + h * c[10]) + h * (c[5] + h * c[13]),
            c[2] + p * (2 * c[8] + 3 * p * c[15] + 2 * h * c[18]) + h * (c[6] + h * c[16]) +
                l * (c[4] + 2 * p * c[12] + h * c[10] + l * c[14]),
            c[3] + h * (2 * c[9] + 3 * h * c[19]) +
                l * (c[5] + 2 * h * c[13] + p * c[10] + l * c[17]) +
                p * (c[6] + 2 * h * c[16] + p * c[18])};
}

/// numerator / denominator, differentiated.
inline Gradient ratio(const Gradient& numerator, const Gradient& denominator)
{
    const double value = numerator.value / denominator.value;
    const auto by = [&](double n, double d) { return (n - value * d) / denominator.value; };
    return {value, by(numerator.by_l, denominator.by_l), by(numerator.by_p, denominator.by_p),
            by(numerator.by_h, denominator.by_h)};
}

} // namespace hsgm::geometry
