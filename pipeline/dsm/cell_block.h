#pragma once

#include "pipeline/dsm/dsm_grid.h"
#include "tiling/image.h"

#include <cstdint>
#include <vector>

namespace hsgm::dsm {

/// How points become cells. Lengths are in the map's units.
struct CellOptions {
    double radius = 1;    ///< points so far from a cell's centre count, the less the farther
    double layer_gap = 1; ///< points whose heights are so far apart lie on different surfaces
};

/// Value of a cell without points.
constexpr float kNoHeight = -32768.0F;

/// What is known of cells.
struct Cells {
    explicit Cells(tiling::Size size)
        : height(size, kNoHeight), spread(size, kNoHeight), points(size), confidence(size)
    {
    }
    /// Takes a cell's value away.
    void clear(int row, int col)
    {
        height(row, col) = kNoHeight;
        spread(row, col) = kNoHeight;
        points(row, col) = 0;
        confidence(row, col) = 0;
    }
    tiling::Image<float> height;        ///< kNoHeight where there is no point
    tiling::Image<float> spread;        ///< root mean square of the points about it
    tiling::Image<std::uint8_t> points; ///< that it was made from, at most 255
    /// 1 to 255, 0 where there is no value: the points' mean, times the layer's share of all
    /// weight: where a cell lies across an edge, either surface may be the one at its centre.
    tiling::Image<std::uint8_t> confidence;
};

/// Some cells of a grid while their points come in. A cell's height is the mean of the points
/// round its centre that lie on one surface, weighted by nearness and confidence:
///
///         o o  o    roof            The points within the radius, in order of height, are cut
///         ......                    where two neighbours are further apart than the gap. The
///               .   o   ground      layer of greatest weight wins, the higher one of equals.
///           ^ cell
///
/// A cell depends on the set of its points alone, in whatever order they come and whichever
/// block it is computed in.
class CellBlock {
public:
    CellBlock(const DsmGrid& grid, const tiling::Rect& cells, const CellOptions& options);

    /// What the block can use: points outside change nothing.
    const Bounds& reach() const { return reach_; }
    /// A point; `confidence` from 1 to 255.
    void add(double x, double y, double height, std::uint8_t confidence);
    /// The cells, once all points are in.
    Cells finish();

private:
    struct Point {
        double x = 0;
        double y = 0;
        double height = 0;
        std::uint32_t bin = 0;
        std::uint8_t confidence = 0;
    };
    struct Member {
        double height = 0;
        double x = 0;
        double y = 0;
        double weight = 0;
        double confidence = 0;
    };
    void gather(int row, int col, std::vector<Member>& members) const;
    void sort_points();

    DsmGrid grid_;
    tiling::Rect cells_;
    CellOptions options_;
    int margin_;        ///< cells round the block whose points count
    tiling::Rect bins_; ///< the block with its margin
    Bounds reach_;
    std::vector<Point> points_;
    std::vector<std::size_t> first_of_bin_;
};

} // namespace hsgm::dsm
