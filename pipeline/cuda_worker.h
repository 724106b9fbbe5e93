#pragma once

#include "pipeline/cpu_worker.h"
#include "pipeline/device_plan.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// Told, in a sentence, that a device took no part or could not match a tile, and why.
using OnDeviceTrouble = std::function<void(const std::string& why)>;

/// What workers match with; they may outlive whoever made them.
struct MatchBasis {
    std::shared_ptr<const matcher::Matcher> matcher;
    std::shared_ptr<const matcher::CoarseSolution> coarse;
    std::shared_ptr<tbb::task_arena> arena; ///< for work on the processor
};

/// Matches on one stream of a CUDA device. Where the device fails, the tile is matched on the
/// processor at once, with the same bits; after the loss of the device, so are all later ones.
class CudaWorker final : public MatchWorker {
public:
    CudaWorker(std::string name, const MatchBasis& basis,
               std::unique_ptr<matcher::cuda::DeviceMatcher> device, OnDeviceTrouble trouble);

    std::string name() const override { return name_; }
    matcher::TileMatch match(const TileTask& task) override;
    void cancel() override { instead_.cancel(); }

private:
    std::string name_;
    std::shared_ptr<const matcher::Matcher> matcher_;
    CpuWorker instead_;
    std::unique_ptr<matcher::cuda::DeviceMatcher> device_; ///< null once it is lost
    OnDeviceTrouble trouble_;
};

/// The workers of a plan: every stream of every device, then those on the processor. A device
/// that fails while it is made ready takes no part, and `trouble` hears of it. At least one
/// worker comes back; on the processor, if no device is left.
std::vector<std::shared_ptr<MatchWorker>> make_workers(const DevicePlan& plan,
                                                       const Budget& budget,
                                                       const MatchBasis& basis,
                                                       const OnDeviceTrouble& trouble);

} // namespace hsgm::pipeline
