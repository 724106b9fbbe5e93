#include "tests/seam/stereo.h"

#include "matcher/kernel.h"
#include "matcher/pixel.h"
#include "matcher/reduce.h"
#include "pipeline/synth/renderer.h"
#include "tiling/pyramid.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace hsgm::seam {

namespace {

using matcher::LevelImages;
using tiling::Image;
using tiling::Patch;
using tiling::Rect;

template <typename T>
Patch<T> cut(const Image<T>& image, const Rect& part)
{
    Patch<T> patch(part);
    for (int r = 0; r < part.rows; ++r) {
        std::copy_n(image.row(part.row + r) + part.col, part.cols, patch.pixels.row(r));
    }
    return patch;
}

template <typename T>
void paste(const Image<T>& part, const Rect& where, Image<T>& image)
{
    for (int r = 0; r < where.rows; ++r) {
        std::copy_n(part.row(r), where.cols, image.row(where.row + r) + where.col);
    }
}

std::vector<Image<std::uint16_t>> pyramid(const Image<std::uint16_t>& full, int levels)
{
    std::vector<Image<std::uint16_t>> result{full};
    while (static_cast<int>(result.size()) < levels) {
        const auto& fine = result.back();
        Image<std::uint16_t> coarse(halve(fine.size()));
        matcher::reduce(cut(fine, rect_of(fine.size())), fine.size(), rect_of(coarse.size()),
                        coarse);
        result.push_back(std::move(coarse));
    }
    return result;
}

template <typename T>
std::string difference_of(const char* what, const Image<T>& a, const Image<T>& b)
{
    if (a == b) {
        return "";
    }
    if (a.size() != b.size()) {
        return std::string(what) + " differs in size; ";
    }
    const auto first = a.pixels();
    const auto second = b.pixels();
    std::size_t at = 0;
    std::size_t count = 0;
    for (std::size_t i = first.size(); i-- > 0;) {
        if (first[i] != second[i]) {
            at = i;
            ++count;
        }
    }
    const auto cols = static_cast<std::size_t>(a.cols());
    return std::string(what) + " differs in " + std::to_string(count) + " px, first at (" +
           std::to_string(at / cols) + ", " + std::to_string(at % cols) +
           "): " + std::to_string(first[at]) + " and " + std::to_string(second[at]) + "; ";
}

} // namespace

synth::Scene city(tiling::Size size, std::uint64_t seed)
{
    synth::Scene scene;
    scene.size = size;
    scene.seed = seed;
    scene.terrain.offset_px = -4;
    scene.terrain.waves = {{5, 420, 30, 0}, {2, 170, 110, 50}};
    scene.city = synth::City{};
    // Another lot size for each seed: were streets to lie where windows meet, their errors
    // would pass for seams.
    scene.city->cell_px = 67 + 2.3 * static_cast<double>(seed % 16);
    scene.city->height_max_px = 24;
    scene.low_texture = {
        {0.3 * size.cols, 10.0 + 13 * static_cast<double>(seed % 9), 90, 70, 0.02}};
    scene.left.noise_gray = 1.5;
    scene.right = {0.92, 0.04, 1.1, 1.5, 0, {}};
    scene.left.holes = {{0.7 * size.cols, 0.6 * size.rows, 9}};
    scene.right.holes = {{0.4 * size.cols, 0.5 * size.rows, 13}};
    return scene;
}

StereoPair render(const synth::Scene& scene, int margin_px)
{
    const synth::Renderer renderer(scene);
    const Rect whole = rect_of(scene.size);
    StereoPair pair{Image<std::uint16_t>(scene.size),
                    Image<std::uint16_t>(scene.size),
                    {},
                    Image<float>(scene.size),
                    Image<std::uint8_t>(scene.size)};
    renderer.render_left(whole, pair.left);
    renderer.render_right(whole, pair.right);
    renderer.truth_left(whole, pair.truth_px);
    renderer.visible_left(whole, pair.visible);
    for (auto* image : {&pair.left, &pair.right}) {
        std::replace(image->data(), image->data() + scene.size.area(), std::uint16_t{0},
                     matcher::kNodataPixel);
    }
    const auto bounds = renderer.disparity_bounds();
    pair.asked = {static_cast<int>(std::floor(bounds.min_px)) - margin_px,
                  static_cast<int>(std::ceil(bounds.max_px)) + margin_px};
    return pair;
}

StereoPair noise(tiling::Size left, int right_cols, tiling::DisparityRange asked,
                 std::uint64_t seed)
{
    std::mt19937_64 random(seed);
    StereoPair pair;
    pair.asked = asked;
    pair.left = Image<std::uint16_t>(left);
    pair.right = Image<std::uint16_t>({left.rows, right_cols});
    for (auto* image : {&pair.left, &pair.right}) {
        std::generate_n(image->data(), image->size().area(),
                        [&random] { return static_cast<std::uint16_t>(100 + random() % 64); });
    }
    return pair;
}

