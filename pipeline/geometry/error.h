#pragma once

#include <stdexcept>

namespace hsgm::geometry {

/// Images and cameras that cannot make a pair: what is wrong with the data, in a sentence.
class GeometryError : public std::runtime_error {
    using runtime_error::runtime_error;
};

} // namespace hsgm::geometry
