#pragma once

#include "pipeline/dsm/cell_area.h"
#include "pipeline/dsm/cell_block.h"
#include "pipeline/dsm/dsm_grid.h"
#include "pipeline/dsm/fused_cells.h"
#include "pipeline/dsm/reason_block.h"
#include "pipeline/stages/ground_points.h"
#include "pipeline/stages/hole_points.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

namespace hsgm::pipeline {

/// A finished match whose pixels become ground points.
struct MatchedPair {
    std::filesystem::path disparity;
    std::filesystem::path confidence;
    std::filesystem::path reasons;
    const geometry::GroundLattice* ground = nullptr;
    FrameImages images;
    double gsd_m = 0; ///< of its frame, in metres
};

/// What a piece of a frame holds, for those who look for its points.
struct PieceSurvey {
    dsm::Bounds bounds; ///< of its points; empty: it has none
    bool holes = false; ///< some pixels have no disparity
    float lowest_px = 0;
    float middle_px = 0; ///< the median disparity; of a piece without any, that of the next one
    float highest_px = 0;
};

PieceSurvey survey_of(const PointPiece& points);

/// How points become cells.
struct CellManner {
    double cell_m = 1;          ///< side of a cell
    double map_units_per_m = 1; ///< 1 in metric maps
    int min_confidence = 0;     ///< cells of less have no value; `PairCells` leaves them in
    /// Cells outside have no value; null: there is no such bound.
    std::shared_ptr<const dsm::CellArea> region;
};

using dsm::ReasonedCells;

/// One pair's points, looked up by where they lie on the map. Each block of cells is computed
/// from the same points in the same way, whoever asks.
class PairCells {
public:
    /// The pieces in which frames are read, whatever tiles the match had.
    static std::vector<tiling::Rect> pieces_of_frame(tiling::Size frame);

    /// `surveys` are of all pieces. What the pair points to must outlive this.
    PairCells(const MatchedPair& pair, const CellManner& manner,
              std::vector<PieceSurvey> surveys);
    ~PairCells();

    /// What its points cover.
    const dsm::Bounds& bounds() const { return bounds_; }
    /// From any thread.
    ReasonedCells block(const dsm::DsmGrid& grid, const tiling::Rect& cells) const;

    /// What a block of that size takes at most.
    static std::int64_t bytes(tiling::Size block, double gsd_m, double cell_m);

private:
    struct Readers;
    dsm::Bounds hole_bounds(const tiling::Rect& piece, const PieceSurvey& survey) const;
    dsm::CellArea outline() const;
    void fill_reasons(const dsm::DsmGrid& grid, const tiling::Rect& cells,
                      const dsm::ReasonBlock& holes, ReasonedCells& result) const;

    MatchedPair pair_;
    CellManner manner_;
    std::vector<tiling::Rect> pieces_;
    std::vector<PieceSurvey> surveys_;
    std::vector<dsm::Bounds> hole_bounds_;
    float middle_px_ = 0; ///< the median of the pieces' medians
    dsm::Bounds bounds_;
    dsm::CellArea outline_;
    std::unique_ptr<Readers> readers_;
};

} // namespace hsgm::pipeline
