#include "pipeline/synth/terrain.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hsgm::synth {

namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

// Ratios of successive terms of the sine's series, 1 / (n (n + 1)), last first.
constexpr double kSeriesRatios[] = {1.0 / 420, 1.0 / 342, 1.0 / 272, 1.0 / 210, 1.0 / 156,
                                    1.0 / 110, 1.0 / 72,  1.0 / 42,  1.0 / 20,  1.0 / 6};

} // namespace

double sine_of_turns(double turns)
{
    // Into [-1/2, 1/2], then folded into [-1/4, 1/4], where the series converges fast.
    double t = turns - std::floor(turns + 0.5);
    t = t > 0.25 ? 0.5 - t : (t < -0.25 ? -0.5 - t : t);
    const double z = kTwoPi * t;
    const double zz = z * z;
    double sum = 1;
    for (const double ratio : kSeriesRatios) {
        sum = 1 - sum * zz * ratio;
    }
    return z * sum;
}

TerrainSurface::TerrainSurface(const Terrain& terrain)
    : offset_px_(terrain.offset_px), slope_x_(terrain.slope_x), slope_y_(terrain.slope_y)
{
    for (const Wave& wave : terrain.waves) {
        const double direction = wave.direction_deg / 360;
        waves_.push_back({wave.amplitude_px, cosine_of_turns(direction) / wave.wavelength_px,
                          sine_of_turns(direction) / wave.wavelength_px, wave.phase_deg / 360});
    }
}

double TerrainSurface::disparity(double x, double y) const
{
    double d = offset_px_ + slope_x_ * x + slope_y_ * y;
    for (const Sinusoid& w : waves_) {
        d += w.amplitude_px *
             sine_of_turns(w.turns_per_col * x + w.turns_per_row * y + w.phase_turns);
    }
    return d;
}

double TerrainSurface::slope_x(double x, double y) const
{
    double slope = slope_x_;
    for (const Sinusoid& w : waves_) {
        slope += w.amplitude_px * kTwoPi * w.turns_per_col *
                 cosine_of_turns(w.turns_per_col * x + w.turns_per_row * y + w.phase_turns);
    }
    return slope;
}

double TerrainSurface::disparity_from_right(double x_right, double y) const
{
    // Without waves this start is the answer.
    double d = (offset_px_ + slope_x_ * x_right + slope_y_ * y) / (1 - slope_x_);
    if (waves_.empty()) {
        return d;
    }
    // Newton is quick, but may in theory swing where the slope changes much; the plain
    // iteration after it contracts by at least a half.
    for (int i = 0; i < 60; ++i) {
        const double x = x_right + d;
        const double miss = disparity(x, y) - d;
        const double step = i < 8 ? miss / (1 - slope_x(x, y)) : miss;
        d += step;
        if (std::abs(step) < 1e-6 && i < 8) {
            break; // Newton squares the error: what is left is below 1e-11
        }
        if (std::abs(step) < 1e-12) {
            break;
        }
    }
    return d;
}

double TerrainSurface::steepest_slope_x() const
{
    double steepest = std::abs(slope_x_);
    for (const Sinusoid& w : waves_) {
        steepest += std::abs(w.amplitude_px * kTwoPi * w.turns_per_col);
    }
    return steepest;
}

DisparityBounds TerrainSurface::bounds(tiling::Size size, double margin_px) const
{
    double waves_px = 0;
    for (const Sinusoid& w : waves_) {
        waves_px += std::abs(w.amplitude_px);
    }
    DisparityBounds b{offset_px_, offset_px_};
    for (const double x : {-margin_px, size.cols + margin_px}) {
        for (const double y : {-margin_px, size.rows + margin_px}) {
            const double plane = offset_px_ + slope_x_ * x + slope_y_ * y;
            // At the right view's column x, d = plane(x + d) + waves.
            for (const double from_view : {1.0, 1 / (1 - slope_x_)}) {
                b.min_px = std::min(b.min_px, (plane - waves_px) * from_view);
                b.max_px = std::max(b.max_px, (plane + waves_px) * from_view);
            }
        }
    }
    return b;
}

} // namespace hsgm::synth
