#pragma once

#include "tiling/shard.h"

#include <optional>
#include <string>

namespace hsgm::pipeline {

/// What `--shard` says: "3/7", counted from 0; "auto" takes index and count from the job array
/// of Slurm, "auto/7" the index from Slurm or from an indexed job of Kubernetes; nothing for an
/// empty text. Throws ConfigError.
std::optional<tiling::Shard> shard_from(const std::string& text);

/// Whether the engine has started this job again after it was lost.
bool is_requeued();

} // namespace hsgm::pipeline
