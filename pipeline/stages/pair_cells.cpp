#include "pipeline/stages/pair_cells.h"

#include "pipeline/stages/ordered_pieces.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace hsgm::pipeline {

namespace {

using dsm::Missing;
using tiling::Rect;
using tiling::Size;

constexpr Size kFramePiece{256, 256};
/// Of the larger of cell and ground sampling distance: every cell of a closed surface finds
/// about four points.
constexpr double kRadius = 1.2;
/// Of a cell: neighbouring points of one surface rarely differ by more.
constexpr double kLayerGap = 2.0;

double step_m(const MatchedPair& pair, const CellManner& manner)
{
    return std::max(pair.gsd_m, manner.cell_m);
}

dsm::CellOptions cell_options(const MatchedPair& pair, const CellManner& manner)
{
    dsm::CellOptions options;
    options.radius = kRadius * step_m(pair, manner) * manner.map_units_per_m;
    options.layer_gap = kLayerGap * step_m(pair, manner);
    return options;
}

void add_points(const PointPiece& points, dsm::CellBlock& block)
{
    for (std::size_t i = 0; i < points.x.size(); ++i) {
        const double confidence = points.confidence.data()[i];
        if (!std::isnan(points.height_m[i])) {
            // A pixel with a value has a confidence; should a foreign file not have it, the
            // point counts for little.
            block.add(points.x[i], points.y[i], points.height_m[i],
                      std::isnan(confidence) ? std::uint8_t{1}
                                             : static_cast<std::uint8_t>(confidence));
        }
    }
}

/// The median of the pieces' medians.
float middle_of(const std::vector<PieceSurvey>& surveys)
{
    std::vector<float> known;
    for (const PieceSurvey& survey : surveys) {
        if (!survey.bounds.empty()) {
            known.push_back(survey.middle_px);
        }
    }
    const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
    std::nth_element(known.begin(), middle, known.end());
    return *middle;
}

/// The nearest piece that has points, the first of equals; nothing where none has.
std::optional<std::size_t> nearest_known(const std::vector<Rect>& pieces,
                                         const std::vector<PieceSurvey>& surveys,
                                         std::size_t from)
{
    std::optional<std::size_t> best;
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const std::int64_t rows = pieces[i].row - pieces[from].row;
        const std::int64_t cols = pieces[i].col - pieces[from].col;
        if (!surveys[i].bounds.empty() && rows * rows + cols * cols < least) {
            least = rows * rows + cols * cols;
            best = i;
        }
    }
    return best;
}

} // namespace

PieceSurvey survey_of(const PointPiece& points)
{
    PieceSurvey survey;
    std::vector<float> known;
    for (std::size_t i = 0; i < points.x.size(); ++i) {
        if (std::isnan(points.height_m[i])) {
            survey.holes = true;
        } else {
            survey.bounds.include(points.x[i], points.y[i]);
            known.push_back(points.disparity_px.data()[i]);
        }
    }
    if (!known.empty()) {
        const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
        std::nth_element(known.begin(), middle, known.end());
        survey.middle_px = *middle;
        const auto [lowest, highest] = std::minmax_element(known.begin(), known.end());
        survey.lowest_px = *lowest;
        survey.highest_px = *highest;
    }
    return survey;
}

struct PairCells::Readers {
    struct Own {
        explicit Own(const MatchedPair& pair)
            : points(*pair.ground, pair.disparity, pair.confidence),
              holes(*pair.ground, pair.images, pair.reasons)
        {
        }
        PointReader points;
        HoleReader holes;
    };
    tbb::enumerable_thread_specific<std::unique_ptr<Own>> of_thread;

    Own& get(const MatchedPair& pair)
    {
        auto& own = of_thread.local();
        if (!own) {
            own = std::make_unique<Own>(pair);
        }
        return *own;
    }
};

std::vector<Rect> PairCells::pieces_of_frame(Size frame)
{
    return pieces_of(frame, kFramePiece);
}

PairCells::PairCells(const MatchedPair& pair, const CellManner& manner,
                     std::vector<PieceSurvey> surveys)
    : pair_(pair), manner_(manner), pieces_(pieces_of_frame(pair.images.frame->size)),
      surveys_(std::move(surveys)), outline_({}), readers_(std::make_unique<Readers>())
{
    for (const PieceSurvey& survey : surveys_) {
        bounds_.include(survey.bounds);
    }
    if (bounds_.empty()) {
        return;
    }
    middle_px_ = middle_of(surveys_);
    const std::vector<PieceSurvey> known = surveys_;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        if (known[i].bounds.empty()) {
            const float middle = known[nearest_known(pieces_, known, i).value()].middle_px;
            surveys_[i].lowest_px = surveys_[i].middle_px = surveys_[i].highest_px = middle;
        }
        hole_bounds_.push_back(surveys_[i].holes ? hole_bounds(pieces_[i], surveys_[i])
                                                 : dsm::Bounds{});
    }
    outline_ = outline();
}

PairCells::~PairCells() = default;

