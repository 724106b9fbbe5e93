#include "pipeline/cpu_worker.h"

#include <stdexcept>
#include <utility>

namespace hsgm::pipeline {

CpuWorker::CpuWorker(int number, std::shared_ptr<const matcher::Matcher> matcher,
                     std::shared_ptr<const matcher::CoarseSolution> coarse,
                     std::shared_ptr<tbb::task_arena> arena)
    : number_(number), matcher_(std::move(matcher)), coarse_(std::move(coarse)),
      arena_(std::move(arena))
{
}

std::string CpuWorker::name() const
{
    return "cpu " + std::to_string(number_);
}

matcher::TileMatch CpuWorker::match(const TileTask& task)
{
    const auto cancellable = std::make_shared<Cancellable>();
    {
        const std::scoped_lock lock(mutex_);
        current_ = cancellable;
    }
    matcher::TileMatch result;
    const bool whole = arena_->execute([&] {
        return cancellable->run(
            [&] { result = matcher_->match_tile(task.core, task.images, *coarse_); });
    });
    if (!whole) {
        throw std::runtime_error("the tile was given up half way");
    }
    return result;
}

void CpuWorker::cancel()
{
    const std::scoped_lock lock(mutex_);
    if (current_ != nullptr) {
        current_->cancel();
    }
}

} // namespace hsgm::pipeline
