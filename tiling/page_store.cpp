#include "tiling/page_store.h"

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <new>
#include <vector>

#include <sys/mman.h>

namespace hsgm::tiling {

namespace {

constexpr std::size_t kStep = std::size_t{64} << 10; // block sizes are multiples of it
constexpr std::size_t kLargePage = std::size_t{2} << 20;

struct Block {
    std::byte* begin;
    std::size_t bytes;
};

std::size_t rounded_up(std::size_t value, std::size_t step)
{
    return (value + step - 1) / step * step;
}

// Fresh memory; it starts at a large page, so that it may be made of such.
std::byte* map_block(std::size_t bytes)
{
    const std::size_t wide = bytes + kLargePage;
    void* const mapped =
        mmap(nullptr, wide, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapped == MAP_FAILED) {
        throw std::bad_alloc();
    }
    auto* const first = static_cast<std::byte*>(mapped);
    const std::size_t before = rounded_up(reinterpret_cast<std::uintptr_t>(first), kLargePage) -
                               reinterpret_cast<std::uintptr_t>(first);
    if (before > 0) {
        munmap(first, before);
    }
    munmap(first + before + bytes, kLargePage - before);
#ifdef MADV_HUGEPAGE
    // Whole large pages alone: no more memory than was asked for. A refusal costs time only.
    madvise(first + before, bytes / kLargePage * kLargePage, MADV_HUGEPAGE);
#endif
    return first + before;
}

class PageStore {
public:
    void* take(std::size_t wanted)
    {
        const std::size_t bytes = rounded_up(wanted, kStep);
        const std::scoped_lock lock(mutex_);
        used_ += bytes;
        most_used_ = std::max(most_used_, used_);
        if (std::byte* const block = find(bytes)) {
            return block;
        }
        drop_oldest(most_used_ + most_used_ / 10);
        try {
            return map_block(bytes);
        } catch (...) {
            used_ -= bytes;
            throw;
        }
    }
    void give(void* block, std::size_t wanted) noexcept
    {
        const std::size_t bytes = rounded_up(wanted, kStep);
        const std::scoped_lock lock(mutex_);
        used_ -= bytes;
        try {
            free_.push_back({static_cast<std::byte*>(block), bytes});
            free_bytes_ += bytes;
        } catch (const std::bad_alloc&) {
            munmap(block, bytes);
        }
    }
    void release() noexcept
    {
        const std::scoped_lock lock(mutex_);
        drop_oldest(0);
        most_used_ = used_;
    }
    std::size_t held() noexcept
    {
        const std::scoped_lock lock(mutex_);
        return used_ + free_bytes_;
    }

private:
    // The free block that fits best, cut to size; the newest of equals, which the caches know.
    std::byte* find(std::size_t bytes)
    {
        auto best = free_.end();
        for (auto block = free_.begin(); block != free_.end(); ++block) {
            if (block->bytes >= bytes && (best == free_.end() || block->bytes <= best->bytes)) {
                best = block;
            }
        }
        if (best == free_.end() || best->bytes > bytes + bytes / 2) {
            return nullptr; // better a fresh one than the end of a much larger one
        }
        if (best->bytes > bytes) {
            munmap(best->begin + bytes, best->bytes - bytes);
        }
        std::byte* const begin = best->begin;
        free_bytes_ -= best->bytes;
        free_.erase(best);
        return begin;
    }
    // Until used and free blocks are within so many bytes.
    void drop_oldest(std::size_t allowed) noexcept
    {
        std::size_t drop = 0;
        for (; drop < free_.size() && used_ + free_bytes_ > allowed; ++drop) {
            munmap(free_[drop].begin, free_[drop].bytes);
            free_bytes_ -= free_[drop].bytes;
        }
        free_.erase(free_.begin(), free_.begin() + static_cast<std::ptrdiff_t>(drop));
    }

    std::mutex mutex_;
    std::vector<Block> free_; // oldest first
    std::size_t free_bytes_ = 0;
    std::size_t used_ = 0;
    std::size_t most_used_ = 0;
};

// Never destroyed: pixels of statics and of threads left behind may outlive everything.
PageStore& store()
{
    static auto* const pages = new PageStore;
    return *pages;
}

} // namespace

void* take_pages(std::size_t bytes)
{
    return store().take(bytes);
}

void give_pages(void* block, std::size_t bytes) noexcept
{
    store().give(block, bytes);
}

void release_free_pages() noexcept
{
    store().release();
}

std::size_t held_page_bytes() noexcept
{
    return store().held();
}

} // namespace hsgm::tiling
