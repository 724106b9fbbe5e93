#pragma once

#include "pipeline/synth/scene.h"

#include <cstdint>

namespace hsgm::synth {

/// One camera: brightness to gray levels, pixel by pixel and without memory.
class Camera {
public:
    /// `seed` must differ between the cameras of a pair, or they share their noise.
    Camera(const Sensor& sensor, tiling::Size size, int full_scale, std::uint64_t seed)
        : sensor_(sensor), size_(size), full_scale_(full_scale), seed_(seed)
    {
    }

    /// Gray level 1..full scale of a pixel that has data.
    std::uint16_t gray(double brightness, int row, int col) const;

    /// Whether the pixel has data: inside the border, and in no hole.
    bool has_data(int row, int col) const;

private:
    Sensor sensor_;
    tiling::Size size_;
    int full_scale_;
    std::uint64_t seed_;
};

} // namespace hsgm::synth
