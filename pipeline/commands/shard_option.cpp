#include "pipeline/commands/shard_option.h"

#include "io/error.h"

#include <charconv>
#include <cstdlib>

namespace hsgm::pipeline {

namespace {

std::optional<int> number(const std::string& text)
{
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    return whole && !text.empty() ? std::optional(value) : std::nullopt;
}

std::optional<int> environment(const char* name)
{
    const char* value = std::getenv(name);
    return value == nullptr ? std::nullopt : number(value);
}

int index_from_environment()
{
    if (const auto slurm = environment("SLURM_ARRAY_TASK_ID")) {
        return *slurm;
    }
    if (const auto kubernetes = environment("JOB_COMPLETION_INDEX")) {
        return *kubernetes;
    }
    throw io::ConfigError("--shard auto finds neither SLURM_ARRAY_TASK_ID nor "
                          "JOB_COMPLETION_INDEX in the environment; give --shard I/N");
}

int count_from_environment()
{
    if (const auto count = environment("SLURM_ARRAY_TASK_COUNT")) {
        return *count;
    }
    throw io::ConfigError(
        "--shard auto finds no SLURM_ARRAY_TASK_COUNT in the environment; say "
        "of how many: --shard auto/N");
}

} // namespace

std::optional<tiling::Shard> shard_from(const std::string& text)
{
    if (text.empty()) {
        return std::nullopt;
    }
    const auto slash = text.find('/');
    const std::string first = text.substr(0, slash);
    const auto count =
        slash == std::string::npos ? std::nullopt : number(text.substr(slash + 1));
    const auto index = first == "auto" ? std::nullopt : number(first);
    const bool has_count = slash != std::string::npos;
    if ((first != "auto" && !index) || (has_count && !count) || (index && !has_count)) {
        throw io::ConfigError("--shard must be I/N, auto or auto/N, for example 0/4, not '" +
                              text + "'");
    }
    const tiling::Shard shard{index ? *index : index_from_environment(),
                              count ? *count : count_from_environment()};
    if (shard.count < 1 || shard.index < 0 || shard.index >= shard.count) {
        throw io::ConfigError("--shard " + text + " asks for shard " +
                              std::to_string(shard.index) + " of " +
                              std::to_string(shard.count) + "; they count from 0 to N - 1");
    }
    return shard;
}

bool is_requeued()
{
    return environment("SLURM_RESTART_COUNT").value_or(0) > 0;
}

} // namespace hsgm::pipeline
