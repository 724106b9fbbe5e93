#pragma once

#include "io/byte_size.h"
#include "io/image_spec.h"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hsgm::io {

struct ConfigNode;
struct ConfigState;

/// One section of a configuration: a map of keys. Every getter notes the key, the value in
/// force and the default, so that afterwards unknown keys can be refused and the complete
/// configuration written back. Getters throw ConfigError with file, line and column for a
/// value of the wrong kind or out of range; `min` and `max` are allowed themselves.
class ConfigSection {
public:
    /// A section inside this one; where it is missing, an empty one with all the defaults.
    ConfigSection section(const std::string& key);
    /// A list of sections; a missing key is an empty list.
    std::vector<ConfigSection> sections(const std::string& key);
    /// The names that the user chose in a section of free names, such as `images:`.
    std::vector<std::string> keys();
    /// True where the key is given and not empty. Makes the key known.
    bool has(const std::string& key);

    std::string text(const std::string& key, const std::string& default_value);
    std::string required_text(const std::string& key);
    std::optional<std::string> optional_text(const std::string& key);
    std::vector<std::string> texts(const std::string& key);

    int integer(const std::string& key, int default_value, int min = kLowest,
                int max = kHighest);
    int required_integer(const std::string& key, int min = kLowest, int max = kHighest);
    /// A whole number, or a word such as "auto" or "off", which is returned as nothing.
    std::optional<int> integer_or(const std::string& key, const std::string& word,
                                  std::optional<int> default_value = std::nullopt,
                                  int min = kLowest, int max = kHighest);

    double number(const std::string& key, double default_value, double min = -kLargest,
                  double max = kLargest);
    double required_number(const std::string& key, double min = -kLargest,
                           double max = kLargest);
    std::optional<double> optional_number(const std::string& key, double min = -kLargest,
                                          double max = kLargest);
    std::optional<double> number_or(const std::string& key, const std::string& word,
                                    std::optional<double> default_value = std::nullopt,
                                    double min = -kLargest, double max = kLargest);
    /// A list of numbers, `count` of them (0: any number); a missing key is an empty list.
    std::vector<double> numbers(const std::string& key, std::size_t count = 0);

    bool flag(const std::string& key, bool default_value);
    /// What is written for a key, as YAML, whatever it is; empty where it is missing.
    std::string yaml(const std::string& key);
    /// One of the words in `allowed`.
    std::string choice(const std::string& key, const std::string& default_value,
                       const std::vector<std::string>& allowed);
    std::string required_choice(const std::string& key,
                                const std::vector<std::string>& allowed);
    /// `[min, max]` in whole numbers, the first not above the second; nothing for `word`,
    /// which is the default.
    std::optional<std::pair<int, int>> range_or(const std::string& key,
                                                const std::string& word);

    /// A path that must be given. A relative one starts at the configuration's folder;
    /// absolute ones, GDAL's virtual ones and driver prefixes (`NETCDF:...`) stay as they are.
    std::string path(const std::string& key);
    std::optional<std::string> optional_path(const std::string& key);
    std::string path_or(const std::string& key, const std::string& default_value);
    /// A path, or a map {path, band, nodata, mask, rpc, azimuth_deg, incidence_deg,
    /// view_vector}; must be given. `band: auto` is the
    /// default; `nodata: none` switches the file's own off.
    ImageSpec image(const std::string& key);

    /// "8GiB", "512MiB", 1048576.
    std::uint64_t bytes(const std::string& key, const std::string& default_value);
    /// The same, or a share such as "80%".
    ByteAmount byte_amount(const std::string& key, const std::string& default_value);

    /// Full name of a key, "matcher.cost"; of the section itself for an empty key.
    std::string name_of(const std::string& key) const;
    /// Where the key is written: "run.yaml:3:9", "--set matcher.cost", or the file's name.
    std::string place_of(const std::string& key) const;
    /// Throws ConfigError: "run.yaml:3:9: 'matcher.cost' SENTENCE".
    [[noreturn]] void fail(const std::string& key, const std::string& sentence) const;

private:
    friend class ConfigDocument;
    static constexpr int kLowest = std::numeric_limits<int>::min();
    static constexpr int kHighest = std::numeric_limits<int>::max();
    static constexpr double kLargest = std::numeric_limits<double>::max();

    ConfigSection(std::shared_ptr<ConfigState> state, const ConfigNode* given,
                  ConfigNode* effective, std::string name);
    const ConfigNode* find(const std::string& key);
    void read_view(ImageSpec& spec);
    const std::string* find_scalar(const std::string& key, const std::string& allowed);
    const std::string* find_required(const std::string& key, const std::string& allowed);
    void record(const std::string& key, const std::string& value,
                const std::string& default_value);
    std::string resolve(const std::string& path) const;
    std::string note_path(const std::string& key, const std::string& written);
    [[noreturn]] void refuse(const std::string& key, const std::string& allowed) const;
    int to_integer(const std::string& key, const std::string& text, int min, int max,
                   const std::string& word) const;
    double to_number(const std::string& key, const std::string& text, double min, double max,
                     const std::string& word) const;

    std::shared_ptr<ConfigState> state_;
    const ConfigNode* given_; // null: not in the file
    ConfigNode* effective_;
    std::string name_;
};

/// A key with the value in force.
struct ConfigValue {
    std::string name; ///< "matcher.cost"; items of a list by number, "pairs.0.left"
    std::string text;
    bool is_file = false;  ///< an absolute path
    bool is_image = false; ///< of an image
};

/// A configuration file: YAML with relative paths from its own folder. Use it in this order:
/// load, `set` the overrides, read everything through `root`, `refuse_unknown`.
class ConfigDocument {
public:
    /// Throws ConfigError for a file that is missing, empty, no map, or no YAML.
    static ConfigDocument load(const std::filesystem::path& path);
    /// `name` stands for the file in messages, `folder` for where it lies.
    static ConfigDocument parse(const std::string& text, const std::string& name,
                                const std::filesystem::path& folder = ".");
    /// A configuration of nothing but defaults, to be filled by `set`.
    static ConfigDocument empty(const std::string& name);

    /// Applies `--set KEY=VALUE`: a dotted path and a YAML value; numbers in the path count
    /// list items from 0. Before any reading. Throws ConfigError where the path crosses a
    /// value that is no section.
    void set(const std::string& dotted, const std::string& yaml_value);
    /// The same from one text "KEY=VALUE".
    void set(const std::string& assignment);

    /// Whether the file, with what was set, has a plain value at a dotted path.
    bool is_scalar(const std::string& dotted) const;

    ConfigSection root();
    /// Throws ConfigError for the first key that nothing asked for, with the nearest known.
    void refuse_unknown() const;
    /// Everything that was read, defaults included, as YAML; paths are absolute.
    std::string effective_yaml() const;
    /// The same as a list.
    std::vector<ConfigValue> effective_values() const;
    const std::filesystem::path& folder() const;

private:
    explicit ConfigDocument(std::shared_ptr<ConfigState> state);

    std::shared_ptr<ConfigState> state_;
};

} // namespace hsgm::io
