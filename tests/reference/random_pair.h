#pragma once

#include "tests/reference/pyramid.h"

#include <cstdint>

namespace hsgm::reference {

/// A small generator whose numbers are the same everywhere (splitmix64).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t next();
    /// least..most, both inclusive.
    int between(int least, int most);
    bool chance(int percent) { return between(1, 100) <= percent; }
    /// One of the values.
    template <typename T>
    T one_of(std::initializer_list<T> values)
    {
        return values.begin()[between(0, static_cast<int>(values.size()) - 1)];
    }

private:
    std::uint64_t state_;
};

/// What a made pair looks like.
struct PairLook {
    bool noise = false;       ///< two unrelated images of noise
    bool sixteen_bit = false; ///< values up to 65534, else up to 255
    int grey_levels = 0;      ///< few values make many ties; 0 = all
    int flat_patches = 0;     ///< rectangles of one value, in both images
    int holes = 0;            ///< rectangles of nodata in either image
    int lost_percent = 0;     ///< single pixels of nodata in either image
};

struct RandomPair {
    Image<std::uint16_t> left;
    Image<std::uint16_t> right;
};

/// A textured pair. The right image shows the left one shifted by a disparity of the asked
/// range that differs by patches and slopes, so that coarse winners agree over whole windows
/// and ranges get pruned.
RandomPair random_pair(Random& random, Size left, int right_cols, DisparityRange asked,
                       const PairLook& look);

} // namespace hsgm::reference
