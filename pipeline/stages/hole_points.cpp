#include "pipeline/stages/hole_points.h"

#include "matcher/reasons.h"

#include <cmath>
#include <limits>
#include <span>

namespace hsgm::pipeline {

namespace {

using dsm::Missing;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// Clearly so: at the very edge neither rounding nor a guessed disparity shall make a mask of
/// what is none.
bool inside(geometry::ImagePoint point, tiling::Size image)
{
    constexpr double kEdgePx = 1;
    return point.x >= kEdgePx && point.y >= kEdgePx && point.x <= image.cols - 1 - kEdgePx &&
           point.y <= image.rows - 1 - kEdgePx;
}

/// The disparity of the last pixel with one, going along a row either way.
std::vector<float> carried(std::span<const float> disparity_px, bool forward)
{
    std::vector<float> result(disparity_px.size());
    float last = kNone;
    for (std::size_t i = 0; i < result.size(); ++i) {
        const std::size_t at = forward ? i : result.size() - 1 - i;
        last = std::isnan(disparity_px[at]) ? last : disparity_px[at];
        result[at] = last;
    }
    return result;
}

} // namespace

/// What is worked on row by row.
struct HoleReader::Work {
    explicit Work(const tiling::Rect& piece)
        : bits(piece.size()), guess_px(static_cast<std::size_t>(piece.cols)),
          x(guess_px.size()), y(guess_px.size()), height(guess_px.size()),
          residual(guess_px.size())
    {
    }
    tiling::Image<double> bits;
    std::vector<float> guess_px; ///< NaN: no point is wanted
    std::vector<double> x, y, height;
    std::vector<float> residual;
};

HoleReader::HoleReader(const geometry::GroundLattice& ground, const FrameImages& images,
                       const std::filesystem::path& reasons)
    : ground_(ground), images_(images), reasons_(io::ImageSpec{reasons.string()})
{
}

// The edges of the images look like nodata to the matcher, which knows no sources.
bool HoleReader::left_shows(int row, int col) const
{
    return inside(images_.frame->left_at({double(row), double(col)}), images_.left);
}

Missing HoleReader::reason_of(int row, int col, unsigned bits, float disparity_px) const
{
    if ((bits & matcher::kFailedTile) != 0) {
        return Missing::failed_tile;
    }
    if ((bits & matcher::kNodataLeft) != 0) {
        return left_shows(row, col) ? Missing::masked_left : Missing::outside;
    }
    const geometry::FramePoint there{double(row), col - double{disparity_px}};
    if ((bits & matcher::kOutside) != 0 ||
        !inside(images_.frame->right_at(there), images_.right)) {
        return Missing::outside;
    }
    if ((bits & matcher::kNodataRight) != 0) {
        return Missing::masked_right;
    }
    if ((bits & matcher::kOccluded) != 0) {
        return Missing::occluded;
    }
    return (bits & matcher::kUncertain) != 0 ? Missing::uncertain : Missing::inconsistent;
}

void HoleReader::add_points(const tiling::Rect& piece, int row, Work& work,
                            std::vector<HolePoint>& points) const
{
    ground_.points(piece.row + row, piece.col, work.guess_px,
                   {work.x, work.y, work.height, work.residual});
    for (int c = 0; c < piece.cols; ++c) {
        const auto i = static_cast<std::size_t>(c);
        if (!std::isnan(work.guess_px[i])) {
            points.push_back(
                {work.x[i], work.y[i],
                 reason_of(piece.row + row, piece.col + c,
                           static_cast<unsigned>(work.bits(row, c)), work.guess_px[i])});
        }
    }
}

std::vector<HolePoint> HoleReader::read(const PointPiece& piece, const Fallback& fallback)
{
    std::vector<HolePoint> points;
    Work work(piece.rect);
    reasons_.read(piece.rect, work.bits);
    for (int r = 0; r < piece.rect.rows; ++r) {
        const auto disparity = piece.disparity_px.view().row_span(r);
        const auto before = carried(disparity, true);
        const auto after = carried(disparity, false);
        const auto guess = [&](int c, bool first) {
            const auto i = static_cast<std::size_t>(c);
            if (!std::isnan(disparity[i])) {
                return kNone;
            }
            const auto bits = static_cast<unsigned>(work.bits(r, c));
            if ((bits & matcher::kNodataLeft) != 0 &&
                !left_shows(piece.rect.row + r, piece.rect.col + c)) {
                return first ? fallback.frame_px : kNone;
            }
            if (std::isnan(before[i]) && std::isnan(after[i])) {
                return first ? fallback.piece_px : kNone;
            }
            return first ? before[i] : after[i] == before[i] ? kNone : after[i];
        };
        for (const bool first : {true, false}) {
            bool any = false;
            for (int c = 0; c < piece.rect.cols; ++c) {
                const float px = guess(c, first);
                work.guess_px[static_cast<std::size_t>(c)] = px;
                any = any || !std::isnan(px);
            }
            if (any) {
                add_points(piece.rect, r, work, points);
            }
        }
    }
    return points;
}

} // namespace hsgm::pipeline
