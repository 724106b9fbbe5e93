#pragma once

#include "matcher/cuda/coarse_upload.h"

namespace hsgm::matcher::cuda {

/// Matches tiles in one stream.
template <typename Cell>
class TileMatcher final : public DeviceMatcher {
public:
    TileMatcher(const Matcher& matcher, std::shared_ptr<const CoarseOnDevice<Cell>> coarse,
                const DeviceInfo& device, std::span<const tiling::Rect> cores);

    TileMatch match_tile(const tiling::Rect& core,
                         std::span<const LevelImages> images) override;

private:
    void upload(const TileMemory<Cell>& memory, std::span<const LevelImages> images);
    void make_features(const SolveJob<Cell>& job, const LevelMemory<Cell>& memory,
                       const Area& right_image);
    void solve_level(const TileMemory<Cell>& memory, int level);
    SolveJob<Cell> job_of(const TileMemory<Cell>& memory, int level) const;
    TileMatch download(const TileMemory<Cell>& memory, const tiling::Rect& core);
    MatchStatistics work_of(const TileMemory<Cell>& memory, const Window* windows) const;

    const Matcher& matcher_;
    std::shared_ptr<const CoarseOnDevice<Cell>> coarse_;
    DeviceInfo device_;
    Stream stream_;
    DeviceBuffer buffer_;
    PinnedBuffer up_;
    PinnedBuffer down_;
};

} // namespace hsgm::matcher::cuda
