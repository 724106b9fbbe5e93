#include "pipeline/commands/usage.h"

#include "io/nearest_word.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <vector>

namespace hsgm::pipeline {

namespace {

std::vector<std::string> commands_of(const CLI::App& app)
{
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
        names.push_back(command->get_name());
    }
    return names;
}

// The command that the arguments reached, and how it was called: "hsgm evaluate seams".
struct Reached {
    const CLI::App* app;
    std::string name;
};

Reached reached_by(const CLI::App& app)
{
    Reached reached{&app, "hsgm"};
    for (auto inner = app.get_subcommands(); !inner.empty();
         inner = reached.app->get_subcommands()) {
        reached = {inner.front(), reached.name + " " + inner.front()->get_name()};
    }
    return reached;
}

// What is wrong where a command was due.
std::string about_commands(const Reached& reached, const std::vector<std::string>& given)
{
    const std::vector<std::string> known = commands_of(*reached.app);
    const std::string list = fmt::format("{}", fmt::join(known, ", "));
    if (given.empty()) {
        return fmt::format("{}: a command is missing; there are {}", reached.name, list);
    }
    const std::string nearest = io::nearest_word(given.front(), known);
    return fmt::format("{}: there is no command '{}'; {}", reached.name, given.front(),
                       nearest.empty() ? "there are " + list
                                       : "did you mean '" + nearest + "'?");
}

} // namespace

std::string usage_sentence(const CLI::App& app, const CLI::Error& error)
{
    const Reached reached = reached_by(app);
    const bool needs_command = !commands_of(*reached.app).empty();
    const std::string what =
        needs_command && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr
            ? about_commands(reached, app.remaining(true))
            : fmt::format("{}: {}", reached.name, error.what());
    return fmt::format("{} (see {} --help)", what, reached.name);
}

} // namespace hsgm::pipeline
