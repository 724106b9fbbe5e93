#include "matcher/cuda/feature_pixels.cuh"

namespace hsgm::matcher::cuda {

namespace features {

constexpr int kGradientClip = 15;

// An image with its own pixels beyond its borders.
struct Replicated {
    Plane<const std::uint16_t> pixels;
    Area image;
    Tone tone;

    __device__ std::uint16_t at(int row, int col) const
    {
        return pixels.at(clamped(row, 0, image.rows - 1), clamped(col, 0, image.cols - 1));
    }
};

// Along a row; 0 where a pixel is missing.
__device__ int tone_difference(const Replicated& from, int row, int col)
{
    const std::uint16_t before = from.at(row, col - 1);
    const std::uint16_t after = from.at(row, col + 1);
    return is_valid(before) && is_valid(after) ? from.tone(after) - from.tone(before) : 0;
}

__device__ int gradient(const Replicated& from, int row, int col)
{
    const int sum = 2 * tone_difference(from, row, col) + tone_difference(from, row - 1, col) +
                    tone_difference(from, row + 1, col);
    return clamped(sum, -kGradientClip, kGradientClip) + kGradientClip;
}

// A value, and the least and largest within half a pixel of it.
struct Sample {
    unsigned value;
    unsigned least;
    unsigned most;
};

// Neighbours outside the image or without a value count as the pixel itself.
template <typename Map>
__device__ Sample sample(const Replicated& from, Pixel p, Map map)
{
    const int value = map(p.row, p.col);
    int least = value;
    int most = value;
#pragma unroll
    for (int step = -1; step <= 1; step += 2) {
        const int col = p.col + step;
        if (col >= 0 && col < from.image.cols && is_valid(from.pixels.at(p.row, col))) {
            const int mean = (value + map(p.row, col) + 1) >> 1;
            least = least_of(least, mean);
            most = most_of(most, mean);
        }
    }
    return {static_cast<unsigned>(value), static_cast<unsigned>(least),
            static_cast<unsigned>(most)};
}

__device__ Sample sampled_gradient(const Replicated& from, Pixel p)
{
    return sample(from, p, [&](int row, int col) { return gradient(from, row, col); });
}

__device__ unsigned validity(std::uint16_t pixel)
{
    return is_valid(pixel) ? kValidFeature : 0U;
}

// Pixels that touch, at least one of them within a pixel of the centre; those of the 3 x 3 that
// share a side, both ways (docs/algorithm.md, section 3).
__device__ Bits touching_pairs(const Replicated& from, Pixel p)
{
    Bits bits;
#pragma unroll
    for (int i = 0; i < 9; ++i) {
        const int row = i / 3 - 1;
        const int col = i % 3 - 1;
        const std::uint16_t a = from.at(p.row + row, p.col + col);
#pragma unroll
        for (int k = 0; k < 9; ++k) {
            const int row_step = k / 3 - 1;
            const int col_step = k % 3 - 1;
            const int b_row = row + row_step;
            const int b_col = col + col_step;
            const bool inside = b_row >= -1 && b_row <= 1 && b_col >= -1 && b_col <= 1;
            if (k == 4 || (inside && 3 * b_row + b_col < 3 * row + col)) {
                continue; // itself, or known from the other side
            }
            const std::uint16_t b = from.at(p.row + b_row, p.col + b_col);
            const bool valid = is_valid(a) && is_valid(b);
            bits.add(valid && b < a);
            if (inside && (row_step == 0 || col_step == 0)) {
                bits.add(valid && a < b);
            }
        }
    }
    return bits;
}

__global__ void pairs(Replicated from, bool with_gradient, Plane<LongFeature> result)
{
    for (std::size_t i = first_pixel(); i < result.area.pixels(); i += pixel_step()) {
        const Pixel p = pixel_of(result.area, i);
        const Bits bits = touching_pairs(from, p);
        Sample of_gradient{};
        if (with_gradient) {
            of_gradient = sampled_gradient(from, p);
        }
        result.data[i] =
            make_uint4(bits.low, bits.high,
                       of_gradient.value | of_gradient.least << 8 | of_gradient.most << 16,
                       validity(from.at(p.row, p.col)));
    }
}

__global__ void samples(Replicated from, Plane<Feature> result)
{
    for (std::size_t i = first_pixel(); i < result.area.pixels(); i += pixel_step()) {
        const Pixel p = pixel_of(result.area, i);
        const Sample g = sampled_gradient(from, p);
        const Sample t = sample(from, p, [&](int row, int col) {
            return int{from.tone(from.pixels.at(row, col))};
        });
        result.data[i] = make_uint2(t.value | t.least << 8 | g.value << 16 | g.least << 24,
                                    t.most | g.most << 16 | validity(from.at(p.row, p.col)));
    }
}

} // namespace features

cudaError_t compute_long_features(Plane<const std::uint16_t> pixels, Area image, Cost cost,
                                  Tone tone, Plane<LongFeature> result, cudaStream_t stream)
{
    if (result.area.pixels() == 0) {
        return cudaSuccess; // no disparity of the range meets the right image here
    }
    return launch(features::pairs, features::blocks_for(result.area), features::kThreads, 0,
                  stream, features::Replicated{pixels, image, tone}, cost == Cost::pairs_bt,
                  result);
}

cudaError_t compute_samples(Plane<const std::uint16_t> pixels, Area image, Tone tone,
                            Plane<Feature> result, cudaStream_t stream)
{
    return launch(features::samples, features::blocks_for(result.area), features::kThreads, 0,
                  stream, features::Replicated{pixels, image, tone}, result);
}

} // namespace hsgm::matcher::cuda
