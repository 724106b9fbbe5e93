#include "pipeline/geometry/ground_lattice.h"

#include "pipeline/geometry/error.h"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace hsgm::geometry {

namespace {

constexpr int kMaxSteps = 20;
constexpr double kStepM = 1.0; // of the differences that stand for derivatives
constexpr double kDoneM = 1e-6;
constexpr double kParallel = 1e-4; // rays that part by less a metre do not meet
constexpr int kLayers = 4;         // disparities of a node
constexpr int kChannels = 4;       // x, y, height, residual
constexpr int kLeastStepPx = 8;
constexpr double kLeastRangePx = 1; // of disparities, lest nodes coincide

using Residuals = Eigen::Vector4d;

Residuals residuals(const GroundCamera& left, ImagePoint in_left, const GroundCamera& right,
                    ImagePoint in_right, const MapPoint& place)
{
    const ImagePoint a = left.project(place);
    const ImagePoint b = right.project(place);
    return {a.x - in_left.x, a.y - in_left.y, b.x - in_right.x, b.y - in_right.y};
}

/// Lagrange's weights of the layers, which are evenly spaced, at a disparity.
std::array<double, kLayers> layer_weights(double disparity_px, double min_px, double max_px)
{
    const double t = (disparity_px - min_px) / (max_px - min_px) * (kLayers - 1);
    return {-(t - 1) * (t - 2) * (t - 3) / 6, t * (t - 2) * (t - 3) / 2,
            -t * (t - 1) * (t - 3) / 2, t * (t - 1) * (t - 2) / 6};
}

/// The result of a place from what its layers hold.
void mix(std::span<const double> layers, const std::array<double, kLayers>& w,
         std::array<double, kChannels>& result)
{
    for (std::size_t k = 0; k < kChannels; ++k) {
        result[k] = (w[0] * layers[k] + w[1] * layers[kChannels + k]) +
                    (w[2] * layers[2 * kChannels + k] + w[3] * layers[3 * kChannels + k]);
    }
}

/// Fills nodes with exact meetings.
class Filler {
public:
    Filler(const EpipolarFrame& frame, const GroundCamera& left, const GroundCamera& right,
           const ToOutput& to_output)
        : frame_(frame), left_(left), right_(right), to_output_(to_output)
    {
    }

    Meeting exact(FramePoint place, double disparity_px) const
    {
        const ImagePoint in_left = frame_.left_at(place);
        const ImagePoint in_right = frame_.right_at({place.row, place.col - disparity_px});
        MapPoint start = frame_.map_at(place);
        start.height_m += disparity_px / frame_.px_per_m;
        if (const auto on_ray = left_.locate(in_left, start.height_m)) {
            start = *on_ray;
        }
        auto meeting = meet_rays(left_, in_left, right_, in_right, start);
        if (!meeting) {
            throw GeometryError(
                fmt::format("the rays of pixel ({:.0f}, {:.0f}) of the epipolar "
                            "frame do not meet at disparity {:.1f} px",
                            place.row, place.col, disparity_px));
        }
        meeting->place = to_output_(meeting->place);
        return *meeting;
    }

    Lattice lattice(int step, double min_px, double max_px) const
    {
        // From the frame's first pixel to its last or just beyond, where its own lattices still
        // reach.
        const int rows = std::max(tiling::ceil_div(frame_.size.rows - 1, step) + 1, 4);
        const int cols = std::max(tiling::ceil_div(frame_.size.cols - 1, step) + 1, 4);
        Lattice nodes(0, 0, step, rows, cols, kLayers * kChannels);
        for (int i = 0; i < rows; ++i) {
            for (int j = 0; j < cols; ++j) {
                const FramePoint place{double(i) * step, double(j) * step};
                const auto node = nodes.node(i, j);
                for (int layer = 0; layer < kLayers; ++layer) {
                    const double d = min_px + (max_px - min_px) * layer / (kLayers - 1);
                    const Meeting meeting = exact(place, d);
                    const auto at = static_cast<std::size_t>(layer * kChannels);
                    node[at] = meeting.place.x;
                    node[at + 1] = meeting.place.y;
                    node[at + 2] = meeting.place.height_m;
                    node[at + 3] = meeting.residual_px;
                }
            }
        }
        return nodes;
    }

private:
    const EpipolarFrame& frame_;
    const GroundCamera& left_;
    const GroundCamera& right_;
    const ToOutput& to_output_;
};

/// That of the frame's own lattices, but four nodes must fit on the frame.
int first_step(const EpipolarFrame& frame)
{
    const int least_side = std::min(frame.size.rows, frame.size.cols) - 1;
    int step = static_cast<int>(frame.map.step());
    while (step > 1 && 3 * step > least_side) {
        step /= 2;
    }
    return step;
}

} // namespace

