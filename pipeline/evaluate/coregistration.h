#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace hsgm::evaluate {

/// How a surface lies beside another one, in the units of the map and of the heights.
struct SurfaceShift {
    double east = 0; ///< the test's features lie that much too far east,
    double north = 0;
    double up = 0; ///< and that much too high

    bool operator==(const SurfaceShift&) const = default;
};

/// Finds the shift between two surfaces from their height differences and the slope of the
/// reference (Nuth and Kaeaeb, The Cryosphere 2011). A surface shifted by (e, n, u) differs by
///     dh = u - e * slope_east - n * slope_north
/// to first order, which is their equation 3 before it is divided by the slope's tangent: in
/// this form flat cells say what they know, the height, and the fit is linear. One sum per
/// step; `SurfaceShift` is refined by sampling the test anew and fitting what is left.
class ShiftFit {
public:
    /// A cell whose difference is within `limit_m` of `centre_m` counts, others are outliers.
    ShiftFit(double centre_m, double limit_m) : centre_m_(centre_m), limit_m_(limit_m) {}

    /// One cell: test - reference in metres and the reference's slope, m per m.
    void add(double difference_m, double slope_east, double slope_north);

    /// How many cells counted.
    std::int64_t cells() const { return cells_; }

    /// The shift that explains the differences best, by least squares. Nothing where the
    /// ground is too flat or slopes one way only, so that the horizontal shift is anybody's
    /// guess: where its standard error for noise of 1 m would pass 1 m, or where the ground
    /// slopes by less than `kLeastSlope` in the direction in which it is flattest. (There an
    /// error of 5 cm that goes with the slope would pass for a shift of 5 m.)
    std::optional<SurfaceShift> shift() const;
    /// Root mean square of the slopes about their mean, m per m, in the direction in which it
    /// is least; 0 where nothing counted.
    double weakest_slope() const;
    static constexpr double kLeastSlope = 0.01;
    /// The height alone: the mean of what counted; nothing where nothing did.
    std::optional<double> up() const;

private:
    /// Sums of products of slopes about their means.
    struct Moments {
        double ee = 0;
        double en = 0;
        double nn = 0;
    };
    Moments moments() const;

    double centre_m_;
    double limit_m_;
    std::int64_t cells_ = 0;
    std::array<double, 6>
        normal_{}; // upper triangle of A'A; A's rows: -slope_east, -slope_north, 1
    std::array<double, 3> right_{}; // A'dh
};

} // namespace hsgm::evaluate
