#pragma once

#include "pipeline/stages/run_manner.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// A run as a chain of Slurm jobs: the coarse stage, an array of shards, the assembly.
struct SlurmChain {
    std::string program = "hsgm"; ///< as the nodes find it
    std::string config;
    std::string results;                 ///< a folder that all nodes see
    std::vector<std::string> words;      ///< more of the command line: --set, --tile-size, ...
    std::vector<std::string> directives; ///< more options of sbatch: --partition=long, ...
    int shards = 8;
    int threads = 4;
    std::int64_t memory_mib = 4096;
};

/// The batch script of a stage (coarse, tiles or assemble). All may be filed again at any time:
/// they resume.
std::string slurm_script(const SlurmChain& chain, RunStage stage);

/// Numbers that Slurm gave the jobs of a chain.
struct FiledChain {
    std::string coarse;
    std::string tiles;
    std::string assemble;
};

/// Writes the scripts into results/slurm.
void write_slurm_scripts(const SlurmChain& chain);

/// Files the written scripts with sbatch: the array once the coarse stage is done, the assembly
/// once all of the array has ended, however that was. Throws StorageError with Slurm's words
/// where it refuses.
FiledChain file_slurm_chain(const SlurmChain& chain);

} // namespace hsgm::pipeline
