#pragma once

#include "pipeline/synth/landscape.h"

#include <span>
#include <vector>

namespace hsgm::synth {

/// What one view shows along one continuous row: spans of pieces before the ground. The
/// same few lines serve both views, since a plane is a line in either.
class RowView {
public:
    /// The index that stands for the ground.
    static constexpr int kGround = -1;

    /// `pieces` must hold every piece that can show in the columns to be asked for, and
    /// outlive the row.
    RowView(const Landscape& landscape, std::span<const Piece> pieces, View view, double y);

    struct Seen {
        double disparity_px;
        int piece; ///< index into the pieces, or kGround
    };
    /// The nearest surface at a continuous column of the view.
    Seen nearest(double column) const;

    /// Whether some piece at this column is nearer than `disparity_px`. For a point that the
    /// other view sees, the ground need not be asked: it never folds, so it hides itself
    /// only where the other view would see it instead.
    bool hides(double column, double disparity_px) const;

    double ground_disparity(double column) const;

    struct PieceSpan {
        Span span;
        int piece;
    };
    std::span<const PieceSpan> spans() const { return spans_; }

private:
    const Landscape* landscape_;
    View view_;
    double y_;
    std::vector<PieceSpan> spans_;
};

/// The part of the left image whose points may show in columns first..last of a view, given
/// the scene's disparities (x_left = x_right + d).
Area area_seen(const DisparityBounds& bounds, View view, double first, double last,
               double y_begin, double y_end);

} // namespace hsgm::synth
