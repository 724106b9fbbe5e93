#include "tests/catch.h"

#include "tests/seam/stereo.h"

#include "matcher/pixel.h"

#include <random>
#include <string>

using namespace hsgm;
using namespace hsgm::matcher;
using hsgm::seam::difference;
using hsgm::seam::Match;
using hsgm::seam::StereoPair;
using tiling::Patch;
using tiling::Rect;

// What a tile declares as its support is what it depends on: no less (garbage outside is
// never noticed) and no more (garbage on its rim is). The coarsest level needs no such test:
// it is solved whole, from complete images.
namespace {

class Poison {
public:
    explicit Poison(std::uint64_t seed) : random_(seed) {}

    /// Any value there is, and nodata.
    std::uint16_t pixel()
    {
        const auto value = static_cast<std::uint16_t>(random_());
        return random_() % 8 == 0 ? kNodataPixel : value;
    }
    void fill_outside(const Rect& declared, Patch<std::uint16_t>& patch)
    {
        const Rect all = patch.rect;
        for (int row = all.row; row < all.row_end(); ++row) {
            for (int col = all.col; col < all.col_end(); ++col) {
                if (!declared.contains(row, col)) {
                    patch.at(row, col) = pixel();
                }
            }
        }
    }
    void fill(const Rect& part, Patch<std::uint16_t>& patch)
    {
        for (int row = part.row; row < part.row_end(); ++row) {
            for (int col = part.col; col < part.col_end(); ++col) {
                patch.at(row, col) = pixel();
            }
        }
    }

private:
    std::mt19937_64 random_;
};

enum class Side { top, bottom, left, right };

std::string text(Side side)
{
    constexpr const char* kNames[] = {"top", "bottom", "left", "right"};
    return kNames[static_cast<int>(side)];
}

Rect rim(const Rect& r, Side side)
{
    switch (side) {
    case Side::top:
        return {r.row, r.col, 1, r.cols};
    case Side::bottom:
        return {r.row_end() - 1, r.col, 1, r.cols};
    case Side::left:
        return {r.row, r.col, r.rows, 1};
    default:
        return {r.row, r.col_end() - 1, r.rows, 1};
    }
}

Options census(Mode mode, int paths, bool prune)
{
    Options options;
    options.mode = mode;
    options.paths = paths;
    options.prune = prune;
    return options;
}

// Unaligned cores of all sizes.
Rect random_core(std::mt19937& random, tiling::Size image)
{
    const auto below = [&random](int n) { return static_cast<int>(random() % unsigned(n)); };
    const int row = below(image.rows);
    const int col = below(image.cols);
    return intersect({row, col, 1 + below(120), 1 + below(120)}, rect_of(image));
}

void check_garbage_outside(const StereoPair& pair, const Options& options, int tiles)
{
    INFO(name(options.mode) << ", " << name(options.cost) << ", paths " << options.paths
                            << ", prune " << options.prune);
    const Match match(pair, options);
    std::mt19937 random(7);
    Poison poison(11);
    for (int tile = 0; tile < tiles; ++tile) {
        const Rect core = random_core(random, pair.left.size());
        INFO("core at (" << core.row << ", " << core.col << "), " << core.rows << " x "
                         << core.cols);
        const auto support = match.matcher().support(core);
        auto poisoned = match.images(core, 1 + tile % 30);
        for (std::size_t level = 0; level < poisoned.size(); ++level) {
            poison.fill_outside(support[level].left_image, poisoned[level].left);
            poison.fill_outside(support[level].right_image, poisoned[level].right);
        }
        CHECK(difference(match.match(core), match.match(core, poisoned)) == "");
    }
}

// ---- the negative control ----

struct Rim {
    std::size_t level;
    bool right_image;
    Side side;
};

std::string text(const Rim& r)
{
    return "level " + std::to_string(r.level) + ", " + (r.right_image ? "right" : "left") +
           " image, " + text(r.side);
}

// Whether garbage on one rim of one tile's support shows in the tile.
bool is_noticed(const Match& match, const Rect& core, const Rim& where, Poison& poison)
{
    const auto support = match.matcher().support(core)[where.level];
    auto images = match.images(core);
    const auto clean = match.match(core, images);
    if (where.right_image) {
        poison.fill(rim(support.right_image, where.side), images[where.level].right);
    } else {
        poison.fill(rim(support.left_image, where.side), images[where.level].left);
    }
    return difference(clean, match.match(core, images)) != "";
}

// A support that lacked one line of pixels on one side would read garbage there: some tile
// must notice. Tiles that touch their window's border on the side in question see furthest.
void check_rims(const Options& options, bool right_image_columns)
{
    constexpr int kTries = 16;
    const StereoPair pair = seam::noise({520, 560}, 560, {-8, 7}, 23);
    const Match match(pair, options);
    Poison poison(5);
    for (int level = 0; level < match.matcher().plan().windowed_levels(); ++level) {
        for (const bool right_image : {false, true}) {
            for (const Side side : {Side::top, Side::bottom, Side::left, Side::right}) {
                if (right_image && !right_image_columns &&
                    (side == Side::left || side == Side::right)) {
                    continue;
                }
                const Rim where{static_cast<std::size_t>(level), right_image, side};
                int tries = 0;
                bool noticed = false;
                for (; tries < kTries && !noticed; ++tries) {
                    // Whole windows in the middle of the image, at different places of the
                    // coarser grids.
                    const int w = options.window_px;
                    const Rect core{(160 / w + tries % 4) * w, (192 / w + tries / 4) * w, w, w};
                    noticed = is_noticed(match, core, where, poison);
                }
                INFO(name(options.mode) << ", " << text(where) << ": tiles tried " << tries);
                CHECK(noticed);
            }
        }
    }
}

// Long memory along the paths, so that what enters at the halo's rim is felt in the core.
Options attentive(Mode mode, Cost cost, int paths)
{
    Options options = census(mode, paths, false);
    options.cost = cost;
    options.window_px = 32;
    options.p1 = 100;
    options.p2 = 190;
    options.levels = 4;
    return options;
}

} // namespace

