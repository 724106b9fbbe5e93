#pragma once

#include <cstddef>
#include <cstdint>
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
        // Not aligned to large pages: glibc finds no freed block again for such a wish, and the
        // heap would grow from tile to tile.
        void* memory = std::aligned_alloc(kAlignment, rounded_up(bytes, kAlignment));
        if (memory == nullptr) {
            throw std::bad_alloc();
        }
#ifdef __linux__
        // Whole large pages inside alone: no more memory than was asked for. A refusal costs
        // time only.
        const auto begin = reinterpret_cast<std::uintptr_t>(memory);
        const std::uintptr_t first = rounded_up(begin, kLargePage);
        const std::uintptr_t end = (begin + bytes) / kLargePage * kLargePage;
        if (end > first) {
            madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
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
    static constexpr std::size_t rounded_up(std::size_t value, std::size_t step)
    {
        return (value + step - 1) / step * step;
    }

    static constexpr std::size_t kAlignment = 128;
    static constexpr std::size_t kLargePage = std::size_t{2} << 20;
};

} // namespace hsgm::tiling
