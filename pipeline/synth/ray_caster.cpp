#include "pipeline/synth/ray_caster.h"

#include "pipeline/synth/hash.h"
#include "pipeline/synth/texture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace hsgm::synth {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Interval {
    double begin = -kInfinity;
    double end = kInfinity;

    bool empty() const { return !(begin < end); }
};

Interval common(Interval a, Interval b)
{
    return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

constexpr Interval kNowhere{0, 0};

// The heights t with low <= at_zero + per_m * t <= high.
Interval between(double at_zero, double per_m, double low, double high)
{
    if (per_m == 0) {
        return at_zero >= low && at_zero <= high ? Interval{} : kNowhere;
    }
    const double a = (low - at_zero) / per_m;
    const double b = (high - at_zero) / per_m;
    return {std::min(a, b), std::max(a, b)};
}

// The heights at which (u / u_half)^2 + (v / v_half)^2 <= 1.
Interval inside_ellipse(double u, double u_per_m, double v, double v_per_m, const Piece& p)
{
    const double iu = 1 / (p.u_half * p.u_half);
    const double iv = 1 / (p.ellipse_v_half * p.ellipse_v_half);
    const double a = u_per_m * u_per_m * iu + v_per_m * v_per_m * iv;
    const double half_b = u * u_per_m * iu + v * v_per_m * iv;
    const double free = u * u * iu + v * v * iv - 1;
    if (a == 0) {
        return free <= 0 ? Interval{} : kNowhere;
    }
    const double discriminant = half_b * half_b - a * free;
    if (discriminant <= 0) {
        return kNowhere;
    }
    const double root = std::sqrt(discriminant);
    return {(-half_b - root) / a, (-half_b + root) / a};
}

// The heights at which the ray is over the footprint.
Interval over_footprint(const Piece& p, const Ray& ray)
{
    const double dx = ray.x - p.center_x;
    const double dy = ray.y - p.center_y;
    const double u = dx * p.cos_angle + dy * p.sin_angle;
    const double v = dy * p.cos_angle - dx * p.sin_angle;
    const double u_per_m = ray.x_per_m * p.cos_angle + ray.y_per_m * p.sin_angle;
    const double v_per_m = ray.y_per_m * p.cos_angle - ray.x_per_m * p.sin_angle;
    Interval heights = common(between(u, u_per_m, -p.u_half, p.u_half),
                              between(v, v_per_m, p.v_begin, p.v_end));
    if (p.ellipse && !heights.empty()) {
        heights = common(heights, inside_ellipse(u, u_per_m, v, v_per_m, p));
    }
    return heights;
}

// Where the ray first meets an object, if it does.
std::optional<Hit> hit_of(const Piece& p, const Ray& ray)
{
    const Interval over = over_footprint(p, ray);
    if (over.empty()) {
        return std::nullopt;
    }
    // The roof's height below the ray, as a line in the ray's height.
    const double at_zero = p.disparity(ray.x, ray.y);
    const double per_m = p.slope_x * ray.x_per_m + p.slope_y * ray.y_per_m;
    if (std::isfinite(over.end) && over.end <= at_zero + per_m * over.end) {
        return Hit{Surface::wall, over.end, &p};
    }
    const double roof_m = at_zero / (1 - per_m);
    if (roof_m >= over.begin && roof_m <= over.end) {
        return Hit{Surface::roof, roof_m, &p};
    }
    return std::nullopt;
}

// The ground rises by less than half a metre a cell, so each round halves the miss or better.
double ground_height(const TerrainSurface& ground, const Ray& ray)
{
    double height_m = ground.disparity(ray.x, ray.y);
    for (int i = 0; i < 100; ++i) {
        const double next_m = ground.disparity(ray.x_at(height_m), ray.y_at(height_m));
        const double step_m = next_m - height_m;
        height_m = next_m;
        if (std::abs(step_m) < 1e-9) {
            break;
        }
    }
    return height_m;
}

} // namespace

Hit RayCaster::first_hit(const Ray& ray) const
{
    Hit highest{Surface::ground, ground_height(landscape_.ground(), ray), nullptr};
    for (const Piece& piece : pieces_) {
        const auto hit = hit_of(piece, ray);
        if (hit && hit->height_m > highest.height_m) {
            highest = *hit;
        }
    }
    return highest;
}

double RayCaster::brightness(const Ray& ray, const Hit& hit) const
{
    const double x = ray.x_at(hit.height_m);
    const double y = ray.y_at(hit.height_m);
    switch (hit.surface) {
    case Surface::ground:
        return landscape_.ground_brightness(x, y);
    case Surface::roof:
        return landscape_.piece_brightness(*hit.piece, x, y);
    case Surface::wall:
        break;
    }
    // Painted along the wall and down it, so that it looks the same from everywhere.
    constexpr double kShade = 0.55;
    Piece wall = *hit.piece;
    wall.texture.mean *= kShade;
    wall.seed = child_seed(hit.piece->seed, 77);
    return landscape_.piece_brightness(wall, x + hit.height_m, y - 1.7 * hit.height_m);
}

} // namespace hsgm::synth
