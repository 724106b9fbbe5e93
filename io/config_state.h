#pragma once

// Private to this folder: what a ConfigDocument and its sections share.

#include "io/config_node.h"

#include <filesystem>
#include <memory>
#include <string>

namespace hsgm::io {

struct ConfigState {
    std::string name;
    std::filesystem::path folder;
    std::unique_ptr<ConfigNode> given;
    ConfigNode effective;
};

} // namespace hsgm::io
