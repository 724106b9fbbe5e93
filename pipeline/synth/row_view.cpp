#include "pipeline/synth/row_view.h"

namespace hsgm::synth {

namespace {

// Disparities that differ by less are the same point, computed in two ways.
constexpr double kSamePoint_px = 1e-7;

} // namespace

RowView::RowView(const Landscape& landscape, std::span<const Piece> pieces, View view, double y)
    : landscape_(&landscape), view_(view), y_(y)
{
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const Span span = span_on_row(pieces[i], view, y);
        if (span.end > span.begin) {
            spans_.push_back({span, static_cast<int>(i)});
        }
    }
}

double RowView::ground_disparity(double column) const
{
    const TerrainSurface& ground = landscape_->ground();
    return view_ == View::left ? ground.disparity(column, y_)
                               : ground.disparity_from_right(column, y_);
}

RowView::Seen RowView::nearest(double column) const
{
    Seen seen{ground_disparity(column), kGround};
    for (const PieceSpan& p : spans_) {
        if (p.span.covers(column) && p.span.disparity(column) > seen.disparity_px) {
            seen = {p.span.disparity(column), p.piece};
        }
    }
    return seen;
}

bool RowView::hides(double column, double disparity_px) const
{
    for (const PieceSpan& p : spans_) {
        if (p.span.covers(column) && p.span.disparity(column) > disparity_px + kSamePoint_px) {
            return true;
        }
    }
    return false;
}

Area area_seen(const DisparityBounds& bounds, View view, double first, double last,
               double y_begin, double y_end)
{
    if (view == View::left) {
        return {first, last, y_begin, y_end};
    }
    return {first + bounds.min_px, last + bounds.max_px, y_begin, y_end};
}

} // namespace hsgm::synth
