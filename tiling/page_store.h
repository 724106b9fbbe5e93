#pragma once

#include <cstddef>

namespace hsgm::tiling {

/// Room for large blocks, straight from the system, in large pages where it has them.
///
/// What is freed is kept for the next block, because touching fresh memory takes a quarter of a
/// match's time; but never so much that free and used blocks together pass the most that was
/// ever in use at once by more than a tenth. So memory stays what the plan says, however long a
/// run is: a heap that is cut up by blocks of many sizes does not. Thread-safe.

/// A block of at least `bytes`, its contents undefined. Throws std::bad_alloc.
void* take_pages(std::size_t bytes);
/// Gives back a block of take_pages(bytes).
void give_pages(void* block, std::size_t bytes) noexcept;
/// Returns everything that is free to the system, and forgets how much was in use before.
void release_free_pages() noexcept;

/// Bytes of the system's that are held, in use or free.
std::size_t held_page_bytes() noexcept;

} // namespace hsgm::tiling
