#pragma once

#include "tests/reference/agreement.h"

#include <cstdint>

namespace hsgm::cuda_test {

/// Checks that device and host give the same bits for so many cases, with seeds first.. of a
/// theme, that a device can do; sanitizers, for a small part of them. HSGM_REFERENCE_CASES sets
/// another number of cases, HSGM_REFERENCE_SEED repeats the one that a failure named.
void compare_with_device(const reference::Theme& theme, std::uint64_t first, int cases);

} // namespace hsgm::cuda_test
