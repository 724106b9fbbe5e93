#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace hsgm::tiling {

/// Allocator for pixels and costs. Starts are aligned for any vector length; large blocks ask
/// the system for large pages, without which touching fresh memory takes a few percent of a
/// match's time. Elements that are given no value stay uninitialised.
template <typename T>
class PageAllocator {
public:
    using value_type = T;

    PageAllocator() = default;
    template <typename U>
    PageAllocator(const PageAllocator<U>&)
    {
    }

    T* allocate(std::size_t count)
    {
        const std::size_t bytes = count * sizeof(T);
        const std::size_t alignment = bytes >= 2 * kLargePage ? kLargePage : kAlignment;
        void* memory =
            std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
        if (memory == nullptr) {
            throw std::bad_alloc();
        }
#ifdef __linux__
        if (alignment == kLargePage) {
            // Whole pages alone: no more memory than was asked for. A refusal costs time only.
            madvise(memory, bytes / kLargePage * kLargePage, MADV_HUGEPAGE);
        }
#endif
        return static_cast<T*>(memory);
    }
    void deallocate(T* memory, std::size_t)
    {
        std::free(memory);
    }

    template <typename U>
    void construct(U* at)
    {
        ::new (static_cast<void*>(at)) U;
    }
    template <typename U, typename... Values>
    void construct(U* at, Values&&... values)
    {
        ::new (static_cast<void*>(at)) U(std::forward<Values>(values)...);
    }

    bool operator==(const PageAllocator&) const
    {
        return true;
    }

private:
    static constexpr std::size_t kAlignment = 128;
    static constexpr std::size_t kLargePage = std::size_t{2} << 20;
};

} // namespace hsgm::tiling
