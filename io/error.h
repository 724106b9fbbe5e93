#pragma once

#include <stdexcept>

namespace hsgm::io {

/// A configuration, or a command line, that asks for something impossible. Exit code 2.
class ConfigError : public std::runtime_error {
    using runtime_error::runtime_error;
};

/// Input data that is missing, unreadable or unusable. Exit code 3.
class InputError : public std::runtime_error {
    using runtime_error::runtime_error;
};

/// An output or scratch place that is not writable or full. Exit code 6.
class StorageError : public std::runtime_error {
    using runtime_error::runtime_error;
};

} // namespace hsgm::io
