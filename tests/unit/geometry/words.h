#pragma once

#include "tests/catch.h"

#include <string>

namespace hsgm::geometry::samples {

/// Whether a message says what it should; shows both where it does not.
inline bool says(const std::string& message, const std::string& part)
{
    CAPTURE(message, part);
    CHECK(message.find(part) != std::string::npos);
    return message.find(part) != std::string::npos;
}

} // namespace hsgm::geometry::samples
