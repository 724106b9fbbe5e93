#include "io/config.h"
#include "io/config_state.h"
#include "io/error.h"
#include "io/nearest_word.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>

namespace hsgm::io {

namespace {

std::string joined(const std::string& section, const std::string& key)
{
    return section.empty() ? key : section + "." + key;
}

/// The full name of a key called `key` in any section that was read; empty where none is.
std::string find_elsewhere(const ConfigNode& effective, const std::string& name,
                           const std::string& key)
{
    if (std::find(effective.known.begin(), effective.known.end(), key) !=
        effective.known.end()) {
        return joined(name, key);
    }
    for (const ConfigNode::Entry& entry : effective.entries) {
        const std::string found = find_elsewhere(*entry.value, joined(name, entry.key), key);
        if (!found.empty()) {
            return found;
        }
    }
    return "";
}

std::string list_of(const std::vector<std::string>& words)
{
    std::string text;
    for (const std::string& word : words) {
        text += (text.empty() ? "" : ", ") + word;
    }
    return text;
}

class UnknownKeys {
public:
    explicit UnknownKeys(const ConfigNode& root) : root_(root) {}

    /// Walks what was given beside what was asked for.
    void refuse(const ConfigNode& given, const ConfigNode& effective,
                const std::string& name) const
    {
        for (const ConfigNode::Entry& entry : given.entries) {
            const auto& known = effective.known;
            if (std::find(known.begin(), known.end(), entry.key) == known.end()) {
                throw ConfigError(entry.place + ": unknown key '" + joined(name, entry.key) +
                                  "'; " + advice(entry.key, effective));
            }
            if (const ConfigNode* asked = effective.find(entry.key)) {
                refuse(*entry.value, *asked, joined(name, entry.key));
            }
        }
        const std::size_t items = std::min(given.items.size(), effective.items.size());
        for (std::size_t i = 0; i < items; ++i) {
            if (effective.items[i]->kind == ConfigNode::Kind::map) {
                refuse(*given.items[i], *effective.items[i], joined(name, std::to_string(i)));
            }
        }
    }

private:
    std::string advice(const std::string& key, const ConfigNode& effective) const
    {
        const std::string nearest = nearest_word(key, effective.known);
        const std::string suggestion =
            nearest.empty() ? find_elsewhere(root_, "", key) : nearest;
        if (!suggestion.empty()) {
            return "did you mean '" + suggestion + "'?";
        }
        return "known here: " + list_of(effective.known) + ".";
    }

    const ConfigNode& root_;
};

std::vector<std::string> split_path(const std::string& dotted)
{
    std::vector<std::string> parts;
    std::stringstream stream(dotted + ".");
    for (std::string part; std::getline(stream, part, '.');) {
        if (part.empty()) {
            throw ConfigError("--set " + dotted + ": write KEY=VALUE with a key like " +
                              "matcher.cost.");
        }
        parts.push_back(part);
    }
    return parts;
}

/// One step of a dotted path: into a map (made where nothing is yet) or a list's item.
ConfigNode& step_into(ConfigNode& node, const std::string& part, const std::string& place)
{
    if (node.kind == ConfigNode::Kind::null) {
        node.kind = ConfigNode::Kind::map;
    }
    if (node.kind == ConfigNode::Kind::map) {
        const bool is_new = node.find(part) == nullptr;
        ConfigNode& child = node.at(part);
        if (is_new) {
            child.place = place;
            node.entries.back().place = place;
        }
        return child;
    }
    std::size_t index = 0;
    const auto parsed = std::from_chars(part.data(), part.data() + part.size(), index);
    if (node.kind == ConfigNode::Kind::list && parsed.ptr == part.data() + part.size() &&
        index < node.items.size()) {
        return *node.items[index];
    }
    throw ConfigError(place + ": '" + part + "' leads nowhere, because what holds it is " +
                      describe(node) + " in " + node.place + ".");
}

void list_values(const ConfigNode& node, const std::string& name,
                 std::vector<ConfigValue>& values)
{
    const std::string prefix = name.empty() ? "" : name + ".";
    for (const ConfigNode::Entry& entry : node.entries) {
        list_values(*entry.value, prefix + entry.key, values);
    }
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        list_values(*node.items[i], prefix + std::to_string(i), values);
    }
    if (node.kind == ConfigNode::Kind::scalar) {
        values.push_back({name, node.text, node.is_file, node.is_image});
    }
}

} // namespace

ConfigDocument::ConfigDocument(std::shared_ptr<ConfigState> state) : state_(std::move(state)) {}

ConfigDocument ConfigDocument::load(const std::filesystem::path& path)
{
    if (!std::filesystem::exists(path)) {
        throw ConfigError("There is no configuration file " + path.string() + ".");
    }
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    if (!file || std::filesystem::is_directory(path)) {
        throw ConfigError("The configuration " + path.string() + " cannot be read as a file.");
    }
    const std::filesystem::path folder = path.parent_path();
    return parse(text.str(), path.string(), folder.empty() ? "." : folder);
}

ConfigDocument ConfigDocument::parse(const std::string& text, const std::string& name,
                                     const std::filesystem::path& folder)
{
    auto state = std::make_shared<ConfigState>();
    state->name = name;
    state->folder = folder;
    state->given = parse_yaml(text, name, true);
    state->effective.kind = ConfigNode::Kind::map;
    if (state->given->kind != ConfigNode::Kind::map) {
        throw ConfigError(state->given->place + ": the configuration is " +
                          describe(*state->given) + "; it must be a map of keys and values.");
    }
    return ConfigDocument(std::move(state));
}

ConfigDocument ConfigDocument::empty(const std::string& name)
{
    return parse("{}", name);
}

void ConfigDocument::set(const std::string& dotted, const std::string& yaml_value)
{
    const std::string place = "--set " + dotted;
    ConfigNode* node = state_->given.get();
    for (const std::string& part : split_path(dotted)) {
        node = &step_into(*node, part, place);
    }
    // In place, because sections and lists point at the node.
    *node = std::move(*parse_yaml(yaml_value, place, false));
}

void ConfigDocument::set(const std::string& assignment)
{
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) {
        throw ConfigError("--set " + assignment + ": write KEY=VALUE, for example " +
                          "matcher.cost=census7x7.");
    }
    set(assignment.substr(0, equals), assignment.substr(equals + 1));
}

bool ConfigDocument::is_scalar(const std::string& dotted) const
{
    const ConfigNode* node = state_->given.get();
    for (const std::string& part : split_path(dotted)) {
        node = node == nullptr ? nullptr : node->find(part);
    }
    return node != nullptr && node->kind == ConfigNode::Kind::scalar;
}

ConfigSection ConfigDocument::root()
{
    return ConfigSection(state_, state_->given.get(), &state_->effective, "");
}

void ConfigDocument::refuse_unknown() const
{
    UnknownKeys(state_->effective).refuse(*state_->given, state_->effective, "");
}

std::string ConfigDocument::effective_yaml() const
{
    return to_yaml(state_->effective);
}

std::vector<ConfigValue> ConfigDocument::effective_values() const
{
    std::vector<ConfigValue> values;
    list_values(state_->effective, "", values);
    return values;
}

const std::filesystem::path& ConfigDocument::folder() const
{
    return state_->folder;
}

} // namespace hsgm::io
