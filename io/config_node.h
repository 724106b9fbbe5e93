#pragma once

// Private to this folder: the tree behind io/config.h.

#include <memory>
#include <string>
#include <vector>

namespace hsgm::io {

/// A piece of YAML, with where it was written.
struct ConfigNode {
    enum class Kind { null, scalar, list, map };
    struct Entry {
        std::string key;
        std::string place; // of the key
        std::unique_ptr<ConfigNode> value;
    };

    Kind kind = Kind::null;
    std::string text;                               // of a scalar
    std::string place;                              // "run.yaml:3:9" or "--set matcher.cost"
    std::vector<Entry> entries;                     // of a map
    std::vector<std::unique_ptr<ConfigNode>> items; // of a list

    // Only in the tree of effective values:
    std::vector<std::string> known; // keys that the program asked for
    std::string default_text;       // shown where it differs from the value
    bool is_file = false;           // a path
    bool is_image = false;          // a path of an image that a run reads pixel by pixel

    static std::unique_ptr<ConfigNode> scalar(std::string text);
    ConfigNode* find(const std::string& key) const;
    /// The entry of that name, made where it is missing.
    ConfigNode& at(const std::string& key);
    void learn(const std::string& key);
};

/// Reads YAML text of one document; places are `name`:line:column, or `name` alone where
/// `numbered` is false. Throws ConfigError for bad syntax, a key that comes twice, and
/// several documents in one file.
std::unique_ptr<ConfigNode> parse_yaml(const std::string& text, const std::string& name,
                                       bool numbered);

/// The tree as YAML, with a comment wherever a value is not the default.
std::string to_yaml(const ConfigNode& node);

/// For messages: "the text 'fast'", "a list", "a section", "nothing".
std::string describe(const ConfigNode& node);

} // namespace hsgm::io
