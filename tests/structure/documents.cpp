#include "tests/structure/documents.h"

#include "tests/structure/source_tree.h"

#include <nlohmann/json.hpp>
#include <yaml-cpp/yaml.h>

#include <cctype>
#include <regex>

namespace hsgm::structure {

namespace {

using nlohmann::json;

std::string joined(const std::string& name, const std::string& key)
{
    return name.empty() ? key : name + "." + key;
}

void flatten(const YAML::Node& node, const std::string& name,
             std::map<std::string, std::string>& keys)
{
    if (node.IsMap()) {
        for (const auto& entry : node) {
            flatten(entry.second, joined(name, entry.first.as<std::string>()), keys);
        }
        return;
    }
    std::string& text = keys[name];
    if (node.IsSequence()) {
        for (const YAML::Node& item : node) {
            text += (text.empty() ? "" : ", ") + item.Scalar();
        }
        text = "[" + text + "]";
    } else if (node.IsScalar()) {
        text = node.Scalar();
    }
}

// A schema's properties are its own, those of what it refers to, or of one alternative.
void collect(const json& schema, const json& root, const std::string& name,
             std::set<std::string>& keys)
{
    if (schema.contains("$ref")) {
        const auto reference = schema["$ref"].get<std::string>();
        collect(root.at(json::json_pointer(reference.substr(1))), root, name, keys);
        return;
    }
    const json* holder = &schema;
    if (schema.contains("oneOf")) {
        for (const json& alternative : schema["oneOf"]) {
            holder = alternative.contains("properties") ? &alternative : holder;
        }
    }
    if (!holder->contains("properties")) {
        keys.insert(name);
        return;
    }
    for (const auto& [key, property] : (*holder)["properties"].items()) {
        collect(property, root, joined(name, key), keys);
    }
}

// A cell without spaces at its ends and without backquotes.
std::string plain(const std::string& cell)
{
    static const std::regex kDecoration("^\\s+|\\s+$|`");
    return std::regex_replace(cell, kDecoration, "");
}

// The lines of a page outside fenced code.
std::vector<std::string> prose(const std::string& markdown)
{
    std::vector<std::string> lines;
    bool fenced = false;
    for (const std::string& line : split_lines(markdown)) {
        if (line.starts_with("```")) {
            fenced = !fenced;
        } else if (!fenced) {
            lines.push_back(line);
        }
    }
    return lines;
}

} // namespace

std::map<std::string, std::string> flat_keys(const std::string& yaml)
{
    std::map<std::string, std::string> keys;
    flatten(YAML::Load(yaml), "", keys);
    return keys;
}

std::map<std::string, std::string> documented_keys(const std::string& markdown)
{
    static const std::regex kRow(R"(^\| `([a-z0-9_.]+)` \|([^|]*)\|([^|]*)\|.*)");
    std::map<std::string, std::string> keys;
    for (const std::string& line : split_lines(markdown)) {
        std::smatch match;
        if (std::regex_match(line, match, kRow)) {
            keys[match[1]] = plain(match[3]);
        }
    }
    return keys;
}

std::set<std::string> schema_keys(const std::string& text)
{
    const json schema = json::parse(text);
    std::set<std::string> keys;
    collect(schema, schema, "", keys);
    return keys;
}

std::set<std::string> anchors(const std::string& markdown)
{
    std::set<std::string> found;
    for (const std::string& line : prose(markdown)) {
        const auto level = line.find_first_not_of('#');
        if (level == 0 || level == std::string::npos || line[level] != ' ') {
            continue;
        }
        std::string anchor;
        for (const char c : line.substr(level + 1)) {
            const auto letter = static_cast<unsigned char>(c);
            if (std::isalnum(letter) != 0 || c == '-' || c == '_' || letter > 127) {
                anchor += static_cast<char>(std::tolower(letter));
            } else if (c == ' ') {
                anchor += '-';
            }
        }
        found.insert(anchor);
    }
    return found;
}

std::vector<std::string> links(const std::string& markdown)
{
    static const std::regex kCode("`[^`]*`");
    static const std::regex kLink(R"(\]\(([^)\s]+)\))");
    std::vector<std::string> targets;
    for (const std::string& raw : prose(markdown)) {
        const std::string line = std::regex_replace(raw, kCode, "code");
        for (std::sregex_iterator i(line.begin(), line.end(), kLink), end; i != end; ++i) {
            const std::string target = (*i)[1];
            if (target.find("://") == std::string::npos) {
                targets.push_back(target);
            }
        }
    }
    return targets;
}

} // namespace hsgm::structure
