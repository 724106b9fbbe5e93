#include "pipeline/cuda_worker.h"

#include <fmt/format.h>

#include <algorithm>

namespace hsgm::pipeline {

namespace cuda = matcher::cuda;

CudaWorker::CudaWorker(std::string name, const MatchBasis& basis,
                       std::unique_ptr<cuda::DeviceMatcher> device, OnDeviceTrouble trouble)
    : name_(std::move(name)), matcher_(basis.matcher),
      instead_(0, basis.matcher, basis.coarse, basis.arena), device_(std::move(device)),
      trouble_(std::move(trouble))
{
}

matcher::TileMatch CudaWorker::match(const TileTask& task)
{
    if (device_ != nullptr) {
        try {
            return device_->match_tile(task.core, task.images);
        } catch (const cuda::DeviceError& error) {
            trouble_(fmt::format("{}: {}; tile {} is matched on the processor", name_,
                                 error.what(), task.index));
            if (error.lost()) {
                device_.reset();
            }
        }
    }
    return instead_.match(task);
}

std::vector<std::shared_ptr<MatchWorker>> make_workers(const DevicePlan& plan,
                                                       const Budget& budget,
                                                       const MatchBasis& basis,
                                                       const OnDeviceTrouble& trouble)
{
    std::vector<std::shared_ptr<MatchWorker>> workers;
    const matcher::Matcher& matcher = *basis.matcher;
    const auto cores =
        plan.cuda.empty() ? std::vector<tiling::Rect>{} : tile_cores(matcher, budget);
    for (const PlannedDevice& device : plan.cuda) {
        const std::string name = fmt::format("cuda:{}", device.info.number);
        try {
            const auto on_device = cuda::upload_coarse(matcher, *basis.coarse, device.info);
            for (int stream = 0; stream < device.streams; ++stream) {
                workers.push_back(std::make_shared<CudaWorker>(
                    fmt::format("{} stream {}", name, stream), basis,
                    cuda::make_device_matcher(matcher, on_device, device.info, cores),
                    trouble));
            }
        } catch (const cuda::DeviceError& error) {
            trouble(fmt::format("{}: {}; it takes no part in this run", name, error.what()));
        }
    }
    const int on_processor = budget.workers - plan.streams();
    for (int i = 0; i < (workers.empty() ? std::max(on_processor, 1) : on_processor); ++i) {
        workers.push_back(
            std::make_shared<CpuWorker>(i, basis.matcher, basis.coarse, basis.arena));
    }
    return workers;
}

} // namespace hsgm::pipeline
