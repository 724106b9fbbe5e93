#include "matcher/cuda/features.h"

#include "matcher/cuda/feature_pixels.cuh"

#include <stdexcept>

namespace hsgm::matcher::cuda {

namespace features {

constexpr int kTextureRadius = 3;

__global__ void tones(Plane<const std::uint16_t> pixels, Tone tone, Plane<std::uint8_t> result)
{
    for (std::size_t i = first_pixel(); i < pixels.area.pixels(); i += pixel_step()) {
        result.data[i] = tone(pixels.data[i]);
    }
}

__device__ bool is_flat(const Plane<const std::uint16_t>& pixels,
                        const Plane<const std::uint8_t>& tone, Pixel p)
{
    const Area& area = pixels.area;
    const int row_end = least_of(p.row + kTextureRadius + 1, area.row_end());
    const int col_end = least_of(p.col + kTextureRadius + 1, area.col_end());
    int least = 255;
    int most = 0;
    for (int row = most_of(p.row - kTextureRadius, area.row); row < row_end; ++row) {
        for (int col = most_of(p.col - kTextureRadius, area.col); col < col_end; ++col) {
            if (is_valid(pixels.at(row, col))) {
                const int value = tone.at(row, col);
                least = least_of(least, value);
                most = most_of(most, value);
            }
        }
        if (most - least >= kTextureGate) {
            return false;
        }
    }
    return true;
}

__global__ void low_texture(Plane<const std::uint16_t> pixels, Plane<const std::uint8_t> tone,
                            Plane<std::uint8_t> result)
{
    for (std::size_t i = first_pixel(); i < result.area.pixels(); i += pixel_step()) {
        const Pixel p = pixel_of(result.area, i);
        result.data[i] = is_valid(pixels.at(p.row, p.col)) && is_flat(pixels, tone, p) ? 1 : 0;
    }
}

// What a census looks at.
struct CensusShape {
    int radius_rows;
    int radius_cols;
    bool ternary; ///< two bits for each neighbour: below and above a band
    int band;
    bool with_tone; ///< the tone beside the bits, in `y`
};

__device__ void add_neighbour(Bits& bits, const CensusShape& shape, int neighbour, int centre)
{
    const bool valid = is_valid(static_cast<std::uint16_t>(neighbour));
    bits.add(valid && neighbour + shape.band < centre);
    if (shape.ternary) {
        bits.add(valid && centre + shape.band < neighbour);
    }
}

__global__ void census(Plane<const std::uint16_t> pixels, Area image, CensusShape shape,
                       Tone tone, Plane<Feature> result)
{
    for (std::size_t i = first_pixel(); i < result.area.pixels(); i += pixel_step()) {
        const Pixel p = pixel_of(result.area, i);
        const std::uint16_t centre = pixels.at(p.row, p.col);
        Bits bits;
        for (int dr = -shape.radius_rows; dr <= shape.radius_rows; ++dr) {
            const int row = clamped(p.row + dr, 0, image.rows - 1);
            for (int dc = -shape.radius_cols; dc <= shape.radius_cols; ++dc) {
                const int col = clamped(p.col + dc, 0, image.cols - 1);
                if (dr != 0 || dc != 0) {
                    add_neighbour(bits, shape, pixels.at(row, col), centre);
                }
            }
        }
        const unsigned beside = shape.with_tone ? tone(centre) : 0U;
        result.data[i] =
            make_uint2(bits.low, bits.high | beside | (is_valid(centre) ? kValidFeature : 0U));
    }
}

__global__ void tone_features(Plane<const std::uint16_t> pixels, Tone tone,
                              Plane<Feature> result)
{
    for (std::size_t i = first_pixel(); i < result.area.pixels(); i += pixel_step()) {
        const Pixel p = pixel_of(result.area, i);
        const std::uint16_t pixel = pixels.at(p.row, p.col);
        result.data[i] = make_uint2(tone(pixel), is_valid(pixel) ? kValidFeature : 0U);
    }
}

} // namespace features

cudaError_t compute_tones(Plane<const std::uint16_t> pixels, Tone tone,
                          Plane<std::uint8_t> result, cudaStream_t stream)
{
    return launch(features::tones, features::blocks_for(result.area), features::kThreads, 0,
                  stream, pixels, tone, result);
}

cudaError_t compute_low_texture(Plane<const std::uint16_t> pixels,
                                Plane<const std::uint8_t> tone, Plane<std::uint8_t> result,
                                cudaStream_t stream)
{
    return launch(features::low_texture, features::blocks_for(result.area), features::kThreads,
                  0, stream, pixels, tone, result);
}

cudaError_t compute_features(Plane<const std::uint16_t> pixels, Area image, Cost cost,
                             Tone tone, Plane<Feature> result, cudaStream_t stream)
{
    if (result.area.pixels() == 0) {
        return cudaSuccess; // no disparity of the range meets the right image here
    }
    const int blocks = features::blocks_for(result.area);
    if (cost == Cost::hmi) {
        return launch(features::tone_features, blocks, features::kThreads, 0, stream, pixels,
                      tone, result);
    }
    if (cost == Cost::birchfield_tomasi) {
        return compute_samples(pixels, image, tone, result, stream);
    }
    const CostTraits of_cost = traits(cost);
    features::CensusShape shape{of_cost.radius_rows, of_cost.radius_cols, false, 0, false};
    shape.ternary = cost == Cost::ternary5x5;
    shape.band = shape.ternary ? tone.tolerance() : 0;
    shape.with_tone = cost == Cost::census_ad;
    return launch(features::census, blocks, features::kThreads, 0, stream, pixels, image, shape,
                  tone, result);
}

CostRule cost_rule(Cost cost, const std::uint8_t* table)
{
    CostRule rule;
    rule.most = traits(cost).max;
    switch (cost) {
    case Cost::census5x5:
        rule.scale = 2;
        return rule;
    case Cost::census7x7:
    case Cost::census9x7:
    case Cost::ternary5x5:
        return rule;
    case Cost::census_ad:
        rule.kind = CostKind::census_tone;
        return rule;
    case Cost::hmi:
        rule.kind = CostKind::table;
        rule.table = table;
        return rule;
    case Cost::pairs5x5:
        rule.kind = CostKind::pairs;
        rule.scale = 4;
        return rule;
    case Cost::pairs_bt:
        rule.kind = CostKind::pairs;
        rule.scale = 3;
        return rule;
    case Cost::birchfield_tomasi:
        rule.kind = CostKind::block;
        return rule;
    }
    throw std::logic_error("no rule for this cost on CUDA devices");
}

} // namespace hsgm::matcher::cuda
