#include "pipeline/geometry/resampler.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

namespace hsgm::geometry {

using tiling::ImageView;
using tiling::Patch;
using tiling::Rect;

namespace {

constexpr int kPhases = 1024; // fractions of a pixel
constexpr int kBlockPx = 512;
/// Beyond any image, and yet with room for sums in an int.
constexpr double kFar = 1 << 20;

double keys(double t)
{
    const double a = std::abs(t);
    return a < 1 ? 1 + a * a * (1.5 * a - 2.5) : a < 2 ? 2 + a * (-4 + a * (2.5 - 0.5 * a)) : 0;
}

double sinc(double t)
{
    const double x = std::numbers::pi * t;
    return t == 0 ? 1 : std::sin(x) / x;
}

double lanczos3(double t)
{
    return std::abs(t) < 3 ? sinc(t) * sinc(t / 3) : 0;
}

/// Scales weights to a sum of exactly 1, each a multiple of 2^-18. So weighted sums of 16-bit
/// pixels are exact in a double, and the same on every machine, whatever its sine's last bit.
void round_to_one(std::span<double> weights)
{
    constexpr double kUnit = 1 << 18;
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    double rest = 1;
    for (double& w : weights) {
        w = std::floor(w / sum * kUnit + 0.5) / kUnit;
        rest -= w;
    }
    *std::max_element(weights.begin(), weights.end()) += rest;
}

/// Steps of the lattice in the middle of the frame: how far one coordinate of the source moves
/// for a pixel of the frame, both ways together.
double span_of(const Lattice& lattice, std::size_t coordinate)
{
    const int i = lattice.rows() / 2;
    const int j = lattice.cols() / 2;
    const double here = lattice.node(i, j)[coordinate];
    const double down = (lattice.node(i - 1, j)[coordinate] - here) / lattice.step();
    const double along = (lattice.node(i, j - 1)[coordinate] - here) / lattice.step();
    return std::sqrt(down * down + along * along);
}

int to_fixed(double px)
{
    const double clamped = std::isnan(px) ? -kFar : std::clamp(px, -kFar, kFar);
    return static_cast<int>(std::floor(clamped * kPhases + 0.5));
}

int whole(int fixed)
{
    return tiling::floor_div(fixed, kPhases);
}

int nearest(int fixed)
{
    return whole(fixed + kPhases / 2);
}

} // namespace

struct Resampler::Places {
    tiling::Image<int> x;
    tiling::Image<int> y;
    int x_min = std::numeric_limits<int>::max();
    int x_max = std::numeric_limits<int>::min();
    int y_min = std::numeric_limits<int>::max();
    int y_max = std::numeric_limits<int>::min();
};

Resampler::Weights Resampler::make_weights(double span, Kernel kernel)
{
    Weights weights;
    weights.span = span;
    const double stretch = std::max(span, 1.0);
    const int lobes = kernel == Kernel::bicubic ? 2 : 3;
    weights.taps = 2 * static_cast<int>(std::ceil(lobes * stretch));
    weights.table.resize(static_cast<std::size_t>(kPhases) *
                         static_cast<std::size_t>(weights.taps));
    for (int phase = 0; phase < kPhases; ++phase) {
        double* row = weights.table.data() +
                      static_cast<std::size_t>(phase) * static_cast<std::size_t>(weights.taps);
        for (int k = 0; k < weights.taps; ++k) {
            const double t =
                (k - (weights.taps / 2 - 1) - static_cast<double>(phase) / kPhases) / stretch;
            row[k] = kernel == Kernel::bicubic ? keys(t) : lanczos3(t);
        }
        round_to_one({row, static_cast<std::size_t>(weights.taps)});
    }
    return weights;
}

Resampler::Resampler(const Lattice& sensor_from_frame, tiling::Size source, Kernel kernel,
                     PlaceInSource then)
    : lattice_(sensor_from_frame), source_(source), then_(std::move(then)),
      across_(make_weights(span_of(sensor_from_frame, 0), kernel)),
      down_(make_weights(span_of(sensor_from_frame, 1), kernel))
{
    assert(lattice_.channels() == 2);
    assert(source.rows < kFar && source.cols < kFar);
}

Resampler::Places Resampler::places_of(const Rect& block) const
{
    Places places{tiling::Image<int>(block.size()), tiling::Image<int>(block.size())};
    LatticeRow along(lattice_);
    std::array<double, 2> xy{};
    for (int r = 0; r < block.rows; ++r) {
        along.set(block.row + r);
        for (int c = 0; c < block.cols; ++c) {
            along.at(block.col + c, xy);
            if (then_) {
                const ImagePoint place = then_({xy[0], xy[1]});
                xy = {place.x, place.y};
            }
            const int x = to_fixed(xy[0]);
            const int y = to_fixed(xy[1]);
            places.x(r, c) = x;
            places.y(r, c) = y;
            places.x_min = std::min(places.x_min, x);
            places.x_max = std::max(places.x_max, x);
            places.y_min = std::min(places.y_min, y);
            places.y_max = std::max(places.y_max, y);
        }
    }
    return places;
}

/// All pixels under the kernels of the places; may reach outside the source.
Rect Resampler::reach(const Places& places) const
{
    const int before_x = across_.taps / 2 - 1;
    const int before_y = down_.taps / 2 - 1;
    return tiling::rect_between(whole(places.y_min) - before_y, whole(places.x_min) - before_x,
                                whole(places.y_max) + down_.taps / 2 + 1,
                                whole(places.x_max) + across_.taps / 2 + 1);
}

Rect Resampler::source_window(const Rect& window) const
{
    Rect all;
    for (int row = window.row; row < window.row_end(); row += kBlockPx) {
        for (int col = window.col; col < window.col_end(); col += kBlockPx) {
            const Rect block = intersect({row, col, kBlockPx, kBlockPx}, window);
            all = unite(all, intersect(reach(places_of(block)), rect_of(source_)));
        }
    }
    return all;
}

/// The weighted mean of the pixels under the kernel; NaN where one of them has no value.
double Resampler::value(const Patch<double>& source, int x_fixed, int y_fixed) const
{
    const int x = whole(x_fixed);
    const int y = whole(y_fixed);
    const double* across = across_.at(x_fixed - x * kPhases);
    const double* down = down_.at(y_fixed - y * kPhases);
    const double* pixels = &source.at(y - (down_.taps / 2 - 1), x - (across_.taps / 2 - 1));
    double sum = 0;
    for (int r = 0; r < down_.taps; ++r) {
        double row = 0;
        for (int c = 0; c < across_.taps; ++c) {
            row += across[c] * pixels[c];
        }
        sum += down[r] * row;
        pixels += source.rect.cols;
    }
    return sum;
}

/// The same with `nearest` for pixels without a value.
double Resampler::patched(const Patch<double>& source, int x_fixed, int y_fixed,
                          double nearest) const
{
    const int x = whole(x_fixed);
    const int y = whole(y_fixed);
    const double* across = across_.at(x_fixed - x * kPhases);
    const double* down = down_.at(y_fixed - y * kPhases);
    const double* pixels = &source.at(y - (down_.taps / 2 - 1), x - (across_.taps / 2 - 1));
    double sum = 0;
    for (int r = 0; r < down_.taps; ++r) {
        double row = 0;
        for (int c = 0; c < across_.taps; ++c) {
            row += across[c] * (std::isnan(pixels[c]) ? nearest : pixels[c]);
        }
        sum += down[r] * row;
        pixels += source.rect.cols;
    }
    return sum;
}

void Resampler::resample_block(const Rect& block, const ReadPixels& read,
                               ImageView<double> result) const
{
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const Places places = places_of(block);
    const Rect wanted = reach(places);
    const Rect there = intersect(wanted, rect_of(source_));
    Patch<double> source;
    if (!there.empty()) {
        // Pixels beyond the source's edges have no value, like masked ones.
        source = Patch<double>(
            intersect(wanted, expand(rect_of(source_), across_.taps + down_.taps)), kNone);
        read(there, source.view_of(there));
    }
    for (int r = 0; r < block.rows; ++r) {
        for (int c = 0; c < block.cols; ++c) {
            const int x = places.x(r, c);
            const int y = places.y(r, c);
            double& pixel = result(r, c);
            pixel = kNone;
            if (!rect_of(source_).contains(nearest(y), nearest(x))) {
                continue;
            }
            const double centre = source.at(nearest(y), nearest(x));
            if (std::isnan(centre)) {
                continue;
            }
            pixel = value(source, x, y);
            if (std::isnan(pixel)) {
                pixel = patched(source, x, y, centre);
            }
        }
    }
}

void Resampler::resample(const Rect& window, const ReadPixels& read,
                         ImageView<double> result) const
{
    assert(result.size() == window.size());
    for (int row = window.row; row < window.row_end(); row += kBlockPx) {
        for (int col = window.col; col < window.col_end(); col += kBlockPx) {
            const Rect block = intersect({row, col, kBlockPx, kBlockPx}, window);
            resample_block(
                block, read,
                result.part({row - window.row, col - window.col, block.rows, block.cols}));
        }
    }
}

} // namespace hsgm::geometry
