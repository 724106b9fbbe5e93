#include "pipeline/synth/renderer.h"

#include "pipeline/synth/block_painter.h"
#include "pipeline/synth/hash.h"
#include "pipeline/synth/row_view.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hsgm::synth {

namespace {

using tiling::ImageView;
using tiling::Rect;

enum SeedOf : std::uint64_t { kLeftNoise = 11, kRightNoise = 12 };

// Blocks keep the list of pieces that a pixel asks short. They do not show in the result.
constexpr Rect kBlock{0, 0, 64, 512};

void require_inside(const Rect& part, tiling::Size size, tiling::Size out)
{
    if (!tiling::rect_of(size).contains(part)) {
        throw std::invalid_argument("the part to render reaches outside the image");
    }
    if (!part.empty() && out != part.size()) {
        throw std::invalid_argument("the output's size is not that of the part to render");
    }
}

// Calls do_block(block, its view of out) over all blocks of `part`.
template <typename T, typename DoBlock>
void for_each_block(const Rect& part, ImageView<T> out, DoBlock do_block)
{
    for (int row = part.row; row < part.row_end(); row += kBlock.rows) {
        for (int col = part.col; col < part.col_end(); col += kBlock.cols) {
            const Rect block = tiling::intersect({row, col, kBlock.rows, kBlock.cols}, part);
            do_block(block, out.part({block.row - part.row, block.col - part.col, block.rows,
                                      block.cols}));
        }
    }
}

// The pieces that may show in a block of one view, edges of the outer pixels included.
std::vector<Piece> pieces_seen(const Landscape& landscape, View view, const Rect& block)
{
    return landscape.pieces_over(area_seen(landscape.bounds(), view, block.col - 1.0,
                                           block.col_end(), block.row - 1.0, block.row_end()));
}

} // namespace

Renderer::Renderer(const Scene& scene)
    : scene_(scene), landscape_(scene),
      left_(scene.left, scene.size, scene.full_scale(), child_seed(scene.seed, kLeftNoise)),
      right_(scene.right, scene.size, scene.full_scale(), child_seed(scene.seed, kRightNoise))
{
}

void Renderer::render(View view, const Rect& part, ImageView<std::uint16_t> out) const
{
    require_inside(part, scene_.size, out.size());
    for_each_block(part, out, [&](const Rect& block, ImageView<std::uint16_t> pixels) {
        const std::vector<Piece> pieces = pieces_seen(landscape_, view, block);
        BlockPainter painter(landscape_, pieces, view, block);
        for (int r = 0; r < block.rows; ++r) {
            const std::span<const double> row = painter.paint_row(block.row + r);
            for (int c = 0; c < block.cols; ++c) {
                const int col = block.col + c;
                pixels(r, c) = camera(view).has_data(block.row + r, col)
                                   ? camera(view).gray(row[c], block.row + r, col)
                                   : std::uint16_t{0};
            }
        }
    });
}

void Renderer::truth_of_block(View view, const Rect& block, ImageView<float> out) const
{
    const std::vector<Piece> pieces = pieces_seen(landscape_, view, block);
    for (int r = 0; r < block.rows; ++r) {
        const RowView row(landscape_, pieces, view, block.row + r);
        for (int c = 0; c < block.cols; ++c) {
            out(r, c) = static_cast<float>(row.nearest(block.col + c).disparity_px);
        }
    }
}

void Renderer::truth(View view, const Rect& part, ImageView<float> out) const
{
    require_inside(part, scene_.size, out.size());
    for_each_block(part, out, [&](const Rect& block, ImageView<float> pixels) {
        truth_of_block(view, block, pixels);
    });
}

void Renderer::visible_of_block(View view, const Rect& block, ImageView<std::uint8_t> out) const
{
    const View other = view == View::left ? View::right : View::left;
    const double towards = view == View::left ? -1 : 1; // x_right = x_left - d
    const DisparityBounds d = landscape_.bounds();
    const double shift_a = towards * d.min_px;
    const double shift_b = towards * d.max_px;
    const Rect met = tiling::rect_between(
        block.row, block.col + static_cast<int>(std::floor(std::min(shift_a, shift_b))),
        block.row_end(),
        block.col_end() + static_cast<int>(std::ceil(std::max(shift_a, shift_b))));
    const std::vector<Piece> pieces = pieces_seen(landscape_, view, block);
    const std::vector<Piece> others = pieces_seen(landscape_, other, met);
    for (int r = 0; r < block.rows; ++r) {
        const int y = block.row + r;
        const RowView here(landscape_, pieces, view, y);
        const RowView there(landscape_, others, other, y);
        for (int c = 0; c < block.cols; ++c) {
            const double disparity_px = here.nearest(block.col + c).disparity_px;
            const double column = block.col + c + towards * disparity_px;
            const bool visible =
                column >= -0.5 && column < scene_.size.cols - 0.5 &&
                camera(view).has_data(y, block.col + c) &&
                camera(other).has_data(y, static_cast<int>(std::floor(column + 0.5))) &&
                !there.hides(column, disparity_px);
            out(r, c) = visible ? 255 : 0;
        }
    }
}

void Renderer::visible(View view, const Rect& part, ImageView<std::uint8_t> out) const
{
    require_inside(part, scene_.size, out.size());
    for_each_block(part, out, [&](const Rect& block, ImageView<std::uint8_t> pixels) {
        visible_of_block(view, block, pixels);
    });
}

void Renderer::render_left(const Rect& part, ImageView<std::uint16_t> out) const
{
    render(View::left, part, out);
}

void Renderer::render_right(const Rect& part, ImageView<std::uint16_t> out) const
{
    render(View::right, part, out);
}

void Renderer::truth_left(const Rect& part, ImageView<float> out) const
{
    truth(View::left, part, out);
}

void Renderer::truth_right(const Rect& part, ImageView<float> out) const
{
    truth(View::right, part, out);
}

void Renderer::visible_left(const Rect& part, ImageView<std::uint8_t> out) const
{
    visible(View::left, part, out);
}

void Renderer::visible_right(const Rect& part, ImageView<std::uint8_t> out) const
{
    visible(View::right, part, out);
}

} // namespace hsgm::synth
