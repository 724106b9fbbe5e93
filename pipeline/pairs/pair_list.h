#pragma once

#include "io/config.h"
#include "pipeline/commands/knobs.h"
#include "pipeline/configuration.h"

#include <filesystem>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// One pair of a set, with the complete configuration of its run.
struct ListedPair {
    std::string name; ///< LEFT-RIGHT, by the names of its images
    std::filesystem::path folder;
    Configuration configuration;
};

/// Several pairs of one area that become one DSM.
struct PairList {
    std::filesystem::path folder;
    std::vector<ListedPair> pairs;     ///< in the order of their names
    std::vector<std::string> left_out; ///< "A-B: why", of pairs chosen by geometry
    Configuration of_all;              ///< of the first pair, with the outputs of the whole
};

/// Whether a configuration is one of several pairs: it has `images`.
bool has_several_pairs(const io::ConfigDocument& document);

/// Reads the configuration of several pairs: `images`, a name for each image, and `pairs`, a
/// list of {left: NAME, right: NAME}; where that is missing, all that `choose_pairs` takes.
/// Everything else is as for one pair, and the same for all: where map and cells are left to
/// the program, they are those of the first pair in the order of names. `knobs` as given on the
/// command line. Throws ConfigError naming the key; InputError where no two images make a pair.
PairList read_pair_list(const std::filesystem::path& config, const Knobs& knobs,
                        const std::string& output);

} // namespace hsgm::pipeline
