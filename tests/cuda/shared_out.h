#pragma once

#include "pipeline/match_worker.h"

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace hsgm::cuda_test {

/// Counts the tiles that kinds of workers take in a run, and sees to it that each kind takes
/// its share: with two tiles taken, one waits until the others have two as well.
class SharedOut {
public:
    using Worker = std::shared_ptr<pipeline::MatchWorker>;

    /// For RunManner::adapt_worker; this must outlive the run.
    std::function<Worker(Worker)> adapter()
    {
        return [this](Worker worker) -> Worker {
            const std::scoped_lock lock(mutex_);
            tiles_.try_emplace(kind(*worker), 0);
            return std::make_shared<Counted>(std::move(worker), *this);
        };
    }
    /// Tiles that workers of a kind, "cpu" or "cuda", took.
    int tiles(const std::string& kind) const
    {
        const auto found = tiles_.find(kind);
        return found == tiles_.end() ? 0 : found->second;
    }

private:
    static constexpr int kShare = 2;

    class Counted final : public pipeline::MatchWorker {
    public:
        Counted(Worker inner, SharedOut& owner) : inner_(std::move(inner)), owner_(owner) {}
        std::string name() const override { return inner_->name(); }
        matcher::TileMatch match(const pipeline::TileTask& task) override
        {
            owner_.take(kind(*inner_));
            return inner_->match(task);
        }
        void cancel() override { inner_->cancel(); }

    private:
        Worker inner_;
        SharedOut& owner_;
    };

    static std::string kind(const pipeline::MatchWorker& worker)
    {
        return worker.name().substr(0, worker.name().find_first_of(": "));
    }
    void take(const std::string& kind)
    {
        std::unique_lock lock(mutex_);
        if (tiles_[kind]++ >= kShare) {
            // Ends in any case, so that a run that does not share fails and does not hang.
            taken_.wait_for(lock, std::chrono::seconds(60), [this] {
                for (const auto& [of_kind, count] : tiles_) {
                    if (count < kShare) {
                        return false;
                    }
                }
                return true;
            });
        }
        taken_.notify_all();
    }

    mutable std::mutex mutex_;
    std::condition_variable taken_;
    std::map<std::string, int> tiles_;
};

} // namespace hsgm::cuda_test
