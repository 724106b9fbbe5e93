#include "pipeline/bench/peer.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

namespace hsgm::bench {

namespace {

struct PeerTraits {
    Peer peer;
    std::string_view name;
    const char* title;
    int mode;
    bool keeps_all; ///< costs and sums of every pixel, not of some rows
};

constexpr std::array<PeerTraits, 4> kPeers{{
    {Peer::hh, "hh", "OpenCV HH, 8 paths", cv::StereoSGBM::MODE_HH, true},
    {Peer::hh4, "hh4", "OpenCV HH4, 4 paths", cv::StereoSGBM::MODE_HH4, true},
    {Peer::sgbm, "sgbm", "OpenCV SGBM, 5 paths", cv::StereoSGBM::MODE_SGBM, false},
    {Peer::three_way, "3way", "OpenCV 3WAY, 3 paths", cv::StereoSGBM::MODE_SGBM_3WAY, false},
}};

const PeerTraits& traits_of(Peer peer)
{
    return *std::find_if(kPeers.begin(), kPeers.end(),
                         [peer](const PeerTraits& t) { return t.peer == peer; });
}

cv::Mat bytes(const tiling::Image<std::uint16_t>& image, const matcher::Tone& tone)
{
    cv::Mat result(image.rows(), image.cols(), CV_8U);
    for (int row = 0; row < image.rows(); ++row) {
        std::transform(image.row(row), image.row(row) + image.cols(), result.ptr(row), tone);
    }
    return result;
}

} // namespace

std::string_view name(Peer peer)
{
    return traits_of(peer).name;
}

std::vector<Peer> all_peers()
{
    std::vector<Peer> peers;
    for (const PeerTraits& t : kPeers) {
        peers.push_back(t.peer);
    }
    return peers;
}

Peer peer_from_name(std::string_view name)
{
    for (const PeerTraits& t : kPeers) {
        if (t.name == name) {
            return t.peer;
        }
    }
    throw std::invalid_argument(
        "peers must be none, all or some of hh, hh4, sgbm, 3way, not '" + std::string(name) +
        "'");
}

std::string title(Peer peer)
{
    return traits_of(peer).title;
}

std::string peer_version()
{
    return cv::getVersionString();
}

ColumnRange compared_columns(const matcher::PairShape& shape)
{
    const int cols = std::min(shape.left.cols, shape.right.cols);
    return {std::max(shape.asked.max + 1, 0), cols + std::min(shape.asked.min, 0)};
}

std::optional<std::string> why_not(const matcher::PairShape& shape)
{
    if (shape.left != shape.right) {
        return "OpenCV takes images of equal width only";
    }
    if (shape.asked.count() % 16 != 0) {
        return "OpenCV counts disparities in sixteens, and these are " +
               std::to_string(shape.asked.count());
    }
    if (compared_columns(shape).count() == 0) {
        return "OpenCV leaves out as many columns as there are disparities, and here that is "
               "all of them";
    }
    return std::nullopt;
}

std::int64_t peer_bytes(Peer peer, const matcher::PairShape& shape)
{
    const std::int64_t cells_of_row =
        std::int64_t{compared_columns(shape).count()} * shape.asked.count();
    constexpr std::int64_t kRowsKept = 64;
    const std::int64_t rows = traits_of(peer).keeps_all ? shape.left.rows : kRowsKept;
    return 4 * cells_of_row * rows + 2 * shape.left.area();
}

struct PeerPair::State {
    tiling::DisparityRange asked;
    cv::Mat left;
    cv::Mat right;
    cv::Mat disparity; // in 1/16 px
};

PeerPair::PeerPair(const BenchPair& pair) : state_(std::make_unique<State>())
{
    state_->asked = pair.asked;
    state_->left = bytes(pair.left, pair.left_tone);
    state_->right = bytes(pair.right, pair.right_tone);
}

PeerPair::~PeerPair() = default;

void PeerPair::match(Peer peer, int threads)
{
    constexpr int kBlock = 3;
    cv::setNumThreads(threads);
    const auto sgbm = cv::StereoSGBM::create(state_->asked.min, state_->asked.count(), kBlock,
                                             8 * kBlock * kBlock, 32 * kBlock * kBlock, 1, 0, 0,
                                             0, 0, traits_of(peer).mode);
    sgbm->compute(state_->left, state_->right, state_->disparity);
}

tiling::Image<float> PeerPair::disparity_px() const
{
    const cv::Mat& found = state_->disparity;
    tiling::Image<float> result({found.rows, found.cols});
    const int none = (state_->asked.min - 1) * 16;
    for (int row = 0; row < found.rows; ++row) {
        const auto* values = found.ptr<std::int16_t>(row);
        std::transform(values, values + found.cols, result.row(row), [none](std::int16_t v) {
            return v == none ? std::numeric_limits<float>::quiet_NaN()
                             : static_cast<float>(v) / 16.0F;
        });
    }
    return result;
}

} // namespace hsgm::bench
