#pragma once

#include <stdexcept>
#include <string>

namespace hsgm::reference {

/// What the specification promises; checked in every build, since the twin is there to check.
inline void ensure(bool holds, const char* promise)
{
    if (!holds) {
        throw std::logic_error(std::string("broken promise: ") + promise);
    }
}

} // namespace hsgm::reference
