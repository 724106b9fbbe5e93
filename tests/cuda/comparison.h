#pragma once

#include "matcher/cuda/device.h"
#include "tests/device_stand_in/control.h"
#include "tests/reference/agreement.h"

#include <string>
#include <vector>

// The CUDA matcher on the stand-in beside matcher/host: the same bits.
namespace hsgm::cuda_test {

/// How the stand-in is set up for a case.
struct Setting {
    stand_in::Schedule schedule;
    int block_threads = 64;
    std::int64_t shared_bytes = 227 * 1024;
    int multiprocessors = 2;
};

/// A pair with its pyramids, ready to be matched by either.
class Pair {
public:
    Pair(const reference::Case& c);

    const matcher::Matcher& matcher() const { return matcher_; }
    const matcher::CoarseSolution& coarse() const { return *coarse_; }
    std::vector<matcher::LevelImages> images(const tiling::Rect& core) const;

private:
    matcher::Matcher matcher_;
    std::vector<tiling::Image<std::uint16_t>> left_;
    std::vector<tiling::Image<std::uint16_t>> right_;
    std::shared_ptr<const matcher::CoarseSolution> coarse_;
};

/// The device of a setting.
matcher::cuda::DeviceInfo device_of(const Setting& setting);

/// Something different for each number: all schedules, block sizes and sizes of shared memory.
Setting setting_number(std::uint64_t number);

/// What became of a case.
struct Outcome {
    bool refused = false;   ///< the device cannot do it
    std::string difference; ///< empty where all tiles have the same bits
};
Outcome compare_tiles(const reference::Case& c, const Setting& setting);

/// Empty where both are the same; else what differs first.
std::string difference(const matcher::TileMatch& host, const matcher::TileMatch& device);

} // namespace hsgm::cuda_test
