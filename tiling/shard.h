#pragma once

#include "tiling/rect.h"

#include <span>

namespace hsgm::tiling {

/// One of `count` parts of a raster, numbered from 0.
struct Shard {
    int index = 0;
    int count = 1;
    bool operator==(const Shard&) const = default;
};

/// The pixels of a shard: whole rows, cut at multiples of 64 so that few windows of the matcher
/// are shared with a neighbour, and as equal as that allows; no row at all where there are more
/// shards than such pieces. All shards together are the raster, without overlap. They do not
/// depend on the size of tiles. Throws std::invalid_argument unless 0 <= index < count.
Rect band_of(Size raster, Shard shard);

/// The smallest rectangle round those pixels of `wanted` that lie in no rectangle of `taken`;
/// empty where there are none. Those of `taken` may overlap and reach outside.
Rect bounds_of_rest(const Rect& wanted, std::span<const Rect> taken);

} // namespace hsgm::tiling
