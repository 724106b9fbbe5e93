#pragma once

#include <CLI/App.hpp>

#include <string>

namespace hsgm::pipeline {

/// What is wrong with a command line, in one sentence that says where to read on.
std::string usage_sentence(const CLI::App& app, const CLI::Error& error);

} // namespace hsgm::pipeline
