#pragma once

#include "pipeline/synth/scene.h"

#include <cstdint>

namespace hsgm::synth {

/// Noise of mean 0 and standard deviation 1 at a point: value noise (random values on a
/// grid, smoothly interpolated) in octaves of equal strength, as in natural images. Grids
/// of successive octaves are turned against each other, so that none shows.
double octave_noise(std::uint64_t seed, double finest_px, int octaves, double x, double y);

/// Brightness of a texture at a point of the left image, not clipped.
inline double brightness(const Texture& texture, std::uint64_t seed, double x, double y,
                         double contrast_scale = 1)
{
    return texture.mean + texture.contrast * contrast_scale *
                              octave_noise(seed, texture.finest_px, texture.octaves, x, y);
}

/// 0 below -half, 1 above half, and a smooth step between: soft edges for painted shapes,
/// since a hard one would alias.
double smooth_step(double distance, double half);

} // namespace hsgm::synth
