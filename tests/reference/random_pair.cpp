#include "tests/reference/random_pair.h"

#include <algorithm>

namespace hsgm::reference {

std::uint64_t Random::next()
{
    state_ += 0x9E3779B97F4A7C15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

int Random::between(int least, int most)
{
    const auto count = static_cast<std::uint64_t>(most - least + 1);
    return least + static_cast<int>(next() % count);
}

namespace {

Rect random_rect(Random& random, Size size)
{
    const int rows = random.between(1, std::max(1, size.rows / 2));
    const int cols = random.between(1, std::max(1, size.cols / 2));
    return {random.between(0, size.rows - rows), random.between(0, size.cols - cols), rows,
            cols};
}

template <typename T>
void fill(Image<T>& image, const Rect& rect, T value)
{
    for (int row = rect.row; row < rect.row_end(); ++row) {
        std::fill_n(image.row(row) + rect.col, rect.cols, value);
    }
}

/// Coarse blotches with fine noise on top: texture at every level of the pyramid.
Image<std::uint16_t> texture(Random& random, Size size, int most)
{
    Image<std::uint16_t> image(size);
    const int blotch = random.between(2, 9);
    Image<int> blotches({size.rows / blotch + 1, size.cols / blotch + 1});
    for (int row = 0; row < blotches.rows(); ++row) {
        for (int col = 0; col < blotches.cols(); ++col) {
            blotches(row, col) = random.between(0, most / 2);
        }
    }
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            image(row, col) = static_cast<std::uint16_t>(blotches(row / blotch, col / blotch) +
                                                         random.between(0, most / 2));
        }
    }
    return image;
}

/// Disparities around one value of the range: patches a few pixels apart, and a slope.
Image<int> scene(Random& random, Size size, DisparityRange asked)
{
    const int base = random.between(asked.min, asked.max);
    const int slope = random.between(2, 40) * (random.chance(50) ? 1 : -1);
    Image<int> disparities(size);
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            disparities(row, col) = base + row / slope;
        }
    }
    for (int patches = random.between(0, 3); patches > 0; --patches) {
        fill(disparities, random_rect(random, size), base + random.between(-12, 12));
    }
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            disparities(row, col) = std::clamp(disparities(row, col), asked.min, asked.max);
        }
    }
    return disparities;
}

void spoil(Random& random, Image<std::uint16_t>& image, const PairLook& look)
{
    for (int i = 0; i < look.holes; ++i) {
        if (random.chance(60)) {
            fill(image, random_rect(random, image.size()), kNodata);
        }
    }
    for (int row = 0; look.lost_percent > 0 && row < image.rows(); ++row) {
        for (int col = 0; col < image.cols(); ++col) {
            if (random.chance(look.lost_percent)) {
                image(row, col) = kNodata;
            }
        }
    }
}

void posterise(Image<std::uint16_t>& image, int most, int grey_levels)
{
    const int step = std::max(1, (most + 1) / grey_levels);
    for (int row = 0; row < image.rows(); ++row) {
        for (int col = 0; col < image.cols(); ++col) {
            image(row, col) = static_cast<std::uint16_t>(image(row, col) / step * step);
        }
    }
}

} // namespace

RandomPair random_pair(Random& random, Size left, int right_cols, DisparityRange asked,
                       const PairLook& look)
{
    const int most = look.sixteen_bit ? 65534 : 255;
    RandomPair pair;
    pair.left = texture(random, left, most);
    for (int i = 0; i < look.flat_patches; ++i) {
        const auto value = static_cast<std::uint16_t>(random.between(0, most));
        fill(pair.left, random_rect(random, left), value);
    }
    pair.right = texture(random, {left.rows, right_cols}, most);
    if (!look.noise) {
        const Image<int> disparities = scene(random, left, asked);
        for (int row = 0; row < left.rows; ++row) {
            for (int x = 0; x < left.cols; ++x) {
                const int xr = x - disparities(row, x);
                if (xr >= 0 && xr < right_cols) {
                    pair.right(row, xr) = pair.left(row, x);
                }
            }
        }
    }
    if (look.grey_levels > 0) {
        posterise(pair.left, most, look.grey_levels);
        posterise(pair.right, most, look.grey_levels);
    }
    spoil(random, pair.left, look);
    spoil(random, pair.right, look);
    return pair;
}

} // namespace hsgm::reference
