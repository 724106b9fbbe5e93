#include "pipeline/synth/sensor.h"

#include "pipeline/synth/hash.h"

#include <algorithm>
#include <cmath>

namespace hsgm::synth {

std::uint16_t Camera::gray(double brightness, int row, int col) const
{
    double signal = std::max(brightness, 0.0);
    if (sensor_.gamma != 1) {
        signal = std::pow(signal, sensor_.gamma);
    }
    double level = full_scale_ * (sensor_.gain * signal + sensor_.offset);
    if (sensor_.noise_gray > 0) {
        level += sensor_.noise_gray * gaussian(hash_at(seed_, row, col));
    }
    return static_cast<std::uint16_t>(
        std::clamp(std::floor(level + 0.5), 1.0, static_cast<double>(full_scale_)));
}

bool Camera::has_data(int row, int col) const
{
    const int border = sensor_.nodata_border_px;
    if (row < border || col < border || row >= size_.rows - border ||
        col >= size_.cols - border) {
        return false;
    }
    return std::none_of(sensor_.holes.begin(), sensor_.holes.end(), [&](const Hole& hole) {
        const double dx = col - hole.center_x;
        const double dy = row - hole.center_y;
        return dx * dx + dy * dy <= hole.radius_px * hole.radius_px;
    });
}

} // namespace hsgm::synth
