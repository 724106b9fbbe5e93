#include "pipeline/synth/texture.h"

#include "pipeline/synth/hash.h"

#include <algorithm>
#include <cmath>

namespace hsgm::synth {

namespace {

// A conversion instead of std::floor, which is a library call without SSE 4.1.
std::int64_t floor_to_int(double v)
{
    const auto truncated = static_cast<std::int64_t>(v);
    return truncated - (v < static_cast<double>(truncated) ? 1 : 0);
}

double fade(double t)
{
    return t * t * (3 - 2 * t);
}

double value_noise(std::uint64_t seed, double x, double y)
{
    const std::int64_t col = floor_to_int(x);
    const std::int64_t row = floor_to_int(y);
    const double u = fade(x - static_cast<double>(col));
    const double v = fade(y - static_cast<double>(row));
    const double a = uniform_signed(hash_at(seed, row, col));
    const double b = uniform_signed(hash_at(seed, row, col + 1));
    const double c = uniform_signed(hash_at(seed, row + 1, col));
    const double d = uniform_signed(hash_at(seed, row + 1, col + 1));
    const double above = a + u * (b - a);
    const double below = c + u * (d - c);
    return above + v * (below - above);
}

// Uniform values have variance 1/3. Interpolation with weights f and 1 - f, f = 3t^2 - 2t^3,
// multiplies it by the mean of f^2 + (1 - f)^2 = 26/35 per axis.
constexpr double kVarianceOfOctave = (26.0 / 35) * (26.0 / 35) / 3;

} // namespace

double octave_noise(std::uint64_t seed, double finest_px, int octaves, double x, double y)
{
    double px = x / finest_px;
    double py = y / finest_px;
    double sum = 0;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += value_noise(seed + static_cast<std::uint64_t>(octave), px, py);
        // Half the frequency, turned by the angle of the 3-4-5 triangle.
        const double turned = 0.5 * (0.8 * px - 0.6 * py);
        py = 0.5 * (0.6 * px + 0.8 * py);
        px = turned;
    }
    return sum / std::sqrt(octaves * kVarianceOfOctave);
}

double smooth_step(double distance, double half)
{
    return fade(std::clamp(0.5 + 0.5 * distance / half, 0.0, 1.0));
}

} // namespace hsgm::synth