// Of what lies between the corners, middles of sides included, at both ends of its disparities;
// what bulges out further is less than a cell of the margin that blocks have.
dsm::Bounds PairCells::hole_bounds(const Rect& piece, const PieceSurvey& survey) const
{
    dsm::Bounds bounds;
    for (const double row : {0.0, 0.5, 1.0}) {
        for (const double col : {0.0, 0.5, 1.0}) {
            for (const float disparity : {survey.lowest_px, middle_px_, survey.highest_px}) {
                const auto place = pair_.ground
                                       ->at({piece.row + row * (piece.rows - 1),
                                             piece.col + col * (piece.cols - 1)},
                                            double{disparity})
                                       .place;
                bounds.include(place.x, place.y);
            }
        }
    }
    return bounds;
}

/// The frame's border on the map, on the ground as it lies there.
dsm::CellArea PairCells::outline() const
{
    const Size frame = pair_.images.frame->size;
    const int across = tiling::ceil_div(frame.cols, kFramePiece.cols);
    dsm::Ring ring;
    const auto add = [&](int row, int col) {
        const auto piece =
            static_cast<std::size_t>(std::min(row, frame.rows - 1) / kFramePiece.rows *
                                     across) +
            static_cast<std::size_t>(std::min(col, frame.cols - 1) / kFramePiece.cols);
        const auto place = pair_.ground
                               ->at({static_cast<double>(std::min(row, frame.rows - 1)),
                                     static_cast<double>(std::min(col, frame.cols - 1))},
                                    double{surveys_[piece].middle_px})
                               .place;
        ring.push_back({place.x, place.y});
    };
    for (int col = 0; col < frame.cols; col += kFramePiece.cols) {
        add(0, col);
    }
    for (int row = 0; row < frame.rows; row += kFramePiece.rows) {
        add(row, frame.cols);
    }
    for (int col = frame.cols; col > 0; col -= kFramePiece.cols) {
        add(frame.rows, col);
    }
    for (int row = frame.rows; row > 0; row -= kFramePiece.rows) {
        add(row, 0);
    }
    return dsm::CellArea({ring});
}

ReasonedCells PairCells::block(const dsm::DsmGrid& grid, const Rect& cells) const
{
    const dsm::CellOptions options = cell_options(pair_, manner_);
    dsm::CellBlock block(grid, cells, options);
    dsm::ReasonBlock holes(grid, cells, options.radius);
    Readers::Own& readers = readers_->get(pair_);
    for (std::size_t p = 0; p < hole_bounds_.size(); ++p) {
        const bool has_points =
            !surveys_[p].bounds.empty() && surveys_[p].bounds.meets(block.reach(), 0);
        const bool has_holes =
            !hole_bounds_[p].empty() && hole_bounds_[p].meets(holes.reach(), 0);
        if (!has_points && !has_holes) {
            continue;
        }
        const PointPiece points = readers.points.read(pieces_[p]);
        if (has_points) {
            add_points(points, block);
        }
        if (has_holes) {
            for (const HolePoint& hole :
                 readers.holes.read(points, {surveys_[p].middle_px, middle_px_})) {
                holes.add(hole.x, hole.y, hole.reason);
            }
        }
    }
    ReasonedCells result{block.finish(), tiling::Image<std::uint8_t>(cells.size())};
    fill_reasons(grid, cells, holes, result);
    return result;
}

void PairCells::fill_reasons(const dsm::DsmGrid& grid, const Rect& cells,
                             const dsm::ReasonBlock& holes, ReasonedCells& result) const
{
    const auto cols = static_cast<std::size_t>(cells.cols);
    std::vector<std::uint8_t> in_region(cols, 1);
    std::vector<std::uint8_t> in_frame(cols);
    for (int r = 0; r < cells.rows; ++r) {
        if (manner_.region) {
            manner_.region->mark(grid, cells.row + r, cells.col, in_region);
        }
        outline_.mark(grid, cells.row + r, cells.col, in_frame);
        for (int c = 0; c < cells.cols; ++c) {
            const auto i = static_cast<std::size_t>(c);
            Missing why = Missing::none;
            if (in_region[i] == 0) {
                why = Missing::outside_region;
                result.cells.clear(r, c);
            } else if (result.cells.height(r, c) == dsm::kNoHeight) {
                why = holes.most(r, c);
                if (why == Missing::none) {
                    why = in_frame[i] != 0 ? Missing::hidden : Missing::outside;
                }
            }
            result.reasons(r, c) = static_cast<std::uint8_t>(why);
        }
    }
}

std::int64_t PairCells::bytes(Size block, double gsd_m, double cell_m)
{
    constexpr std::int64_t kPointBytes = 4 + 8 + 8 + 3 * 8 + 4;
    constexpr std::int64_t kStoredPoint = 40;
    constexpr std::int64_t kHoleBytes = 2 * 2 * sizeof(HolePoint); // a vector that has grown
    constexpr std::int64_t kCellBytes = 4 + 4 + 1 + 1 + 1 + 8;
    const double per_cell = std::max(1.0, cell_m * cell_m / (gsd_m * gsd_m));
    // Surfaces that lie above each other, as facades do, bring more points to a cell.
    const auto points =
        static_cast<std::int64_t>(static_cast<double>(block.area()) * per_cell * 2.5);
    return kFramePiece.area() * (kPointBytes + kHoleBytes) + points * kStoredPoint +
           dsm::reason_block_bytes(block) + block.area() * kCellBytes;
}

} // namespace hsgm::pipeline
