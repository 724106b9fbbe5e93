#include "pipeline/synth/piece.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hsgm::synth {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Interval {
    double begin = -kInfinity;
    double end = kInfinity;
};

Interval common(Interval a, Interval b)
{
    return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

// The x with low <= offset + slope * x < high.
Interval solve_slab(double offset, double slope, double low, double high)
{
    if (std::abs(slope) < 1e-12) {
        return offset >= low && offset < high ? Interval{} : Interval{0, 0};
    }
    const double a = (low - offset) / slope;
    const double b = (high - offset) / slope;
    return {std::min(a, b), std::max(a, b)};
}

// The x (from the centre) inside the ellipse on the row y (from the centre): a quadratic.
Interval solve_ellipse(const Piece& p, double y)
{
    const double iu = 1 / (p.u_half * p.u_half);
    const double iv = 1 / (p.ellipse_v_half * p.ellipse_v_half);
    const double c = p.cos_angle;
    const double s = p.sin_angle;
    const double a = c * c * iu + s * s * iv;
    const double half_b = y * c * s * (iu - iv);
    const double free = y * y * (s * s * iu + c * c * iv) - 1;
    const double discriminant = half_b * half_b - a * free;
    if (discriminant <= 0) {
        return {0, 0};
    }
    const double root = std::sqrt(discriminant);
    return {(-half_b - root) / a, (-half_b + root) / a};
}

// The columns of the footprint in the left image.
Interval columns_on_row(const Piece& p, double y)
{
    const double dy = y - p.center_y;
    Interval x = common(solve_slab(p.sin_angle * dy, p.cos_angle, -p.u_half, p.u_half),
                        solve_slab(p.cos_angle * dy, -p.sin_angle, p.v_begin, p.v_end));
    if (p.ellipse) {
        x = common(x, solve_ellipse(p, dy));
    }
    return {x.begin + p.center_x, x.end + p.center_x};
}

Piece footprint_of(const Object& object, std::uint64_t seed, double ground_px)
{
    Piece p;
    p.center_x = object.center_x;
    p.center_y = object.center_y;
    p.cos_angle = cosine_of_turns(object.angle_deg / 360);
    p.sin_angle = sine_of_turns(object.angle_deg / 360);
    p.u_half = object.length_px / 2;
    p.v_begin = -object.width_px / 2;
    p.v_end = object.width_px / 2;
    p.ellipse = object.shape == Shape::ellipse;
    p.ellipse_v_half = object.width_px / 2;
    p.disparity_px = ground_px + object.height_px;
    p.texture = object.texture;
    p.seed = seed;
    return p;
}

// Tilts the plane: d changes by `per_px` per pixel along v = -x sin + y cos.
void tilt_across(Piece& p, double per_px)
{
    p.slope_x = -per_px * p.sin_angle;
    p.slope_y = per_px * p.cos_angle;
}

} // namespace

double Piece::radius_px() const
{
    return std::hypot(u_half, std::max(std::abs(v_begin), std::abs(v_end)));
}

double Piece::highest_px() const
{
    const double along = slope_x * cos_angle + slope_y * sin_angle;
    const double across = slope_y * cos_angle - slope_x * sin_angle;
    return disparity_px + std::abs(along) * u_half + std::max(across * v_begin, across * v_end);
}

Span span_on_row(const Piece& piece, View view, double y)
{
    const Interval x = columns_on_row(piece, y);
    Span span{x.begin, x.end, piece.disparity(0, y), piece.slope_x};
    if (view == View::right && span.end > span.begin) {
        // With d = a + b x and x_right = x - d: d = (a + b x_right) / (1 - b).
        span.begin -= piece.disparity(x.begin, y);
        span.end -= piece.disparity(x.end, y);
        span.at_zero /= 1 - piece.slope_x;
        span.slope /= 1 - piece.slope_x;
    }
    return span;
}

void append_pieces(const Object& object, std::uint64_t seed, const TerrainSurface& ground,
                   std::vector<Piece>& pieces)
{
    Piece p = footprint_of(object, seed, ground.disparity(object.center_x, object.center_y));
    if (object.roof == Roof::flat) {
        pieces.push_back(p);
        return;
    }
    if (object.roof == Roof::slope) {
        p.disparity_px += object.rise_px / 2;
        tilt_across(p, object.rise_px / object.width_px);
        pieces.push_back(p);
        return;
    }
    // A gable: the ridge is at v = 0, and its two sides catch the light differently.
    constexpr double kShade = 0.16; // of the brightness
    const double steepness = object.rise_px / (object.width_px / 2);
    p.disparity_px += object.rise_px;
    Piece far_side = p;
    p.v_end = 0;
    p.texture.mean *= 1 + kShade;
    tilt_across(p, steepness);
    far_side.v_begin = 0;
    far_side.texture.mean *= 1 - kShade;
    tilt_across(far_side, -steepness);
    pieces.push_back(p);
    pieces.push_back(far_side);
}

} // namespace hsgm::synth
