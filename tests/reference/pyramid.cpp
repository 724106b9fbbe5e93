#include "tests/reference/pyramid.h"

#include "tiling/rect.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace hsgm::reference {

ToneEnds tone_ends(const Image<std::uint16_t>& image)
{
    std::vector<std::int64_t> histogram(65536, 0);
    std::int64_t n = 0;
    for (const std::uint16_t v : image.pixels()) {
        if (v != kNodata) {
            ++histogram[v];
            ++n;
        }
    }
    if (n == 0) {
        return {};
    }
    int lo = -1;
    int hi = -1;
    std::int64_t up_to = 0; // count(<= v)
    for (int v = 0; v < 65535; ++v) {
        up_to += histogram[static_cast<std::size_t>(v)];
        if (lo < 0 && 1000 * up_to > n) {
            lo = v;
        }
        if (hi < 0 && 1000 * up_to >= 999 * n) {
            hi = v;
        }
    }
    return {lo, hi > lo ? hi : lo + 1};
}

namespace {

/// 36 times the mean of |L| inside the block at (top, left); none where it does not count.
std::optional<std::int64_t> roughness(const Image<std::uint16_t>& image, int top, int left)
{
    std::int64_t sum = 0;
    for (int r = top; r < top + 8; ++r) {
        for (int c = left; c < left + 8; ++c) {
            if (image(r, c) == kNodata) {
                return std::nullopt;
            }
            if (r == top || r == top + 7 || c == left || c == left + 7) {
                continue;
            }
            constexpr int kWeight[3] = {1, -2, 1};
            std::int64_t l = 0;
            for (int i = 0; i < 3; ++i) {
                for (int k = 0; k < 3; ++k) {
                    l += kWeight[i] * kWeight[k] * image(r + i - 1, c + k - 1);
                }
            }
            sum += l < 0 ? -l : l;
        }
    }
    return sum > 0 ? std::optional(sum) : std::nullopt;
}

} // namespace

int noise_of(const Image<std::uint16_t>& image)
{
    std::vector<int> noises;
    for (int row = 0; row + 8 <= image.rows(); row += 8) {
        for (int col = 0; col + 8 <= image.cols(); col += 8) {
            if (const auto sum = roughness(image, row, col)) {
                noises.push_back(static_cast<int>(
                    std::min<std::int64_t>((*sum * 380 + 32768) / 65536, 4095)));
            }
        }
    }
    if (noises.empty()) {
        return 0;
    }
    std::sort(noises.begin(), noises.end());
    return noises[(noises.size() + 9) / 10 - 1];
}

Image<std::uint8_t> toned(const Image<std::uint16_t>& image, ToneEnds ends)
{
    Image<std::uint8_t> result(image.size());
    for (int row = 0; row < image.rows(); ++row) {
        for (int col = 0; col < image.cols(); ++col) {
            const int v = image(row, col);
            if (v == kNodata || v <= ends.lo) {
                result(row, col) = 0;
            } else if (v >= ends.hi) {
                result(row, col) = 255;
            } else {
                result(row, col) =
                    static_cast<std::uint8_t>((v - ends.lo) * 255 / (ends.hi - ends.lo));
            }
        }
    }
    return result;
}

Image<std::uint16_t> reduced(const Image<std::uint16_t>& fine)
{
    constexpr int kWeights[4] = {1, 3, 3, 1};
    Image<std::uint16_t> coarse({(fine.rows() + 1) / 2, (fine.cols() + 1) / 2});
    for (int r = 0; r < coarse.rows(); ++r) {
        for (int c = 0; c < coarse.cols(); ++c) {
            int sum = 0;
            int weight = 0;
            for (int i = 0; i < 4; ++i) {
                for (int j = 0; j < 4; ++j) {
                    const int v = clamped(fine, 2 * r - 1 + i, 2 * c - 1 + j);
                    if (v != kNodata) {
                        sum += kWeights[i] * kWeights[j] * v;
                        weight += kWeights[i] * kWeights[j];
                    }
                }
            }
            coarse(r, c) =
                weight == 0 ? kNodata : static_cast<std::uint16_t>((sum + weight / 2) / weight);
        }
    }
    return coarse;
}

std::vector<Image<std::uint16_t>> pyramid(const Image<std::uint16_t>& image, int levels)
{
    std::vector<Image<std::uint16_t>> result{image};
    while (static_cast<int>(result.size()) < levels) {
        result.push_back(reduced(result.back()));
    }
    return result;
}

DisparityRange level_range(DisparityRange asked, int k, int levels)
{
    if (k == 0) {
        return asked;
    }
    const int m = 1 << (levels - 1);
    const int lowest = tiling::floor_div(asked.min, m) * m;
    const int highest = tiling::floor_div(asked.max, m) * m + m - 1;
    return {lowest / (1 << k), tiling::floor_div(highest, 1 << k)};
}

namespace {

int side_of_level(int side, int k)
{
    for (; k > 0; --k) {
        side = (side + 1) / 2;
    }
    return side;
}

} // namespace

int level_count(Size left, Size right, DisparityRange asked, const Options& options)
{
    if (options.mode == Mode::sgm || options.mode == Mode::local) {
        return 1;
    }
    if (options.levels > 0) {
        return options.levels;
    }
    const auto cells_of_coarsest = [&](int levels) {
        const int k = levels - 1;
        return std::int64_t{side_of_level(left.rows, k)} * side_of_level(left.cols, k) *
               level_range(asked, k, levels).count();
    };
    const auto least_side_of_coarsest = [&](int levels) {
        return side_of_level(std::min({left.rows, left.cols, right.cols}), levels - 1);
    };
    constexpr std::int64_t kMostCells = std::int64_t{1} << 25;
    int levels = 3;
    while (options.mode == Mode::hsgm && cells_of_coarsest(levels) > kMostCells &&
           least_side_of_coarsest(levels + 1) >= 32) {
        ++levels;
    }
    while (levels > 1 && least_side_of_coarsest(levels) < 32) {
        --levels;
    }
    return levels;
}

} // namespace hsgm::reference
