#include "pipeline/freed_memory.h"

#include "tiling/page_store.h"

#include <limits>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace hsgm::pipeline {

void keep_freed_memory()
{
#ifdef __GLIBC__
    constexpr int kLargestAllowed = 32 << 20; // glibc's own limit of this setting
    mallopt(M_MMAP_THRESHOLD, kLargestAllowed);
    // What one thread has freed, another one shall have: with an arena for each thread, the
    // peak grew by a tile or two, and differed from run to run.
    mallopt(M_ARENA_MAX, 1);
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

void give_back_freed_memory()
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
    tiling::release_free_pages();
}

} // namespace hsgm::pipeline
