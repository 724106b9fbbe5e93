// Lays the epipolar frame: finds what both images see, follows the direction of parallax
// across it, and notes which source pixels the nodes of the grid show.

#include "pipeline/geometry/epipolar_frame.h"
#include "pipeline/geometry/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace hsgm::geometry {

namespace {

constexpr double kLeastBaseToHeight = 0.02;
constexpr double kMostBaseToHeight = 2.0;
constexpr int kLevelStepPx = 256; // between nodes, at first
constexpr int kReliefStepPx = 64;
constexpr int kLeastStepPx = 8;
constexpr int kMarginPx = 2;

struct Vector {
    double x = 0;
    double y = 0;
    double length() const { return std::hypot(x, y); }
};

/// A range of frame coordinates, in pixels from the frame's centre.
struct Extent {
    double row_min = std::numeric_limits<double>::infinity();
    double row_max = -std::numeric_limits<double>::infinity();
    double col_min = std::numeric_limits<double>::infinity();
    double col_max = -std::numeric_limits<double>::infinity();

    void add(FramePoint p)
    {
        row_min = std::min(row_min, p.row);
        row_max = std::max(row_max, p.row);
        col_min = std::min(col_min, p.col);
        col_max = std::max(col_max, p.col);
    }
    Extent grown(double px) const
    {
        return {row_min - px, row_max + px, col_min - px, col_max + px};
    }
};

std::string range_text(const Polygon& polygon)
{
    const auto [west, east] = std::minmax_element(
        polygon.begin(), polygon.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
    const auto [south, north] = std::minmax_element(
        polygon.begin(), polygon.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
    const auto metres = [](double value) { return std::to_string(std::llround(value)); };
    return "x " + metres(west->x) + " to " + metres(east->x) + " m, y " + metres(south->y) +
           " to " + metres(north->y) + " m";
}

MapPoint centroid(const Polygon& polygon)
{
    MapPoint sum;
    double weight = 0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        const MapPoint& a = polygon[0];
        const MapPoint& b = polygon[i];
        const MapPoint& c = polygon[i + 1];
        const double w = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        sum.x += w * (b.x - a.x + c.x - a.x) / 3;
        sum.y += w * (b.y - a.y + c.y - a.y) / 3;
        weight += w;
    }
    return {polygon[0].x + sum.x / weight, polygon[0].y + sum.y / weight, 0};
}

class Builder {
public:
    Builder(const GroundCamera& left, tiling::Size left_size, const GroundCamera& right,
            tiling::Size right_size, const ReferenceSurface& surface,
            const FrameOptions& options)
        : left_(left), right_(right), left_size_(left_size), right_size_(right_size),
          surface_(surface), options_(options)
    {
    }

    EpipolarFrame build();

private:
    /// What both images see at one height over the surface.
    struct Joint {
        double above_m = 0;
        Polygon region;
    };

    void find_joint_regions();
    void find_centre();
    double own_gsd(const GroundCamera& camera) const;
    Vector ray_slope(const GroundCamera& camera, const MapPoint& place) const;
    Vector parallax(const MapPoint& place) const;
    Vector direction(double x, double y) const;
    MapPoint on_surface(double x, double y) const;
    MapPoint advanced(const MapPoint& from, double distance_m) const;
    Extent seen(const EpipolarFrame& frame) const;
    EpipolarFrame laid(const Extent& extent, int step_px) const;
    void follow_row(Lattice& map, int i) const;
    void look_up(EpipolarFrame& frame) const;
    double lattice_error(const EpipolarFrame& frame) const;

    const GroundCamera& left_;
    const GroundCamera& right_;
    tiling::Size left_size_;
    tiling::Size right_size_;
    const ReferenceSurface& surface_;
    const FrameOptions& options_;

    std::vector<Joint> joints_;
    double bulge_m_ = 0;
    MapPoint centre_;
    Vector along_; // unit vector along the rows at the centre
    double images_gsd_m_ = 0;
    double gsd_m_ = 0;
    double ratio_ = 0;   // metres of parallax for a metre of height, at the centre
    double reach_m_ = 0; // how far heights move a place along the surface, at most
};

void Builder::find_joint_regions()
{
    for (const double above_m : {0.0, options_.below_m, options_.above_m}) {
        const Footprint left = footprint(left_, left_size_, surface_, above_m);
        const Footprint right = footprint(right_, right_size_, surface_, above_m);
        const Polygon both = intersection(left.corners, right.corners);
        if (above_m == 0 && both.empty()) {
            throw GeometryError("the images do not overlap: at " +
                                std::to_string(std::lround(surface_.level_m())) +
                                " m the left one shows " + range_text(left.corners) +
                                ", the right one " + range_text(right.corners));
        }
        const Polygon region =
            options_.region.empty() ? both : intersection(both, options_.region);
        if (above_m == 0 && region.empty()) {
            throw GeometryError("the region of interest, " + range_text(options_.region) +
                                ", lies outside what both images show, " + range_text(both));
        }
        if (!region.empty()) {
            joints_.push_back({above_m, region});
            bulge_m_ = std::max({bulge_m_, left.bulge_m, right.bulge_m});
        }
    }
}

MapPoint Builder::on_surface(double x, double y) const
{
    return {x, y, surface_.height_m(x, y)};
}

/// Metres that the ray of a camera through a place moves for a metre up.
Vector Builder::ray_slope(const GroundCamera& camera, const MapPoint& place) const
{
    const ImagePoint image = camera.project(place);
    const auto low = camera.locate(image, place.height_m + options_.below_m);
    const auto high = camera.locate(image, place.height_m + options_.above_m);
    if (!low || !high) {
        throw GeometryError("a ray through x " + std::to_string(std::llround(place.x)) +
                            " m, y " + std::to_string(std::llround(place.y)) +
                            " m cannot be followed; the RPC does not reach there");
    }
    const double rise = high->height_m - low->height_m;
    return {(high->x - low->x) / rise, (high->y - low->y) / rise};
}

/// How far the image of a point that rises from `place` by a metre moves along the surface in
/// the left image, less the same in the right one. Both rays span the epipolar plane; this is
/// where it cuts the surface's tangent plane.
Vector Builder::parallax(const MapPoint& place) const
{
    double slope_x = 0;
    double slope_y = 0;
    surface_.height_m(place.x, place.y, slope_x, slope_y);
    const auto on_slope = [&](Vector ray) {
        const double steepness = 1 - (slope_x * ray.x + slope_y * ray.y);
        return Vector{ray.x / steepness, ray.y / steepness};
    };
    const Vector left = on_slope(ray_slope(left_, place));
    const Vector right = on_slope(ray_slope(right_, place));
    return {right.x - left.x, right.y - left.y};
}

Vector Builder::direction(double x, double y) const
{
    const Vector p = parallax(on_surface(x, y));
    const double length = p.length();
    return {p.x / length, p.y / length};
}

/// Root of the ground area of a pixel at the centre.
double Builder::own_gsd(const GroundCamera& camera) const
{
    constexpr double kStep = 10;
    const ImagePoint here = camera.project(centre_);
    const ImagePoint east = camera.project({centre_.x + kStep, centre_.y, centre_.height_m});
    const ImagePoint north = camera.project({centre_.x, centre_.y + kStep, centre_.height_m});
    const double pixels =
        (east.x - here.x) * (north.y - here.y) - (east.y - here.y) * (north.x - here.x);
    return kStep / std::sqrt(std::abs(pixels));
}

void Builder::find_centre()
{
    const MapPoint middle = centroid(joints_.front().region);
    centre_ = on_surface(middle.x, middle.y);
    const Vector p = parallax(centre_);
    ratio_ = p.length();
    if (!(ratio_ >= kLeastBaseToHeight)) {
        throw GeometryError("the images were taken from nearly the same place: their "
                            "base-to-height ratio is " +
                            std::to_string(ratio_) + ", at least 0.02 is needed for heights");
    }
    if (ratio_ > kMostBaseToHeight) {
        throw GeometryError("the images were taken from nearly opposite sides: their "
                            "base-to-height ratio is " +
                            std::to_string(ratio_) + ", at most 2 can be matched");
    }
    along_ = {p.x / ratio_, p.y / ratio_};
    reach_m_ =
        std::max(ray_slope(left_, centre_).length(), ray_slope(right_, centre_).length()) *
        std::max(std::abs(options_.below_m), std::abs(options_.above_m));
    images_gsd_m_ = std::sqrt(own_gsd(left_) * own_gsd(right_));
    gsd_m_ = options_.gsd_m > 0 ? options_.gsd_m : options_.finer * images_gsd_m_;
}

/// A step along the rows by Runge and Kutta's rule of fourth order.
MapPoint Builder::advanced(const MapPoint& from, double distance_m) const
{
    const double half = distance_m / 2;
    const Vector a = direction(from.x, from.y);
    const Vector b = direction(from.x + half * a.x, from.y + half * a.y);
    const Vector c = direction(from.x + half * b.x, from.y + half * b.y);
    const Vector d = direction(from.x + distance_m * c.x, from.y + distance_m * c.y);
    return on_surface(from.x + distance_m * (a.x + 2 * b.x + 2 * c.x + d.x) / 6,
                      from.y + distance_m * (a.y + 2 * b.y + 2 * c.y + d.y) / 6);
}

/// Fills one row of nodes, from the line through the centre across the rows outwards.
void Builder::follow_row(Lattice& map, int i) const
{
    const double row = map.first_row() + i * map.step();
    const MapPoint base =
        on_surface(centre_.x + row * gsd_m_ * along_.y, centre_.y - row * gsd_m_ * along_.x);
    const auto put = [&](int j, const MapPoint& place) {
        const auto node = map.node(i, j);
        node[0] = place.x;
        node[1] = place.y;
        node[2] = place.height_m;
    };
    const auto col_of = [&](int j) { return map.first_col() + j * map.step(); };
    const int first =
        std::clamp(static_cast<int>(std::ceil(-map.first_col() / map.step())), 0, map.cols());
    MapPoint here = base;
    for (int j = first; j < map.cols(); ++j) {
        here = advanced(here, (col_of(j) - (j == first ? 0 : col_of(j - 1))) * gsd_m_);
        put(j, here);
    }
    here = base;
    for (int j = first - 1; j >= 0; --j) {
        here = advanced(here, (col_of(j) - (j == first - 1 ? 0 : col_of(j + 1))) * gsd_m_);
        put(j, here);
    }
}

/// The frame over an extent, its lattices still counted from the centre.
EpipolarFrame Builder::laid(const Extent& extent, int step_px) const
{
    EpipolarFrame frame;
    frame.images_gsd_m = images_gsd_m_;
    frame.gsd_m = gsd_m_;
    frame.px_per_m = ratio_ / gsd_m_;
    frame.angle_rad = std::atan2(along_.y, along_.x);
    frame.below_m = options_.below_m;
    frame.above_m = options_.above_m;
    const auto first_row = static_cast<int>(std::floor(extent.row_min));
    const auto first_col = static_cast<int>(std::floor(extent.col_min));
    frame.size = {static_cast<int>(std::ceil(extent.row_max)) - first_row + 1,
                  static_cast<int>(std::ceil(extent.col_max)) - first_col + 1};
    // The partner of a pixel may lie beside the frame by as much as its disparity.
    const double beside_px =
        std::max(std::abs(options_.below_m), std::abs(options_.above_m)) * frame.px_per_m;
    const int beside = static_cast<int>(std::ceil(beside_px / step_px)) + 1;
    const int rows = tiling::ceil_div(frame.size.rows, step_px) + 3;
    const int cols = tiling::ceil_div(frame.size.cols, step_px) + 1 + 2 * beside;
    frame.map =
        Lattice(first_row - step_px, first_col - beside * step_px, step_px, rows, cols, 3);
    for (int i = 0; i < rows; ++i) {
        follow_row(frame.map, i);
    }
    return frame;
}

/// The frame coordinates of all that both images see, in either image.
Extent Builder::seen(const EpipolarFrame& frame) const
{
    Extent extent;
    for (const Joint& joint : joints_) {
        for (const MapPoint& corner : joint.region) {
            const double height = surface_.height_m(corner.x, corner.y) + joint.above_m;
            for (const GroundCamera* camera : {&left_, &right_}) {
                const auto place = meet_surface(
                    *camera, camera->project({corner.x, corner.y, height}), surface_);
                const auto pixel = place ? frame.frame_at(place->x, place->y) : std::nullopt;
                if (!pixel) {
                    throw GeometryError("the corner of the overlap at x " +
                                        std::to_string(std::llround(corner.x)) + " m, y " +
                                        std::to_string(std::llround(corner.y)) +
                                        " m cannot be found in the images");
                }
                extent.add(*pixel);
            }
        }
    }
    return extent;
}

void Builder::look_up(EpipolarFrame& frame) const
{
    const Lattice& map = frame.map;
    const auto fill = [&](Lattice& lattice, const GroundCamera& camera) {
        lattice =
            Lattice(map.first_row(), map.first_col(), map.step(), map.rows(), map.cols(), 2);
        for (int i = 0; i < map.rows(); ++i) {
            for (int j = 0; j < map.cols(); ++j) {
                const auto place = map.node(i, j);
                const ImagePoint image = camera.project({place[0], place[1], place[2]});
                lattice.node(i, j)[0] = image.x;
                lattice.node(i, j)[1] = image.y;
            }
        }
    };
    fill(frame.left, left_);
    fill(frame.right, right_);
}

/// The worst difference between lattices and cameras in the middles of all cells.
double Builder::lattice_error(const EpipolarFrame& frame) const
{
    const Lattice& map = frame.map;
    double worst = 0;
    const auto compare = [&](ImagePoint a, ImagePoint b) {
        worst = std::max(worst, std::hypot(a.x - b.x, a.y - b.y));
    };
    for (int i = 1; i + 2 < map.rows(); ++i) {
        for (int j = 1; j + 2 < map.cols(); ++j) {
            const FramePoint middle{map.first_row() + (i + 0.5) * map.step(),
                                    map.first_col() + (j + 0.5) * map.step()};
            const MapPoint flat = frame.map_at(middle);
            const MapPoint place = on_surface(flat.x, flat.y);
            compare(left_.project(place), frame.left_at(middle));
            compare(right_.project(place), frame.right_at(middle));
        }
    }
    return worst;
}

EpipolarFrame Builder::build()
{
    options_.validate();
    find_joint_regions();
    find_centre();
    // A first frame, wide enough however the rows turn, tells the extent of the second.
    Extent wide;
    for (const Joint& joint : joints_) {
        for (const MapPoint& corner : joint.region) {
            const double dx = (corner.x - centre_.x) / gsd_m_;
            const double dy = (corner.y - centre_.y) / gsd_m_;
            wide.add({dx * along_.y - dy * along_.x, dx * along_.x + dy * along_.y});
        }
    }
    const int first_step = surface_.is_level() ? kLevelStepPx : kReliefStepPx;
    const EpipolarFrame draft = laid(wide.grown(reach_m_ / gsd_m_), first_step);
    const Extent exact = seen(draft).grown(bulge_m_ / gsd_m_ + kMarginPx);
    for (int step = first_step;; step /= 2) {
        EpipolarFrame frame = laid(exact, step);
        look_up(frame);
        frame.lattice_error_px = lattice_error(frame);
        if (frame.lattice_error_px <= options_.tolerance_px || step <= kLeastStepPx) {
            const double row = std::floor(exact.row_min);
            const double col = std::floor(exact.col_min);
            frame.map.move_origin(row, col);
            frame.left.move_origin(row, col);
            frame.right.move_origin(row, col);
            return frame;
        }
    }
}

} // namespace

EpipolarFrame make_epipolar_frame(const GroundCamera& left, tiling::Size left_size,
                                  const GroundCamera& right, tiling::Size right_size,
                                  const ReferenceSurface& surface, const FrameOptions& options)
{
    return Builder(left, left_size, right, right_size, surface, options).build();
}

} // namespace hsgm::geometry
