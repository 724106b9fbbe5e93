#pragma once

// What the stand-in tells the sanitizers; nothing in a build without them.

#include <cstddef>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/asan_interface.h>
#include <sanitizer/common_interface_defs.h>
#endif
#if defined(HSGM_THREAD_SANITIZER)
#include <sanitizer/tsan_interface.h>
#endif

namespace hsgm::stand_in {

inline void poison([[maybe_unused]] const void* begin, [[maybe_unused]] std::size_t bytes)
{
#if defined(__SANITIZE_ADDRESS__)
    __asan_poison_memory_region(begin, bytes);
#endif
}

inline void unpoison([[maybe_unused]] const void* begin, [[maybe_unused]] std::size_t bytes)
{
#if defined(__SANITIZE_ADDRESS__)
    __asan_unpoison_memory_region(begin, bytes);
#endif
}

/// Everything before a release comes before everything after an acquire of the same object.
inline void release([[maybe_unused]] void* object)
{
#if defined(HSGM_THREAD_SANITIZER)
    __tsan_release(object);
#endif
}

inline void acquire([[maybe_unused]] void* object)
{
#if defined(HSGM_THREAD_SANITIZER)
    __tsan_acquire(object);
#endif
}

} // namespace hsgm::stand_in
