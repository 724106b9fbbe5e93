#include "pipeline/bench/peak_memory.h"

#include "tiling/page_store.h"

#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace hsgm::bench {

namespace {

constexpr std::int64_t kKiB = 1024;

// The value in bytes of a line "Key:   123 kB" of one of the kernel's tables.
std::optional<std::int64_t> kernel_figure(const char* path, const std::string& key)
{
    std::ifstream table(path);
    for (std::string word; table >> word;) {
        std::int64_t kibibytes = 0;
        if (word == key + ":" && table >> kibibytes) {
            return kibibytes * kKiB;
        }
    }
    return std::nullopt;
}

std::optional<std::int64_t> number_in(const char* path)
{
    std::ifstream file(path);
    std::int64_t value = 0;
    if (file >> value) {
        return value;
    }
    return std::nullopt;
}

} // namespace

PeakMemoryWatch::PeakMemoryWatch()
{
    malloc_trim(0);
    tiling::release_free_pages();
    std::ofstream marks("/proc/self/clear_refs");
    marks << "5";
    marks.flush();
    const auto resident = kernel_figure("/proc/self/status", "VmRSS");
    works_ = marks.good() && resident.has_value();
    before_ = resident.value_or(0);
}

std::optional<PeakBytes> PeakMemoryWatch::peak() const
{
    const auto peak = kernel_figure("/proc/self/status", "VmHWM");
    if (!works_ || !peak) {
        return std::nullopt;
    }
    return PeakBytes{*peak, std::max<std::int64_t>(*peak - before_, 0)};
}

std::int64_t free_memory_bytes()
{
    std::int64_t free = kernel_figure("/proc/meminfo", "MemAvailable")
                            .value_or(std::numeric_limits<std::int64_t>::max());
    const auto limit = number_in("/sys/fs/cgroup/memory.max");
    const auto used = number_in("/sys/fs/cgroup/memory.current");
    if (limit && used) {
        free = std::min(free, *limit - *used);
    }
    return free;
}

} // namespace hsgm::bench
