#pragma once

#include "pipeline/geometry/map_grid.h"
#include "pipeline/geometry/map_projection.h"
#include "tiling/image.h"

#include <string>

namespace hsgm::geometry {

/// Heights of the ground known from elsewhere, at the posts of a map grid: a reference DEM, or
/// the part of one that matters. Immutable; threads may share one.
class ElevationGrid {
public:
    /// `posts` are metres above the WGS84 ellipsoid, NaN where there is none; `crs` is the
    /// grid's horizontal reference system as MapProjection reads it.
    ElevationGrid(MapGrid grid, std::string crs, tiling::Image<float> posts);

    /// Height at a place between posts, which are pixel centres: bilinear, as programs that
    /// make orthoimages take it. Up to half a post beyond the outermost their heights go on.
    /// NaN further out, and where a post that counts has no height.
    double height_m(ImagePoint post) const;

    const MapGrid& grid() const { return grid_; }
    const std::string& crs() const { return crs_; }
    const tiling::Image<float>& posts() const { return posts_; }
    double lowest_m() const { return lowest_m_; }
    double highest_m() const { return highest_m_; }
    /// Half-way between them; NaN where no post has a height, as they are then.
    double middle_m() const { return (lowest_m_ + highest_m_) / 2; }

private:
    MapGrid grid_;
    std::string crs_;
    tiling::Image<float> posts_;
    double lowest_m_ = 0;
    double highest_m_ = 0;
};

} // namespace hsgm::geometry
