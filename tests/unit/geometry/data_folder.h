#pragma once

#include "tests/catch.h"

#include <cstdlib>
#include <filesystem>
#include <string>

namespace hsgm::geometry::samples {

/// Environment variable HSGM_DATA_DIR, or the folder beside the sources.
inline std::string data_folder()
{
    const char* named = std::getenv("HSGM_DATA_DIR");
    return named != nullptr ? named : HSGM_DEFAULT_DATA_DIR;
}

/// False, and said so, where a scene of the data folder is missing.
inline bool has_data(const std::string& scene)
{
    if (std::filesystem::exists(data_folder() + "/" + scene)) {
        return true;
    }
    WARN("SKIPPED: no test data in " + data_folder() + "/" + scene + "; see HSGM_DATA_DIR");
    return false;
}

} // namespace hsgm::geometry::samples
