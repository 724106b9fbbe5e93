#pragma once

#include "matcher/cuda/resources.h"
#include "matcher/cuda/solve_windows.h"
#include "matcher/matcher.h"

#include <vector>

namespace hsgm::matcher::cuda {

/// The directions of these options, as kernels number them.
Directions directions_of(const Options& options);

/// Lays out what a level leaves for the finer one. With an arena that only counts, the
/// pointers are null.
template <typename Cell>
LevelStore<Cell> lay_out_store(Arena& arena, const Options& options, tiling::Size level,
                               const tiling::Rect& area, int window_px, int count);

/// Device memory of one level of a tile.
template <typename Cell>
struct LevelMemory {
    Plane<std::uint16_t> left_pixels;
    Plane<std::uint16_t> right_pixels;
    Plane<std::uint8_t> tone;
    Plane<std::uint8_t> low_texture;
    Plane<Feature> left; ///< of costs with long features, the next two instead
    Plane<Feature> right;
    Plane<LongFeature> long_left;
    Plane<LongFeature> long_right;
    Area windows_area;
    Window* windows = nullptr;
    int window_count = 0;
    int* counters = nullptr; ///< one for each launch
    LevelStore<Cell> store;  ///< but for level 0
};

/// Device memory of a tile.
template <typename Cell>
struct TileMemory {
    std::vector<LevelMemory<Cell>> levels;
    TileArrays tile;
    unsigned char* scratch = nullptr;
};

/// One launch of a kernel: windows of more than `over_count` disparities, up to `up_to_count`.
template <typename Cell>
struct WindowLaunch {
    WindowKernel<Cell> kernel;
    StripLayout strips;
    int over_count = 0;
    int up_to_count = 0;
    int blocks = 0; ///< at most
};

/// The launches that a level with ranges up to `count` takes: kernels that fit the device's
/// shared memory, and at last the one for any range.
template <typename Cell>
std::vector<WindowLaunch<Cell>> window_launches(const Options& options,
                                                const DeviceInfo& device, int count);

/// Lays out a tile.
template <typename Cell>
TileMemory<Cell> lay_out_tile(Arena& arena, const Matcher& matcher, const DeviceInfo& device,
                              const tiling::Rect& core);

/// Bytes of what a tile's images take on their way up, and of its results on their way down.
std::int64_t upload_bytes(const Matcher& matcher, const tiling::Rect& core);
std::int64_t download_bytes(const Matcher& matcher, const tiling::Rect& core);

/// The columns of the right image that a tile has keys for.
tiling::Rect keys_rect(const Matcher& matcher, const tiling::Rect& core);

} // namespace hsgm::matcher::cuda
