#pragma once

#include "matcher/cuda/solve_job.h"
#include "matcher/options.h"
#include "matcher/pixel.h"

namespace hsgm::matcher::cuda {

/// Tones of all pixels of `pixels`.
cudaError_t compute_tones(Plane<const std::uint16_t> pixels, Tone tone,
                          Plane<std::uint8_t> result, cudaStream_t stream);

/// Where the texture is too low (docs/algorithm.md, section 3), for the pixels of `result`;
/// `pixels` and `tone` hold 3 px more, as far as the image goes.
cudaError_t compute_low_texture(Plane<const std::uint16_t> pixels,
                                Plane<const std::uint8_t> tone, Plane<std::uint8_t> result,
                                cudaStream_t stream);

/// What `cost` compares, for the pixels of `result`. `image` is the whole level's.
cudaError_t compute_features(Plane<const std::uint16_t> pixels, Area image, Cost cost,
                             Tone tone, Plane<Feature> result, cudaStream_t stream);

/// The same of costs with long features: bits of touching pixels; for pairs_bt, the gradient
/// and the least and largest of it within half a pixel, a byte each.
cudaError_t compute_long_features(Plane<const std::uint16_t> pixels, Area image, Cost cost,
                                  Tone tone, Plane<LongFeature> result, cudaStream_t stream);

/// What birchfield_tomasi compares, bytes from the lowest on: of `x` tone, least tone,
/// gradient, least gradient; of `y` largest tone, nothing, largest gradient.
cudaError_t compute_samples(Plane<const std::uint16_t> pixels, Area image, Tone tone,
                            Plane<Feature> result, cudaStream_t stream);

/// Whether a cost compares long features.
constexpr bool has_long_features(Cost cost)
{
    return cost == Cost::pairs5x5 || cost == Cost::pairs_bt;
}

/// How far round a left pixel a cost looks at the features of others.
constexpr int block_radius(Cost cost)
{
    return cost == Cost::birchfield_tomasi ? 1 : 0;
}

/// How features become the costs of `cost`; `table` on the device, for HMI.
CostRule cost_rule(Cost cost, const std::uint8_t* table);

} // namespace hsgm::matcher::cuda