std::optional<Meeting> meet_rays(const GroundCamera& left, ImagePoint in_left,
                                 const GroundCamera& right, ImagePoint in_right,
                                 const MapPoint& start)
{
    MapPoint place = start;
    for (int step = 0; step < kMaxSteps; ++step) {
        const Residuals here = residuals(left, in_left, right, in_right, place);
        Eigen::Matrix<double, 4, 3> slopes;
        for (int k = 0; k < 3; ++k) {
            MapPoint ahead = place;
            MapPoint behind = place;
            (k == 0 ? ahead.x : k == 1 ? ahead.y : ahead.height_m) += kStepM;
            (k == 0 ? behind.x : k == 1 ? behind.y : behind.height_m) -= kStepM;
            slopes.col(k) = (residuals(left, in_left, right, in_right, ahead) -
                             residuals(left, in_left, right, in_right, behind)) /
                            (2 * kStepM);
        }
        Eigen::ColPivHouseholderQR<Eigen::Matrix<double, 4, 3>> solver;
        solver.setThreshold(kParallel);
        solver.compute(slopes);
        if (!slopes.allFinite() || solver.rank() < 3) {
            return std::nullopt;
        }
        const Eigen::Vector3d move = solver.solve(-here);
        place.x += move[0];
        place.y += move[1];
        place.height_m += move[2];
        if (move.norm() < kDoneM) {
            return Meeting{place, residuals(left, in_left, right, in_right, place).norm() / 2};
        }
    }
    return std::nullopt;
}

GroundLattice::GroundLattice(const EpipolarFrame& frame, const GroundCamera& left,
                             const GroundCamera& right, double disparity_min_px,
                             double disparity_max_px, const ToOutput& to_output,
                             double tolerance)
    : disparity_min_px_(disparity_min_px),
      disparity_max_px_(std::max(disparity_max_px, disparity_min_px + kLeastRangePx))
{
    const Filler filler(frame, left, right, to_output);
    const double limit_m = tolerance * frame.gsd_m;
    for (int step = first_step(frame);; step /= 2) {
        nodes_ = filler.lattice(step, disparity_min_px_, disparity_max_px_);
        error_m_ = 0;
        // In the middle of every cell, and of the outer layers, where cubics are worst.
        for (int i = 0; i + 1 < nodes_.rows() && error_m_ <= limit_m; ++i) {
            for (int j = 0; j + 1 < nodes_.cols(); ++j) {
                const FramePoint middle{(i + 0.5) * step, (j + 0.5) * step};
                const double d = disparity_min_px_ + (disparity_max_px_ - disparity_min_px_) *
                                                         ((i + j) % 2 == 0 ? 1.0 / 6 : 5.0 / 6);
                const MapPoint a = at(middle, d).place;
                const MapPoint b = filler.exact(middle, d).place;
                error_m_ = std::max(error_m_,
                                    std::hypot(a.x - b.x, a.y - b.y, a.height_m - b.height_m));
            }
        }
        if (error_m_ <= limit_m || step <= kLeastStepPx) {
            return;
        }
    }
}

GroundLattice::GroundLattice(Lattice nodes, double disparity_min_px, double disparity_max_px,
                             double error_m)
    : nodes_(std::move(nodes)), disparity_min_px_(disparity_min_px),
      disparity_max_px_(disparity_max_px), error_m_(error_m)
{
    assert(nodes_.channels() == kLayers * kChannels);
}

Meeting GroundLattice::at(FramePoint place, double disparity_px) const
{
    std::array<double, kLayers * kChannels> layers{};
    std::array<double, kChannels> result{};
    nodes_.at(place.row, place.col, layers);
    mix(layers, layer_weights(disparity_px, disparity_min_px_, disparity_max_px_), result);
    return {{result[0], result[1], result[2]}, result[3]};
}

void GroundLattice::points(int row, int col, std::span<const float> disparity_px,
                           const Row& result) const
{
    assert(result.x.size() == disparity_px.size() && result.y.size() == disparity_px.size());
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    LatticeRow along(nodes_);
    along.set(row);
    std::array<double, kLayers * kChannels> layers{};
    std::array<double, kChannels> point{};
    for (std::size_t i = 0; i < disparity_px.size(); ++i) {
        const double d = double{disparity_px[i]};
        point.fill(kNone);
        if (!std::isnan(d)) {
            along.at(col + static_cast<double>(i), layers);
            mix(layers, layer_weights(d, disparity_min_px_, disparity_max_px_), point);
        }
        result.x[i] = point[0];
        result.y[i] = point[1];
        result.height_m[i] = point[2];
        result.residual_px[i] = static_cast<float>(point[3]);
    }
}

} // namespace hsgm::geometry
