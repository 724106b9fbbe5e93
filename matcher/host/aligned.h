#pragma once

#include "tiling/page_allocator.h"

#include <cstddef>
#include <vector>

namespace hsgm::matcher::host {

/// A buffer whose start is aligned for any vector length and that only ever grows, so that
/// a worker touches fresh memory once, not once a window.
template <typename T>
class Buffer {
public:
    /// At least `count` elements; their old content is not kept, new ones have no value.
    T* need(std::size_t count)
    {
        if (count > data_.size()) {
            data_.clear();
            data_.resize(count);
        }
        return data_.data();
    }
    T* data() { return data_.data(); }
    const T* data() const { return data_.data(); }

private:
    std::vector<T, tiling::PageAllocator<T>> data_;
};

} // namespace hsgm::matcher::host
