#pragma once

#include "pipeline/bench/bench_pair.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hsgm::bench {

/// OpenCV's StereoSGBM in its modes: 8, 4, 5 and 3 paths. Block 3 px, P1 = 72, P2 = 288,
/// left-right check at 1 px, no other filter.
enum class Peer { hh, hh4, sgbm, three_way };

/// "hh", "hh4", "sgbm", "3way".
std::string_view name(Peer peer);
std::vector<Peer> all_peers();
/// The peer of that name; throws std::invalid_argument listing the names there are.
Peer peer_from_name(std::string_view name);
/// "OpenCV HH, 8 paths"; the version is `peer_version()`.
std::string title(Peer peer);
std::string peer_version();

/// The columns [first, end) of the left image that a peer matches: it leaves out those that
/// for some disparity of the range have no counterpart, on the left and on the right.
struct ColumnRange {
    int first = 0;
    int end = 0;
    int count() const { return end > first ? end - first : 0; }
};
ColumnRange compared_columns(const matcher::PairShape& shape);

/// Why a peer cannot match a pair of this shape; nothing where it can: widths that differ,
/// a range that does not count in sixteens or leaves no column.
std::optional<std::string> why_not(const matcher::PairShape& shape);

/// Bytes that a peer takes beside the images: full path sums of every pixel for hh and hh4
/// (as measured on OpenCV 4.6), some rows for the others.
std::int64_t peer_bytes(Peer peer, const matcher::PairShape& shape);

/// One pair in OpenCV's own form, so that converting it is nobody's time.
class PeerPair {
public:
    explicit PeerPair(const BenchPair& pair);
    ~PeerPair();
    PeerPair(const PeerPair&) = delete;
    PeerPair& operator=(const PeerPair&) = delete;

    /// Matches the pair with that many threads. The disparities stay for `disparity_px`.
    void match(Peer peer, int threads);
    /// What came of the last match, NaN where there is no value.
    tiling::Image<float> disparity_px() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace hsgm::bench
