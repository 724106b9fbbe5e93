#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace hsgm::stand_in {

/// The memory of the devices: every allocation lies between forbidden margins, holds rubbish
/// at first, and may have forbidden zones inside.
class DeviceMemory {
public:
    /// Null where more than `limit` bytes would be in use.
    void* allocate(std::size_t bytes, std::size_t limit);
    /// False for a pointer that was not allocated.
    bool release(void* pointer);

    void forbid(std::byte* begin, std::size_t bytes);
    void allow(std::byte* begin, std::size_t bytes);

    /// Whether the bytes lie in one allocation.
    bool holds(const void* begin, std::size_t bytes) const;
    /// Whether all forbidden bytes are untouched.
    bool intact() const;

    std::size_t used() const { return used_; }
    std::size_t peak() const { return peak_; }
    void forget_peak() { peak_ = used_; }

private:
    struct Allocation {
        std::vector<std::byte> bytes;
        std::size_t size;
    };

    std::map<std::byte*, Allocation> allocations_; // by the first byte that may be used
    std::map<std::byte*, std::size_t> forbidden_;
    std::size_t used_ = 0;
    std::size_t peak_ = 0;
};

} // namespace hsgm::stand_in
