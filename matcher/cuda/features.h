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

/// Whether there is a rule for this cost on devices.
bool has_cost_rule(Cost cost);

/// How features become the costs of `cost`; `table` on the device, for HMI.
CostRule cost_rule(Cost cost, const std::uint8_t* table);

} // namespace hsgm::matcher::cuda
