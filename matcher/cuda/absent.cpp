#include "matcher/cuda/device.h"

// A build without CUDA.
namespace hsgm::matcher::cuda {

namespace {

constexpr const char* kAbsent = "this build has no CUDA worker";

} // namespace

Devices find_devices()
{
    return {{}, kAbsent, false};
}

std::string refusal(const Matcher&, const DeviceInfo&)
{
    return kAbsent;
}

std::int64_t shared_bytes(const Matcher&)
{
    return 0;
}

std::int64_t worker_bytes(const Matcher&, const DeviceInfo&, std::span<const tiling::Rect>)
{
    return 0;
}

std::int64_t pinned_bytes(const Matcher&, std::span<const tiling::Rect>)
{
    return 0;
}

std::shared_ptr<const DeviceCoarse> upload_coarse(const Matcher&, const CoarseSolution&,
                                                  const DeviceInfo&)
{
    throw DeviceError(kAbsent, true);
}

std::unique_ptr<DeviceMatcher> make_device_matcher(const Matcher&,
                                                   std::shared_ptr<const DeviceCoarse>,
                                                   const DeviceInfo&,
                                                   std::span<const tiling::Rect>)
{
    throw DeviceError(kAbsent, true);
}

} // namespace hsgm::matcher::cuda
