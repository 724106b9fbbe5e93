#pragma once

#include "tiling/page_store.h"

#include <cstddef>
#include <cstdlib>
#include <new>
#include <utility>

namespace hsgm::tiling {

/// Allocator for pixels and costs. Starts are aligned for any vector length; large blocks come
/// from the page store. Elements that are given no value stay uninitialised.
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
        if (is_large(bytes)) {
            return static_cast<T*>(take_pages(bytes));
        }
        void* memory =
            std::aligned_alloc(kAlignment, (bytes + kAlignment - 1) / kAlignment * kAlignment);
        if (memory == nullptr) {
            throw std::bad_alloc();
        }
        return static_cast<T*>(memory);
    }
    void deallocate(T* memory, std::size_t count)
    {
        if (is_large(count * sizeof(T))) {
            give_pages(memory, count * sizeof(T));
        } else {
            std::free(memory);
        }
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

    bool operator==(const PageAllocator&) const { return true; }

private:
    static constexpr std::size_t kAlignment = 128;
    static constexpr std::size_t kLargeBlock = std::size_t{1} << 20;

    static constexpr bool is_large(std::size_t bytes)
    {
#if defined(__SANITIZE_ADDRESS__) || !defined(__linux__)
        return bytes >
               static_cast<std::size_t>(-1) / 2; // so that each block has its own guards
#else
        return bytes >= kLargeBlock;
#endif
    }
};

} // namespace hsgm::tiling
