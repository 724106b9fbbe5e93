#pragma once

#include "matcher/cuda/views.h"

#include <cuda_runtime.h>

namespace hsgm::matcher::cuda {

/// What a matching cost compares of a pixel. The highest bit of `y` says that the pixel is
/// valid; 63 bits are left for the cost.
using Feature = uint2;
/// The same of costs that compare more: 64 bits in `x` and `y`, samples in `z`; the highest bit
/// of `w` says that the pixel is valid.
using LongFeature = uint4;
constexpr unsigned kValidFeature = 0x80000000U;

enum class CostKind {
    census,      ///< bits that differ
    census_tone, ///< bits of `x` that differ, and the difference of tones in `y`
    table,       ///< of tones, in `x`
    pairs,       ///< bits of long features that differ, and sampled gradients in `z`
    block,       ///< of sampled tones and gradients, over the pixels round the left one
};

/// How the features of two valid pixels become a cost.
struct CostRule {
    CostKind kind = CostKind::census;
    int scale = 1;                       ///< of a differing bit; for pairs in quarters
    int most = 0;                        ///< C_max
    const std::uint8_t* table = nullptr; ///< by left and right tone
};

/// First-pass results of a tile; see matcher::TileMatch.
struct TileArrays {
    Area core;
    std::int32_t* disparity_q8 = nullptr;
    std::uint8_t* confidence = nullptr;
    std::uint16_t* reasons = nullptr;
    Area keys_area; ///< columns of the right image
    std::uint32_t* keys = nullptr;
    int asked_least = 0;
    int asked_most = 0;
};

/// Where a block keeps what, in bytes from the start of its shared memory; for the widest
/// ranges, keys, costs and sums lie in the block's part of the scratch memory instead.
struct StripLayout {
    int rows = 0;       ///< of a strip
    int words = 0;      ///< pairs of disparities of a pixel: half the padded range
    int cost_pixel = 0; ///< words from pixel to pixel
    int cost_row = 0;   ///< words from row to row; skewed, so that banks do not clash
    int sum_row = 0;
    int key_row = 0;
    int line_slots = 0; ///< columns of a path region at most
    std::size_t control = 0;
    std::size_t penalties = 0;
    std::size_t keys = 0;
    std::size_t costs = 0;
    std::size_t sums = 0;
    std::size_t parked = 0; ///< of paths that go down, between strips
    std::size_t bytes = 0;
    std::size_t checkpoints = 0; ///< in scratch, of paths that go up, for each strip
    std::size_t checkpoint_bytes = 0;
    std::size_t scratch_bytes = 0; ///< of a block
    std::size_t wide = 0;          ///< in scratch, for ranges wider than registers
    bool parked_in_shared = true;
    std::size_t shared_ends[6] = {}; ///< of the arrays in shared memory, with their guards
};

/// All windows of a level with ranges of one class of widths.
template <typename Cell>
struct SolveJob {
    Area image; ///< the whole level
    int right_cols = 0;
    Plane<const std::uint16_t> left_pixels;
    Plane<const std::uint16_t> right_pixels;
    Plane<const std::uint8_t> tone;
    Plane<const std::uint8_t> low_texture;
    Plane<const Feature> left; ///< of costs with long features, the next two instead
    Plane<const Feature> right;
    Plane<const LongFeature> long_left;
    Plane<const LongFeature> long_right;
    CostRule cost;
    Directions directions;
    int halo_px = 0;
    int p1 = 0;
    unsigned one = 1;                  ///< see PathState::step
    const std::uint16_t* p2 = nullptr; ///< P2' by the difference of tones
    int unsearched = 0;                ///< value of a coarse disparity outside its range

    const Window* windows = nullptr;
    int window_count = 0;
    int* next_window = nullptr; ///< starts at 0
    int over_count = 0; ///< this launch takes ranges of over_count < count <= up_to_count
    int up_to_count = 0;

    bool has_coarser = false;
    bool add_prior = false;
    bool equation_3 = false;
    LevelStore<Cell> coarser;
    Plane<const std::uint8_t> coarser_tone; ///< for eq. 3

    bool finest = false;
    LevelStore<Cell> store; ///< written unless finest
    TileArrays tile;        ///< written if finest

    StripLayout strips;
    unsigned char* scratch = nullptr;
};

} // namespace hsgm::matcher::cuda
