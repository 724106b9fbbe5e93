#pragma once

#include "pipeline/synth/row_view.h"

#include "tiling/rect.h"

#include <span>
#include <vector>

namespace hsgm::synth {

/// Paints rows of a block of one view: brightness with edges mixed from 4 x 4 samples a
/// pixel. See Renderer for the rule. One painter serves one thread; its buffers are reused
/// from row to row.
class BlockPainter {
public:
    static constexpr int kSamples = 4; ///< per pixel and axis

    /// `pieces` holds all that may show in the block, and outlives the painter.
    BlockPainter(const Landscape& landscape, std::span<const Piece> pieces, View view,
                 const tiling::Rect& block);

    /// Brightness of the block's pixels on a row, valid until the next call.
    std::span<const double> paint_row(int row);

private:
    void sample_row(int row);
    void draw_span(const RowView::PieceSpan& span, int sub_row);
    double mixed_brightness(int row, int c) const;
    double piece_brightness(const Piece& piece, double column, double y) const;
    double ground_brightness(double column, double y) const;
    double ground_brightness(double column, double y, double disparity_px) const;
    bool is_uniform(int c) const;

    // Samples of pixel c: index c * 16 + sub_row * 4 + sub_col, so that a pixel's are
    // neighbours in memory.
    static constexpr int kPerPixel = kSamples * kSamples;

    const Landscape& landscape_;
    std::span<const Piece> pieces_;
    View view_;
    tiling::Rect block_;
    std::vector<double> ground_;  ///< disparity at the pixel centres of the row
    std::vector<double> nearest_; ///< disparity of each sample
    std::vector<int> winner_;     ///< piece of each sample
    std::vector<double> brightness_;
};

} // namespace hsgm::synth
