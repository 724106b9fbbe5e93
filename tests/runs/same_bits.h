#pragma once

#include "tests/end_to_end/pairs.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace hsgm::tests {

/// SHA-256 of every raster and picture of a run, by name.
using Sums = std::map<std::string, std::string>;

/// A configuration whose runs, however they are carried out, must come to the same files and
/// stay under their memory. Every process is watched as /usr/bin/time does, and prints a line.
class SameBits {
public:
    /// A town of configs/scene-city.yaml in this size, matched with this range: a rectified
    /// pair with heights, shading and pictures.
    SameBits(const std::string& size, const std::string& range);
    /// Two raw images of configs/scene-orbit.yaml that show a map of this size.
    explicit SameBits(const std::string& map_size);

    /// A run in one process.
    void run(const std::vector<std::string>& words);
    /// Coarse stage, each shard, assembly, as processes of their own.
    void run_in_shards(int count, const std::vector<std::string>& words = {});
    /// What does not fit is refused with exit code 4, and leaves nothing behind.
    void refused(const std::vector<std::string>& words);

    /// Tile size that the budget of these words chooses.
    int tile_size(const std::vector<std::string>& words) const;

private:
    nlohmann::json plan(std::vector<std::string> words) const;
    void process(const std::string& name, const std::vector<std::string>& words,
                 std::int64_t bound_bytes);
    void compare(const std::string& name);
    std::vector<std::string> command(const std::string& verb,
                                     const std::vector<std::string>& words) const;

    TemporaryFolder folder_;
    Sums first_;
};

} // namespace hsgm::tests
