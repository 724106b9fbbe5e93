#include "pipeline/device_plan.h"

#include "pipeline/error.h"
#include "tiling/tile_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace hsgm::pipeline {

namespace {

namespace cuda = matcher::cuda;

/// Two streams a device: one computes while the other copies.
constexpr int kMostStreams = 2;
/// The driver and other programs take a little, too.
constexpr double kUsableShare = 0.9;

std::int64_t mebi(std::int64_t bytes)
{
    return (bytes + (1 << 20) - 1) >> 20;
}

// One device with as many streams as fit; 0 streams, and why, where none does.
PlannedDevice plan_device(const cuda::DeviceInfo& info, const matcher::Matcher& matcher,
                          std::span<const tiling::Rect> cores, std::string& why)
{
    PlannedDevice device{info, 0, 0};
    why = cuda::refusal(matcher, info);
    if (!why.empty()) {
        return device;
    }
    const std::int64_t shared = cuda::shared_bytes(matcher);
    const std::int64_t each = cuda::worker_bytes(matcher, info, cores);
    const auto usable =
        static_cast<std::int64_t>(kUsableShare * static_cast<double>(info.free_bytes));
    const auto tiles = static_cast<std::int64_t>(cores.size());
    const std::int64_t fitting = std::max<std::int64_t>((usable - shared) / each, 0);
    device.streams = static_cast<int>(std::min({fitting, tiles, std::int64_t{kMostStreams}}));
    device.bytes = shared + device.streams * each;
    if (device.streams == 0) {
        why = fmt::format("a tile of {} x {} px takes {} MiB on {}, which has {} MiB free",
                          cores.front().cols, cores.front().rows, mebi(shared + each),
                          info.name, mebi(info.free_bytes));
    }
    return device;
}

// Host memory for the tiles that devices keep in flight beside the others.
std::int64_t host_bytes(const DevicePlan& plan, const matcher::Matcher& matcher,
                        std::span<const tiling::Rect> cores, const Budget& budget)
{
    const std::int64_t pinned = cuda::pinned_bytes(matcher, cores);
    return plan.streams() * (pinned + matcher.tile_bytes(budget.tile_size_px, 0));
}

} // namespace

DeviceChoice device_choice(const std::string& text)
{
    if (text == "auto") {
        return {};
    }
    if (text == "cpu") {
        return {DeviceChoice::Kind::cpu};
    }
    if (text == "cuda") {
        return {DeviceChoice::Kind::cuda};
    }
    constexpr std::string_view kPrefix = "cuda:";
    int number = -1;
    if (text.starts_with(kPrefix)) {
        const char* const end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data() + kPrefix.size(), end, number);
        if (error == std::errc() && stop == end && number >= 0) {
            return {DeviceChoice::Kind::cuda, number};
        }
    }
    throw std::invalid_argument("it must be auto, cpu, cuda or cuda:N");
}

matcher::cuda::Devices chosen_devices(const DeviceChoice& choice, const std::string& what)
{
    if (choice.kind == DeviceChoice::Kind::cpu) {
        return {};
    }
    cuda::Devices devices = cuda::find_devices();
    if (choice.kind == DeviceChoice::Kind::automatic) {
        return devices;
    }
    if (devices.usable.empty()) {
        throw BudgetError(fmt::format("{}, but no CUDA device can be used: {}; use auto or cpu",
                                      what, devices.why_none));
    }
    if (choice.number >= 0) {
        const std::size_t count = devices.usable.size();
        std::erase_if(devices.usable,
                      [&](const cuda::DeviceInfo& d) { return d.number != choice.number; });
        if (devices.usable.empty()) {
            throw BudgetError(
                fmt::format("{}, but the CUDA devices here count from 0 and there "
                            "{} {}; hsgm info lists them",
                            what, count == 1 ? "is" : "are", count));
        }
    }
    return devices;
}

int DevicePlan::streams() const
{
    int sum = 0;
    for (const PlannedDevice& device : cuda) {
        sum += device.streams;
    }
    return sum;
}

std::string DevicePlan::text() const
{
    std::string result = cpu ? "cpu" : "";
    for (const PlannedDevice& device : cuda) {
        result += fmt::format("{}cuda:{} ({}, {} stream{}, {} MiB)", result.empty() ? "" : ", ",
                              device.info.number, device.info.name, device.streams,
                              device.streams == 1 ? "" : "s", mebi(device.bytes));
    }
    return result;
}

DevicePlan plan_devices(const DeviceChoice& choice, const matcher::Matcher& matcher,
                        Budget& budget)
{
    DevicePlan plan;
    const bool asked = choice.kind == DeviceChoice::Kind::cuda;
    const cuda::Devices devices = chosen_devices(choice, "a CUDA device is asked for");
    plan.note = devices.usable.empty() && devices.built ? devices.why_none : "";
    const auto cores =
        devices.usable.empty() ? std::vector<tiling::Rect>{} : tile_cores(matcher, budget);
    for (const cuda::DeviceInfo& info : devices.usable) {
        std::string why;
        const PlannedDevice device = plan_device(info, matcher, cores, why);
        if (device.streams > 0) {
            plan.cuda.push_back(device);
        } else {
            plan.note = why;
        }
    }
    if (plan.cuda.empty()) {
        if (asked) {
            throw BudgetError(
                fmt::format("a CUDA device is asked for, but {}; use auto or cpu", plan.note));
        }
        return plan;
    }
    const std::int64_t bytes = host_bytes(plan, matcher, cores, budget);
    if (budget.tiles_bytes + bytes > budget.memory_bytes) {
        const std::string why =
            fmt::format("its tiles take {} MiB of host memory more, and {} MiB are allowed",
                        mebi(bytes), mebi(budget.memory_bytes));
        if (asked) {
            throw BudgetError(fmt::format("a CUDA device is asked for, but {}: allow more with "
                                          "--memory, or choose smaller tiles",
                                          why));
        }
        plan.cuda.clear();
        plan.note = why;
        return plan;
    }
    plan.cpu = !asked;
    budget.tiles_bytes += bytes;
    budget.estimate_bytes = std::max(budget.estimate_bytes, budget.tiles_bytes);
    budget.workers = (plan.cpu ? budget.workers : 0) + plan.streams();
    budget.tiles_in_flight = std::min(budget.tiles, budget.tiles_in_flight + plan.streams());
    return plan;
}

std::vector<tiling::Rect> tile_cores(const matcher::Matcher& matcher, const Budget& budget)
{
    const tiling::TilePlan tiles(matcher.pair().shape.left, budget.tile_size_px);
    std::vector<tiling::Rect> cores;
    for (int i = 0; i < tiles.count(); ++i) {
        cores.push_back(tiles.core(i));
    }
    return cores;
}

} // namespace hsgm::pipeline
