#pragma once

#include "tiling/image.h"

#include <cstdint>
#include <initializer_list>

namespace hsgm::reference {

/// An image written out row by row.
template <typename T>
tiling::Image<T> image_of(std::initializer_list<std::initializer_list<T>> rows)
{
    const int cols = static_cast<int>(rows.begin()->size());
    tiling::Image<T> image({static_cast<int>(rows.size()), cols});
    int r = 0;
    for (const auto& row : rows) {
        int c = 0;
        for (const T value : row) {
            image(r, c++) = value;
        }
        ++r;
    }
    return image;
}

inline tiling::Image<std::uint16_t>
pixels(std::initializer_list<std::initializer_list<std::uint16_t>> rows)
{
    return image_of<std::uint16_t>(rows);
}

} // namespace hsgm::reference
