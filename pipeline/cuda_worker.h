#pragma once

#include "pipeline/device_plan.h"
#include "pipeline/match_worker.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// Told of a tile that a device could not match, and why; another worker did it.
using OnDeviceTrouble = std::function<void(int tile, const std::string& why)>;

/// Matches on one stream of a CUDA device. Where the device fails, the tile is matched on the
/// processor at once, with the same bits; after the loss of the device, so are all later ones.
class CudaWorker final : public MatchWorker {
public:
    CudaWorker(std::string name, const matcher::Matcher& matcher,
               const matcher::CoarseSolution& coarse,
               std::unique_ptr<matcher::cuda::DeviceMatcher> device, OnDeviceTrouble trouble);

    std::string name() const override { return name_; }
    matcher::TileMatch match(const TileTask& task) override;

private:
    std::string name_;
    const matcher::Matcher& matcher_;
    const matcher::CoarseSolution& coarse_;
    std::unique_ptr<matcher::cuda::DeviceMatcher> device_; ///< null once it is lost
    OnDeviceTrouble trouble_;
};

/// The workers of a plan: those on the processor, then every stream of every device. A device
/// that fails while it is made ready takes no part: `trouble` hears of it with tile -1.
/// At least one worker comes back; on the processor, if no device is left.
std::vector<std::unique_ptr<MatchWorker>>
make_workers(const DevicePlan& plan, const Budget& budget, const matcher::Matcher& matcher,
             const matcher::CoarseSolution& coarse, const OnDeviceTrouble& trouble);

} // namespace hsgm::pipeline
