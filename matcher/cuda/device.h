#pragma once

#include "matcher/matcher.h"

#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

// Matching on CUDA devices, with the same bits as matcher/host. This header is plain C++: a
// build without CUDA has it too, and finds no device.
namespace hsgm::matcher::cuda {

/// A device failed at something that another worker may well do.
class DeviceError : public std::runtime_error {
public:
    DeviceError(const std::string& what, bool lost) : std::runtime_error(what), lost_(lost) {}
    /// Whether the device is of no further use to this process.
    bool lost() const { return lost_; }

private:
    bool lost_;
};

struct DeviceInfo {
    int number = 0;
    std::string name;
    int capability = 0; ///< 75, 80, ...
    std::int64_t memory_bytes = 0;
    std::int64_t free_bytes = 0;
    std::int64_t shared_bytes = 0; ///< that a block may have
    int multiprocessors = 0;
    int block_threads = 384; ///< a multiple of 32 up to this; has no influence on results
};

/// The devices that this build and this machine can use.
struct Devices {
    std::vector<DeviceInfo> usable;
    std::string why_none; ///< one clause, where there is none; else empty
    bool built = true;    ///< whether this build could use any
};

/// Looks for devices. Never throws: whatever goes wrong means that there is none.
Devices find_devices();

/// Why the tiles of this match cannot be solved on such a device; empty if they can.
std::string refusal(const Matcher& matcher, const DeviceInfo& device);

/// Device memory for what all workers of a device share, and for one worker that matches
/// tiles with these cores, in bytes: neither is ever exceeded.
std::int64_t shared_bytes(const Matcher& matcher);
std::int64_t worker_bytes(const Matcher& matcher, const DeviceInfo& device,
                          std::span<const tiling::Rect> cores);
/// Host memory of a worker: pinned buffers for what goes up and comes down.
std::int64_t pinned_bytes(const Matcher& matcher, std::span<const tiling::Rect> cores);

/// The coarsest level on a device, for all its workers. Throws DeviceError.
class DeviceCoarse {
public:
    DeviceCoarse() = default;
    DeviceCoarse(const DeviceCoarse&) = delete;
    DeviceCoarse& operator=(const DeviceCoarse&) = delete;
    virtual ~DeviceCoarse() = default;
};
std::shared_ptr<const DeviceCoarse>
upload_coarse(const Matcher& matcher, const CoarseSolution& coarse, const DeviceInfo& device);

/// One stream of a device, with memory for the largest of the tiles it was made for. Serves
/// one tile at a time, from any thread.
class DeviceMatcher {
public:
    DeviceMatcher() = default;
    DeviceMatcher(const DeviceMatcher&) = delete;
    DeviceMatcher& operator=(const DeviceMatcher&) = delete;
    virtual ~DeviceMatcher() = default;

    /// As Matcher::match_tile; returns when the result is there. Throws DeviceError.
    virtual TileMatch match_tile(const tiling::Rect& core,
                                 std::span<const LevelImages> images) = 0;
};

/// Takes `worker_bytes` of device memory, and `pinned_bytes` of the host's, at once. `matcher`
/// must outlive it. Throws DeviceError.
std::unique_ptr<DeviceMatcher> make_device_matcher(const Matcher& matcher,
                                                   std::shared_ptr<const DeviceCoarse> coarse,
                                                   const DeviceInfo& device,
                                                   std::span<const tiling::Rect> cores);

} // namespace hsgm::matcher::cuda
