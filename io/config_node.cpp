#include "io/config_node.h"

#include "io/error.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <utility>

namespace hsgm::io {

namespace {

/// Deeper than any configuration; an alias inside its own anchor would never end.
constexpr int kDeepest = 32;

struct Place {
    const std::string& name;
    bool numbered;

    std::string of(const YAML::Mark& mark) const
    {
        // yaml-cpp counts from 0, editors from 1.
        return !numbered || mark.is_null() ? name
                                           : name + ":" + std::to_string(mark.line + 1) + ":" +
                                                 std::to_string(mark.column + 1);
    }
};

std::unique_ptr<ConfigNode> convert(const YAML::Node& yaml, const Place& place, int depth);

void convert_map(const YAML::Node& yaml, const Place& place, int depth, ConfigNode& node)
{
    for (const auto& pair : yaml) {
        const std::string where = place.of(pair.first.Mark());
        if (!pair.first.IsScalar()) {
            throw ConfigError(where + ": a key must be a plain word.");
        }
        const std::string key = pair.first.Scalar();
        if (node.find(key) != nullptr) {
            throw ConfigError(where + ": the key '" + key + "' comes twice; keep one.");
        }
        node.entries.push_back({key, where, convert(pair.second, place, depth + 1)});
        if (pair.second.IsNull()) {
            node.entries.back().value->place = where; // nothing has no place, its key has
        }
    }
}

std::unique_ptr<ConfigNode> convert(const YAML::Node& yaml, const Place& place, int depth)
{
    auto node = std::make_unique<ConfigNode>();
    node->place = place.of(yaml.Mark());
    if (depth > kDeepest) {
        throw ConfigError(node->place + ": more than " + std::to_string(kDeepest) +
                          " levels inside each other.");
    }
    if (yaml.IsScalar()) {
        node->kind = ConfigNode::Kind::scalar;
        node->text = yaml.Scalar();
    } else if (yaml.IsSequence()) {
        node->kind = ConfigNode::Kind::list;
        for (const YAML::Node& item : yaml) {
            node->items.push_back(convert(item, place, depth + 1));
        }
    } else if (yaml.IsMap()) {
        node->kind = ConfigNode::Kind::map;
        convert_map(yaml, place, depth, *node);
    }
    return node;
}

bool only_scalars(const ConfigNode& node)
{
    return std::all_of(node.items.begin(), node.items.end(),
                       [](const auto& item) { return item->kind == ConfigNode::Kind::scalar; });
}

void emit(YAML::Emitter& out, const ConfigNode& node)
{
    switch (node.kind) {
    case ConfigNode::Kind::null:
        out << YAML::Null;
        break;
    case ConfigNode::Kind::scalar:
        out << node.text;
        break;
    case ConfigNode::Kind::list:
        if (only_scalars(node)) {
            out << YAML::Flow;
        }
        out << YAML::BeginSeq;
        for (const auto& item : node.items) {
            emit(out, *item);
        }
        out << YAML::EndSeq;
        break;
    case ConfigNode::Kind::map:
        out << YAML::BeginMap;
        for (const ConfigNode::Entry& entry : node.entries) {
            out << YAML::Key << entry.key << YAML::Value;
            emit(out, *entry.value);
        }
        out << YAML::EndMap;
        break;
    }
    if (!node.default_text.empty()) {
        out << YAML::Comment("default: " + node.default_text);
    }
}

} // namespace

std::unique_ptr<ConfigNode> ConfigNode::scalar(std::string text)
{
    auto node = std::make_unique<ConfigNode>();
    node->kind = Kind::scalar;
    node->text = std::move(text);
    return node;
}

ConfigNode* ConfigNode::find(const std::string& key) const
{
    for (const Entry& entry : entries) {
        if (entry.key == key) {
            return entry.value.get();
        }
    }
    return nullptr;
}

ConfigNode& ConfigNode::at(const std::string& key)
{
    if (ConfigNode* found = find(key)) {
        return *found;
    }
    entries.push_back({key, place, std::make_unique<ConfigNode>()});
    return *entries.back().value;
}

void ConfigNode::learn(const std::string& key)
{
    if (std::find(known.begin(), known.end(), key) == known.end()) {
        known.push_back(key);
    }
}

std::unique_ptr<ConfigNode> parse_yaml(const std::string& text, const std::string& name,
                                       bool numbered)
{
    const Place place{name, numbered};
    try {
        const std::vector<YAML::Node> documents = YAML::LoadAll(text);
        if (documents.size() > 1) {
            throw ConfigError(place.of(documents[1].Mark()) +
                              ": a second document begins here; one file holds one.");
        }
        if (documents.empty()) {
            auto nothing = std::make_unique<ConfigNode>();
            nothing->place = name;
            return nothing;
        }
        return convert(documents.front(), place, 0);
    } catch (const YAML::Exception& error) {
        throw ConfigError(place.of(error.mark) + ": this is no valid YAML: " + error.msg + ".");
    }
}

std::string to_yaml(const ConfigNode& node)
{
    YAML::Emitter out;
    emit(out, node);
    return std::string(out.c_str()) + "\n";
}

std::string describe(const ConfigNode& node)
{
    switch (node.kind) {
    case ConfigNode::Kind::scalar:
        return "'" + node.text + "'";
    case ConfigNode::Kind::list:
        return "a list";
    case ConfigNode::Kind::map:
        return "a section";
    default:
        return "empty";
    }
}

} // namespace hsgm::io
