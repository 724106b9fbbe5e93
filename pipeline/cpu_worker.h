#pragma once

#include "pipeline/cancellable.h"
#include "pipeline/match_worker.h"

#include <tbb/task_arena.h>

#include <memory>
#include <mutex>

namespace hsgm::pipeline {

/// Matches on the processor; the windows of its tile are shared out to the threads of `arena`.
class CpuWorker final : public MatchWorker {
public:
    CpuWorker(int number, std::shared_ptr<const matcher::Matcher> matcher,
              std::shared_ptr<const matcher::CoarseSolution> coarse,
              std::shared_ptr<tbb::task_arena> arena);
    std::string name() const override;
    matcher::TileMatch match(const TileTask& task) override;
    void cancel() override;

private:
    int number_;
    std::shared_ptr<const matcher::Matcher> matcher_;
    std::shared_ptr<const matcher::CoarseSolution> coarse_;
    std::shared_ptr<tbb::task_arena> arena_;
    std::mutex mutex_;
    std::shared_ptr<Cancellable> current_;
};

} // namespace hsgm::pipeline
