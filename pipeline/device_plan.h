#pragma once

#include "matcher/cuda/device.h"
#include "pipeline/budget.h"

#include <string>
#include <vector>

namespace hsgm::pipeline {

/// What `run.device` asks for.
struct DeviceChoice {
    enum class Kind { automatic, cpu, cuda } kind = Kind::automatic;
    int number = -1; ///< of the CUDA device; -1: all there are
};

/// "auto", "cpu", "cuda" or "cuda:N"; throws std::invalid_argument saying so.
DeviceChoice device_choice(const std::string& text);

/// The devices of a choice. Where CUDA is asked for and not to be had, throws BudgetError with
/// the reason; `what` names the key, with its place.
matcher::cuda::Devices chosen_devices(const DeviceChoice& choice, const std::string& what);

/// A CUDA device that takes part in a run.
struct PlannedDevice {
    matcher::cuda::DeviceInfo info;
    int streams = 1;
    std::int64_t bytes = 0; ///< of device memory, for all of it
};

/// Who matches the tiles of a run.
struct DevicePlan {
    bool cpu = true;
    std::vector<PlannedDevice> cuda;
    std::string note; ///< why CUDA devices are left out; empty if none is, or none was wanted

    int streams() const;
    /// "cpu", "cuda:0 (NAME, 2 streams, 812 MiB)", or both.
    std::string text() const;
};

/// Chooses devices and streams that fit the device memory, and adds their part to the budget.
/// Nothing here changes a result. Throws BudgetError where CUDA was asked for and does not
/// fit, or cannot do what was asked.
DevicePlan plan_devices(const DeviceChoice& choice, const matcher::Matcher& matcher,
                        Budget& budget);

/// The tiles of a budget, as the workers are prepared for them.
std::vector<tiling::Rect> tile_cores(const matcher::Matcher& matcher, const Budget& budget);

} // namespace hsgm::pipeline
