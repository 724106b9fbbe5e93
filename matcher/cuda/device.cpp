#include "matcher/cuda/device.h"

#include "matcher/cuda/features.h"
#include "matcher/cuda/tile_matcher.h"

#include <algorithm>

namespace hsgm::matcher::cuda {

namespace {

using tiling::Rect;

constexpr int kLeastCapability = 75;
constexpr int kMostThreads = 384;

// One piece of work for whichever width the penalties need.
template <typename Work>
auto with_cell(const Matcher& matcher, Work work)
{
    return matcher.options().fits_8_bits() ? work(std::uint8_t{}) : work(std::uint16_t{});
}

// Readies a kernel to take as much shared memory as its layout asks for.
template <typename Cell>
void allow_shared_memory(const Matcher& matcher, const DeviceInfo& device)
{
    const LevelPlan& plan = matcher.plan();
    for (int level = 0; level < plan.windowed_levels(); ++level) {
        const int count = plan.ranges[static_cast<std::size_t>(level)].count();
        for (const auto& l : window_launches<Cell>(matcher.options(), device, count)) {
            check(cudaFuncSetAttribute(reinterpret_cast<const void*>(l.kernel.kernel),
                                       cudaFuncAttributeMaxDynamicSharedMemorySize,
                                       static_cast<int>(l.strips.bytes)),
                  "asking for shared memory");
        }
    }
}

} // namespace

Devices find_devices()
{
    Devices devices;
    int count = 0;
    const cudaError_t error = cudaGetDeviceCount(&count);
    if (error != cudaSuccess || count == 0) {
        cudaGetLastError(); // not to be found by the next call
        devices.why_none =
            error == cudaSuccess ? "no CUDA device is here" : cudaGetErrorString(error);
        return devices;
    }
    for (int number = 0; number < count; ++number) {
        cudaDeviceProp properties{};
        std::size_t free = 0;
        std::size_t total = 0;
        if (cudaGetDeviceProperties(&properties, number) != cudaSuccess ||
            cudaSetDevice(number) != cudaSuccess ||
            cudaMemGetInfo(&free, &total) != cudaSuccess) {
            devices.why_none = "CUDA device " + std::to_string(number) +
                               " does not answer: " + cudaGetErrorString(cudaGetLastError());
            continue;
        }
        const int capability = 10 * properties.major + properties.minor;
        if (capability < kLeastCapability) {
            devices.why_none = std::string(properties.name) + " has compute capability " +
                               std::to_string(properties.major) + "." +
                               std::to_string(properties.minor) + ", and 7.5 is the least";
            continue;
        }
        devices.usable.push_back({number, properties.name, capability,
                                  static_cast<std::int64_t>(total),
                                  static_cast<std::int64_t>(free),
                                  static_cast<std::int64_t>(properties.sharedMemPerBlockOptin),
                                  properties.multiProcessorCount, kMostThreads});
    }
    if (!devices.usable.empty()) {
        devices.why_none.clear();
    }
    return devices;
}

std::string refusal(const Matcher& matcher, const DeviceInfo&)
{
    return matcher.plan().windowed_levels() > 0
               ? ""
               : "a match in one piece (mode sgm, or one level) is left to the processor";
}

std::int64_t shared_bytes(const Matcher& matcher)
{
    Arena arena;
    with_cell(matcher, [&](auto cell) {
        lay_out_shared<decltype(cell)>(arena, matcher);
        return 0;
    });
    return static_cast<std::int64_t>(arena.used());
}

std::int64_t worker_bytes(const Matcher& matcher, const DeviceInfo& device,
                          std::span<const Rect> cores)
{
    std::int64_t most = 0;
    for (const Rect& core : cores) {
        Arena arena;
        with_cell(matcher, [&](auto cell) {
            lay_out_tile<decltype(cell)>(arena, matcher, device, core);
            return 0;
        });
        most = std::max(most, static_cast<std::int64_t>(arena.used()));
    }
    return most;
}

std::int64_t pinned_bytes(const Matcher& matcher, std::span<const Rect> cores)
{
    std::int64_t up = 0;
    std::int64_t down = 0;
    for (const Rect& core : cores) {
        up = std::max(up, upload_bytes(matcher, core));
        down = std::max(down, download_bytes(matcher, core));
    }
    return up + down;
}

std::shared_ptr<const DeviceCoarse>
upload_coarse(const Matcher& matcher, const CoarseSolution& coarse, const DeviceInfo& device)
{
    check(cudaSetDevice(device.number), "choosing the device");
    return with_cell(matcher, [&](auto cell) -> std::shared_ptr<const DeviceCoarse> {
        return std::make_shared<CoarseOnDevice<decltype(cell)>>(matcher, coarse, device);
    });
}

std::unique_ptr<DeviceMatcher> make_device_matcher(const Matcher& matcher,
                                                   std::shared_ptr<const DeviceCoarse> coarse,
                                                   const DeviceInfo& device,
                                                   std::span<const Rect> cores)
{
    check(cudaSetDevice(device.number), "choosing the device");
    return with_cell(matcher, [&](auto cell) -> std::unique_ptr<DeviceMatcher> {
        using Cell = decltype(cell);
        allow_shared_memory<Cell>(matcher, device);
        return std::make_unique<TileMatcher<Cell>>(
            matcher, std::dynamic_pointer_cast<const CoarseOnDevice<Cell>>(coarse), device,
            cores);
    });
}

} // namespace hsgm::matcher::cuda
