#pragma once

#include <tbb/task_group.h>

#include <functional>
#include <mutex>

namespace hsgm::pipeline {

/// Work on the threads of the TBB arena it is called in, which another thread may cut short:
/// its parallel loops then stop handing out pieces, so that it comes to its end soon, with a
/// result that is worth nothing. So libraries below need not know of stopping.
class Cancellable {
public:
    /// Carries out `work`. False: it was cut short. Exceptions of `work` come through.
    bool run(const std::function<void()>& work);
    /// From any thread; also before `run`, and after it, when it does nothing.
    void cancel();

private:
    std::mutex mutex_;
    tbb::task_group_context* running_ = nullptr;
    bool cancelled_ = false;
};

/// Carries out `work`, and cuts it short when the process is asked to stop; then throws
/// Interrupted.
void run_until_stopped(const std::function<void()>& work);

} // namespace hsgm::pipeline
