#include "pipeline/synth/block_painter.h"

#include <algorithm>
#include <cmath>

namespace hsgm::synth {

namespace {

// Where sub-sample k of a pixel lies: -0.375, -0.125, 0.125, 0.375 from its centre.
double sample_offset(int k)
{
    return (k + 0.5) / BlockPainter::kSamples - 0.5;
}

// The first sample of the global sample grid at or right of `column`.
double first_sample_from(double column)
{
    return std::ceil((column + 0.5) * BlockPainter::kSamples - 0.5);
}

} // namespace

BlockPainter::BlockPainter(const Landscape& landscape, std::span<const Piece> pieces, View view,
                           const tiling::Rect& block)
    : landscape_(landscape), pieces_(pieces), view_(view), block_(block), ground_(block.cols),
      nearest_(static_cast<std::size_t>(block.cols) * kPerPixel),
      winner_(static_cast<std::size_t>(block.cols) * kPerPixel), brightness_(block.cols)
{
}

std::span<const double> BlockPainter::paint_row(int row)
{
    sample_row(row);
    for (int c = 0; c < block_.cols; ++c) {
        const int winner = winner_[c * kPerPixel];
        const int col = block_.col + c;
        if (!is_uniform(c)) {
            brightness_[c] = mixed_brightness(row, c);
        } else if (winner == RowView::kGround) {
            brightness_[c] = ground_brightness(col, row, ground_[c]);
        } else {
            brightness_[c] = piece_brightness(pieces_[winner], col, row);
        }
    }
    return brightness_;
}

// Fills the sample buffers: the ground, then every span over it, nearest wins. The ground
// counts with its disparity at the pixel centre, for it changes little within a pixel.
void BlockPainter::sample_row(int row)
{
    const RowView centre(landscape_, pieces_, view_, row);
    for (int c = 0; c < block_.cols; ++c) {
        ground_[c] = centre.ground_disparity(block_.col + c);
        std::fill_n(nearest_.begin() + c * kPerPixel, kPerPixel, ground_[c]);
    }
    std::fill(winner_.begin(), winner_.end(), RowView::kGround);
    for (int sub_row = 0; sub_row < kSamples; ++sub_row) {
        const RowView samples(landscape_, pieces_, view_, row + sample_offset(sub_row));
        for (const RowView::PieceSpan& span : samples.spans()) {
            draw_span(span, sub_row);
        }
    }
}

void BlockPainter::draw_span(const RowView::PieceSpan& p, int sub_row)
{
    // Sample indices count from the block's first pixel; clamped before they become int.
    const double origin = static_cast<double>(block_.col) * kSamples;
    const double count = static_cast<double>(block_.cols) * kSamples;
    const auto index_of = [&](double column) {
        return static_cast<int>(std::clamp(first_sample_from(column) - origin, 0.0, count));
    };
    const int end = index_of(p.span.end);
    for (int i = index_of(p.span.begin); i < end; ++i) {
        const int c = i / kSamples;
        const int sub_col = i % kSamples;
        const double disparity_px = p.span.disparity(block_.col + c + sample_offset(sub_col));
        const int sample = c * kPerPixel + sub_row * kSamples + sub_col;
        if (disparity_px > nearest_[sample]) {
            nearest_[sample] = disparity_px;
            winner_[sample] = p.piece;
        }
    }
}

bool BlockPainter::is_uniform(int c) const
{
    const int* first = winner_.data() + c * kPerPixel;
    int differs = 0;
    for (int i = 1; i < kPerPixel; ++i) {
        differs |= first[i] ^ first[0];
    }
    return differs == 0;
}

// The surfaces of a pixel by their shares, each at the middle of its own samples.
double BlockPainter::mixed_brightness(int row, int c) const
{
    const int* winners = winner_.data() + c * kPerPixel;
    double sum = 0;
    for (int first = 0; first < kPerPixel; ++first) {
        if (std::find(winners, winners + first, winners[first]) != winners + first) {
            continue; // counted already
        }
        int samples = 0;
        double across = 0;
        double down = 0;
        for (int i = first; i < kPerPixel; ++i) {
            if (winners[i] == winners[first]) {
                ++samples;
                across += sample_offset(i % kSamples);
                down += sample_offset(i / kSamples);
            }
        }
        const double column = block_.col + c + across / samples;
        const double y = row + down / samples;
        sum += samples * (winners[first] == RowView::kGround
                              ? ground_brightness(column, y)
                              : piece_brightness(pieces_[winners[first]], column, y));
    }
    return sum / kPerPixel;
}

// Textures are painted in the left image: a right column is carried over by the disparity
// of the surface that it shows.
double BlockPainter::ground_brightness(double column, double y, double disparity_px) const
{
    const double x = view_ == View::left ? column : column + disparity_px;
    return landscape_.ground_brightness(x, y);
}

double BlockPainter::ground_brightness(double column, double y) const
{
    const bool left = view_ == View::left;
    return ground_brightness(column, y,
                             left ? 0 : landscape_.ground().disparity_from_right(column, y));
}

double BlockPainter::piece_brightness(const Piece& p, double column, double y) const
{
    // d = a + b x and x = x_right + d, so x = (x_right + a) / (1 - b).
    const double x =
        view_ == View::left ? column : (column + p.disparity(0, y)) / (1 - p.slope_x);
    return landscape_.piece_brightness(p, x, y);
}

} // namespace hsgm::synth
