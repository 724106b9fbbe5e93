#include "tests/device_stand_in/device_memory.h"

#include "tests/device_stand_in/sanitizers.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace hsgm::stand_in {

namespace {

constexpr std::byte kFresh{0xCD};
constexpr std::byte kForbidden{0xA5};
constexpr std::size_t kMargin = 256;

} // namespace

void* DeviceMemory::allocate(std::size_t bytes, std::size_t limit)
{
    if (used_ + bytes > limit) {
        return nullptr;
    }
    Allocation allocation{std::vector<std::byte>(bytes + 2 * kMargin + 256, kFresh), bytes};
    std::byte* first = allocation.bytes.data() + kMargin;
    first += (256 - std::bit_cast<std::uintptr_t>(first) % 256) % 256;
    allocations_.emplace(first, std::move(allocation));
    forbid(first - kMargin / 2, kMargin / 2);
    forbid(first + bytes, kMargin / 2);
    used_ += bytes;
    peak_ = std::max(peak_, used_);
    return first;
}

bool DeviceMemory::release(void* pointer)
{
    const auto found = allocations_.find(static_cast<std::byte*>(pointer));
    if (found == allocations_.end()) {
        return false;
    }
    std::byte* const begin = found->first;
    allow(begin - kMargin, found->second.size + 2 * kMargin);
    used_ -= found->second.size;
    allocations_.erase(found);
    return true;
}

void DeviceMemory::forbid(std::byte* begin, std::size_t bytes)
{
    std::fill_n(begin, bytes, kForbidden);
    forbidden_[begin] = bytes;
    poison(begin, bytes);
}

void DeviceMemory::allow(std::byte* begin, std::size_t bytes)
{
    for (auto zone = forbidden_.lower_bound(begin);
         zone != forbidden_.end() && zone->first < begin + bytes;) {
        unpoison(zone->first, zone->second);
        zone = forbidden_.erase(zone);
    }
}

bool DeviceMemory::holds(const void* begin, std::size_t bytes) const
{
    const auto* const first = static_cast<const std::byte*>(begin);
    return std::any_of(allocations_.begin(), allocations_.end(), [&](const auto& entry) {
        return first >= entry.first && first + bytes <= entry.first + entry.second.size;
    });
}

bool DeviceMemory::intact() const
{
    return std::all_of(forbidden_.begin(), forbidden_.end(), [](const auto& zone) {
        unpoison(zone.first, zone.second);
        const bool whole = std::all_of(zone.first, zone.first + zone.second,
                                       [](std::byte b) { return b == kForbidden; });
        poison(zone.first, zone.second);
        return whole;
    });
}

} // namespace hsgm::stand_in