std::string difference(const Whole& a, const Whole& b)
{
    return difference_of("disparity", a.disparity_q8, b.disparity_q8) +
           difference_of("confidence", a.confidence, b.confidence) +
           difference_of("reasons", a.reasons, b.reasons) +
           difference_of("right keys", a.right_keys, b.right_keys);
}

std::string difference(const matcher::TileMatch& a, const matcher::TileMatch& b)
{
    return difference_of("disparity", a.disparity_q8, b.disparity_q8) +
           difference_of("confidence", a.confidence, b.confidence) +
           difference_of("reasons", a.reasons, b.reasons) +
           difference_of("right keys", a.right_keys.pixels, b.right_keys.pixels);
}

std::string difference(const matcher::Refined& a, const matcher::Refined& b)
{
    return difference_of("refined disparity", a.disparity_px, b.disparity_px) +
           difference_of("refined confidence", a.confidence, b.confidence) +
           difference_of("refined reasons", a.reasons, b.reasons);
}

Match::Match(const StereoPair& pair, const matcher::Options& options)
{
    matcher::PairTraits traits;
    traits.shape = pair.shape();
    const int hmi_level = matcher::hmi_level(traits.shape);
    const int levels =
        std::max(matcher::plan_levels(traits.shape, options).levels(), hmi_level + 1);
    left_ = pyramid(pair.left, levels);
    right_ = pyramid(pair.right, levels);
    if (options.cost == matcher::Cost::hmi) {
        const auto k = static_cast<std::size_t>(hmi_level);
        traits.hmi = matcher::solve_hmi_table(traits, options, left_[k], right_[k]);
    }
    matcher_ = std::make_unique<matcher::Matcher>(traits, options);
    const auto top = static_cast<std::size_t>(matcher_->plan().levels() - 1);
    coarse_ = matcher_->plan().coarsest_whole ? matcher_->solve_coarse(left_[top], right_[top])
                                              : matcher_->solve_coarse({}, {});
}

std::vector<LevelImages> Match::images(const Rect& core, int margin_px) const
{
    const auto support = matcher_->support(core);
    std::vector<LevelImages> result;
    for (int level = 0; level < matcher_->plan().windowed_levels(); ++level) {
        const auto k = static_cast<std::size_t>(level);
        result.push_back({cut(left_[k], intersect(expand(support[k].left_image, margin_px),
                                                  rect_of(left_[k].size()))),
                          cut(right_[k], intersect(expand(support[k].right_image, margin_px),
                                                   rect_of(right_[k].size())))});
    }
    return result;
}

matcher::TileMatch Match::match(const Rect& core, const std::vector<LevelImages>& images) const
{
    return matcher_->match_tile(core, images, *coarse_);
}

Whole Match::match_all(int tile_size_px, tiling::TileOrder order) const
{
    const auto& shape = matcher_->pair().shape;
    Whole whole{Image<std::int32_t>(shape.left), Image<std::uint8_t>(shape.left),
                Image<std::uint16_t>(shape.left),
                Image<std::uint32_t>(shape.right, matcher::kNoKey)};
    const tiling::TilePlan plan(shape.left, tile_size_px);
    for (const int tile : tiling::tile_sequence(plan, order, 1)) {
        const Rect core = plan.core(tile);
        const auto match = this->match(core);
        paste(match.disparity_q8, core, whole.disparity_q8);
        paste(match.confidence, core, whole.confidence);
        paste(match.reasons, core, whole.reasons);
        const Rect seen = match.right_keys.rect;
        for (int row = seen.row; row < seen.row_end(); ++row) {
            for (int col = seen.col; col < seen.col_end(); ++col) {
                auto& key = whole.right_keys(row, col);
                key = std::min(key, match.right_keys.at(row, col));
            }
        }
    }
    return whole;
}

matcher::Refined Match::refine_all(const Whole& first_pass, int piece_size_px) const
{
    const auto& shape = matcher_->pair().shape;
    const auto& options = matcher_->options();
    matcher::Refined whole{Image<float>(shape.left), Image<std::uint8_t>(shape.left),
                           Image<std::uint16_t>(shape.left)};
    const tiling::TilePlan plan(shape.left, piece_size_px);
    for (int piece = 0; piece < plan.count(); ++piece) {
        const Rect core = plan.core(piece);
        const auto support = matcher::refine_support(core, shape, options);
        const matcher::RefineInput input{cut(first_pass.disparity_q8, support.first_pass),
                                         cut(first_pass.confidence, support.first_pass),
                                         cut(first_pass.reasons, support.first_pass),
                                         cut(first_pass.right_keys, support.right_keys),
                                         cut(left_[0], support.left_image),
                                         cut(right_[0], support.right_image)};
        const auto refined = matcher::refine(core, input, shape, options);
        paste(refined.disparity_px, core, whole.disparity_px);
        paste(refined.confidence, core, whole.confidence);
        paste(refined.reasons, core, whole.reasons);
    }
    return whole;
}

} // namespace hsgm::seam