TEST_CASE("garbage outside the declared support of a city's tiles changes nothing")
{
    const StereoPair pair = seam::render(seam::city({230, 300}, 5));
    check_garbage_outside(pair, Options{}, 16);
    check_garbage_outside(pair, census(Mode::hsgm, 16, false), 8);
    check_garbage_outside(pair, census(Mode::hsgm_paper, 8, false), 8);
    check_garbage_outside(pair, census(Mode::local, 8, false), 8);
    Options options;
    options.cost = Cost::hmi;
    check_garbage_outside(pair, options, 8);
    options.cost = Cost::census9x7;
    options.levels = 4;
    options.window_px = 32;
    options.halo_px = 0;
    check_garbage_outside(pair, options, 16);
}

TEST_CASE("garbage outside the declared support of noise changes nothing")
{
    const StereoPair pair = seam::noise({300, 320}, 300, {-8, 7}, 3);
    for (const int paths : {4, 16}) {
        check_garbage_outside(pair, attentive(Mode::hsgm, Cost::census7x7, paths), 12);
    }
    check_garbage_outside(pair, attentive(Mode::hsgm_paper, Cost::census5x5, 8), 8);
    for (const Cost cost : {Cost::pairs5x5, Cost::ternary5x5, Cost::census_ad, Cost::pairs_bt,
                            Cost::birchfield_tomasi}) {
        check_garbage_outside(pair, attentive(Mode::hsgm, cost, 8), 4);
    }
}

TEST_CASE("garbage on any rim of the declared support is noticed")
{
    check_rims(attentive(Mode::hsgm, Cost::census7x7, 8), true);
    check_rims(attentive(Mode::hsgm, Cost::census9x7, 16), true);
    check_rims(attentive(Mode::hsgm_paper, Cost::census7x7, 8), true);
    check_rims(attentive(Mode::local, Cost::census7x7, 8), true);
}

TEST_CASE("garbage on the rim of a pruned match's support is noticed")
{
    // The outer columns of the right image are met by the first and last disparity alone, and
    // a pruned window need not search these: the support must hold for the worst case, so
    // there the control can prove nothing.
    Options options = attentive(Mode::hsgm, Cost::census7x7, 8);
    options.prune = true;
    check_rims(options, false);
    options.halo_px = 0;
    check_rims(options, false);
}
