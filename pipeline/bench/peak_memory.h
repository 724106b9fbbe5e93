#pragma once

#include <cstdint>
#include <optional>

namespace hsgm::bench {

/// Peak resident memory of a piece of work in this process.
struct PeakBytes {
    std::int64_t peak = 0;  ///< of the whole process while the work went on
    std::int64_t added = 0; ///< what that is above what was resident when it began
};

/// Watches the peak of resident memory from its construction on, without a child process:
/// the kernel's high-water mark (VmHWM in /proc/self/status) is put back by writing 5 to
/// /proc/self/clear_refs, after memory that the allocator holds back was returned.
class PeakMemoryWatch {
public:
    PeakMemoryWatch();
    /// The peak so far; nothing where the kernel does not allow it.
    std::optional<PeakBytes> peak() const;

private:
    bool works_ = false;
    std::int64_t before_ = 0;
};

/// Memory that new work may take now: what the kernel calls available, and what is left of
/// the cgroup's limit.
std::int64_t free_memory_bytes();

} // namespace hsgm::bench
