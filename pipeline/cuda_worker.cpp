#include "pipeline/cuda_worker.h"

#include <fmt/format.h>

namespace hsgm::pipeline {

namespace cuda = matcher::cuda;

CudaWorker::CudaWorker(std::string name, const matcher::Matcher& matcher,
                       const matcher::CoarseSolution& coarse,
                       std::unique_ptr<cuda::DeviceMatcher> device, OnDeviceTrouble trouble)
    : name_(std::move(name)), matcher_(matcher), coarse_(coarse), device_(std::move(device)),
      trouble_(std::move(trouble))
{
}

matcher::TileMatch CudaWorker::match(const TileTask& task)
{
    if (device_ != nullptr) {
        try {
            return device_->match_tile(task.core, task.images);
        } catch (const cuda::DeviceError& error) {
            trouble_(task.index, name_ + ": " + error.what());
            if (error.lost()) {
                device_.reset();
            }
        }
    }
    return matcher_.match_tile(task.core, task.images, coarse_);
}

std::vector<std::unique_ptr<MatchWorker>>
make_workers(const DevicePlan& plan, const Budget& budget, const matcher::Matcher& matcher,
             const matcher::CoarseSolution& coarse, const OnDeviceTrouble& trouble)
{
    std::vector<std::unique_ptr<MatchWorker>> workers;
    const auto cores =
        plan.cuda.empty() ? std::vector<tiling::Rect>{} : tile_cores(matcher, budget);
    for (const PlannedDevice& device : plan.cuda) {
        const std::string name = fmt::format("cuda:{}", device.info.number);
        try {
            const auto on_device = cuda::upload_coarse(matcher, coarse, device.info);
            for (int stream = 0; stream < device.streams; ++stream) {
                workers.push_back(std::make_unique<CudaWorker>(
                    name, matcher, coarse,
                    cuda::make_device_matcher(matcher, on_device, device.info, cores),
                    trouble));
            }
        } catch (const cuda::DeviceError& error) {
            trouble(-1, name + ": " + error.what());
        }
    }
    const int on_processor = budget.workers - plan.streams();
    for (int i = 0; i < (workers.empty() ? std::max(on_processor, 1) : on_processor); ++i) {
        workers.push_back(std::make_unique<CpuWorker>(i, matcher, coarse));
    }
    return workers;
}

} // namespace hsgm::pipeline
