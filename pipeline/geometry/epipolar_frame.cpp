#include "pipeline/geometry/epipolar_frame.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace hsgm::geometry {

namespace {

constexpr int kMaxSteps = 60;
constexpr double kTolerancePx = 1e-7;

ImagePoint image_at(const Lattice& lattice, FramePoint place)
{
    std::array<double, 2> xy{};
    lattice.at(place.row, place.col, xy);
    return {xy[0], xy[1]};
}

} // namespace

MapPoint EpipolarFrame::map_at(FramePoint place) const
{
    std::array<double, 3> xyz{};
    map.at(place.row, place.col, xyz);
    return {xyz[0], xyz[1], xyz[2]};
}

ImagePoint EpipolarFrame::left_at(FramePoint place) const
{
    return image_at(left, place);
}

ImagePoint EpipolarFrame::right_at(FramePoint place) const
{
    return image_at(right, place);
}

std::optional<FramePoint> EpipolarFrame::frame_at(double x, double y) const
{
    // The frame is all but a turned grid, so the turn's inverse serves for Newton's matrix.
    const double along_x = std::cos(angle_rad) / gsd_m;
    const double along_y = std::sin(angle_rad) / gsd_m;
    FramePoint place{size.rows / 2.0, size.cols / 2.0};
    for (int step = 0; step < kMaxSteps; ++step) {
        const MapPoint here = map_at(place);
        const double dx = x - here.x;
        const double dy = y - here.y;
        const double along = dx * along_x + dy * along_y;
        const double across = dx * along_y - dy * along_x;
        place.col += along;
        place.row += across;
        if (!std::isfinite(along) || !std::isfinite(across)) {
            break;
        }
        if (std::abs(along) < kTolerancePx && std::abs(across) < kTolerancePx) {
            return place;
        }
    }
    return std::nullopt;
}

void FrameOptions::validate() const
{
    if (!(gsd_m >= 0) || !std::isfinite(gsd_m)) {
        throw std::invalid_argument("gsd_m must be 0 (the images' own) or more, not " +
                                    std::to_string(gsd_m));
    }
    if (!(finer > 0) || !std::isfinite(finer)) {
        throw std::invalid_argument("finer must be above 0, not " + std::to_string(finer));
    }
    if (!(below_m < above_m)) {
        throw std::invalid_argument(
            "the lowest height over the surface, " + std::to_string(below_m) +
            " m, must be less than the highest, " + std::to_string(above_m) + " m");
    }
    if (!(tolerance_px > 0)) {
        throw std::invalid_argument("tolerance_px must be above 0");
    }
}

} // namespace hsgm::geometry
