#include "io/config.h"
#include "io/config_state.h"
#include "io/error.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace hsgm::io {

namespace {

template <typename T>
std::optional<T> parse(const std::string& text)
{
    T value{};
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || stop != end) {
        return std::nullopt;
    }
    return value;
}

/// The shortest text that reads back as the same number.
std::string to_text(double value)
{
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof(buffer), value).ptr;
    return {buffer, end};
}

std::string to_text(int value)
{
    return std::to_string(value);
}

/// " from 1 to 16", " of at least 1", " of at most 16", or nothing.
template <typename T>
std::string limits(T min, T max, T lowest, T highest)
{
    if (min != lowest && max != highest) {
        return " from " + to_text(min) + " to " + to_text(max);
    }
    if (min != lowest) {
        return " of at least " + to_text(min);
    }
    return max != highest ? " of at most " + to_text(max) : "";
}

std::string or_word(const std::string& word)
{
    return word.empty() ? "" : " or '" + word + "'";
}

std::string one_of(const std::vector<std::string>& words)
{
    std::string text = "one of";
    for (const std::string& word : words) {
        text += (word == words.front() ? " " : ", ") + word;
    }
    return text;
}

template <typename T>
std::string to_text_or(const std::optional<T>& value, const std::string& word)
{
    return value.has_value() ? to_text(*value) : word;
}

} // namespace

int ConfigSection::to_integer(const std::string& key, const std::string& text, int min, int max,
                              const std::string& word) const
{
    const std::optional<int> value = parse<int>(text);
    if (!value.has_value() || *value < min || *value > max) {
        refuse(key, "a whole number" + limits(min, max, kLowest, kHighest) + or_word(word));
    }
    return *value;
}

double ConfigSection::to_number(const std::string& key, const std::string& text, double min,
                                double max, const std::string& word) const
{
    const std::optional<double> value = parse<double>(text);
    if (!value.has_value() || !std::isfinite(*value) || *value < min || *value > max) {
        refuse(key, "a number" + limits(min, max, -kLargest, kLargest) + or_word(word));
    }
    return *value;
}

std::string ConfigSection::text(const std::string& key, const std::string& default_value)
{
    const std::string* found = find_scalar(key, "a text");
    const std::string value = found != nullptr ? *found : default_value;
    record(key, value, default_value);
    return value;
}

std::string ConfigSection::required_text(const std::string& key)
{
    const std::string value = *find_required(key, "a text");
    record(key, value, "");
    return value;
}

std::optional<std::string> ConfigSection::optional_text(const std::string& key)
{
    return has(key) ? std::optional(required_text(key)) : std::nullopt;
}

int ConfigSection::integer(const std::string& key, int default_value, int min, int max)
{
    const std::string* found = find_scalar(key, "a whole number");
    const int value = found != nullptr ? to_integer(key, *found, min, max, "") : default_value;
    record(key, to_text(value), to_text(default_value));
    return value;
}

int ConfigSection::required_integer(const std::string& key, int min, int max)
{
    const int value = to_integer(key, *find_required(key, "a whole number"), min, max, "");
    record(key, to_text(value), "");
    return value;
}

std::optional<int> ConfigSection::integer_or(const std::string& key, const std::string& word,
                                             std::optional<int> default_value, int min, int max)
{
    const std::string* found = find_scalar(key, "a whole number" + or_word(word));
    std::optional<int> value = default_value;
    if (found != nullptr) {
        value = *found == word ? std::nullopt
                               : std::optional(to_integer(key, *found, min, max, word));
    }
    record(key, to_text_or(value, word), to_text_or(default_value, word));
    return value;
}

double ConfigSection::number(const std::string& key, double default_value, double min,
                             double max)
{
    const std::string* found = find_scalar(key, "a number");
    const double value =
        found != nullptr ? to_number(key, *found, min, max, "") : default_value;
    record(key, to_text(value), to_text(default_value));
    return value;
}

double ConfigSection::required_number(const std::string& key, double min, double max)
{
    const double value = to_number(key, *find_required(key, "a number"), min, max, "");
    record(key, to_text(value), "");
    return value;
}

std::optional<double> ConfigSection::optional_number(const std::string& key, double min,
                                                     double max)
{
    return has(key) ? std::optional(required_number(key, min, max)) : std::nullopt;
}

std::optional<double> ConfigSection::number_or(const std::string& key, const std::string& word,
                                               std::optional<double> default_value, double min,
                                               double max)
{
    const std::string* found = find_scalar(key, "a number" + or_word(word));
    std::optional<double> value = default_value;
    if (found != nullptr) {
        value = *found == word ? std::nullopt
                               : std::optional(to_number(key, *found, min, max, word));
    }
    record(key, to_text_or(value, word), to_text_or(default_value, word));
    return value;
}

std::vector<std::string> ConfigSection::texts(const std::string& key)
{
    std::vector<std::string> values;
    const ConfigNode* list = find(key);
    ConfigNode& effective = effective_->at(key);
    effective.kind = ConfigNode::Kind::list;
    effective.items.clear();
    if (list == nullptr) {
        return values;
    }
    if (list->kind != ConfigNode::Kind::list) {
        refuse(key, "a list, written [a, b]");
    }
    for (const auto& item : list->items) {
        if (item->kind != ConfigNode::Kind::scalar) {
            fail(key, "holds " + describe(*item) + "; its items must be plain values.");
        }
        values.push_back(item->text);
        effective.items.push_back(ConfigNode::scalar(item->text));
    }
    return values;
}

std::vector<double> ConfigSection::numbers(const std::string& key, std::size_t count)
{
    std::vector<double> values;
    for (const std::string& item : texts(key)) {
        const std::optional<double> value = parse<double>(item);
        if (!value.has_value() || !std::isfinite(*value)) {
            fail(key, "holds '" + item + "'; its items must be numbers.");
        }
        values.push_back(*value);
    }
    if (count != 0 && has(key) && values.size() != count) {
        fail(key, "has " + std::to_string(values.size()) + " items; it must have " +
                      std::to_string(count) + ".");
    }
    return values;
}

bool ConfigSection::flag(const std::string& key, bool default_value)
{
    const std::string* found = find_scalar(key, "true or false");
    bool value = default_value;
    if (found != nullptr) {
        const auto is = [&](std::initializer_list<const char*> words) {
            return std::find(words.begin(), words.end(), *found) != words.end();
        };
        value = is({"true", "yes", "on", "True", "Yes", "On"});
        if (!value && !is({"false", "no", "off", "False", "No", "Off"})) {
            refuse(key, "true or false");
        }
    }
    record(key, value ? "true" : "false", default_value ? "true" : "false");
    return value;
}

std::string ConfigSection::choice(const std::string& key, const std::string& default_value,
                                  const std::vector<std::string>& allowed)
{
    const std::string* found = find_scalar(key, one_of(allowed));
    const std::string value = found != nullptr ? *found : default_value;
    if (found != nullptr && std::find(allowed.begin(), allowed.end(), value) == allowed.end()) {
        refuse(key, one_of(allowed));
    }
    record(key, value, default_value);
    return value;
}

std::string ConfigSection::required_choice(const std::string& key,
                                           const std::vector<std::string>& allowed)
{
    find_required(key, one_of(allowed));
    const std::string value = choice(key, "", allowed);
    return value;
}

std::optional<std::pair<int, int>> ConfigSection::range_or(const std::string& key,
                                                           const std::string& word)
{
    const std::string allowed = "[min, max] in whole numbers" + or_word(word);
    const ConfigNode* node = find(key);
    if (node == nullptr || (node->kind == ConfigNode::Kind::scalar && node->text == word)) {
        record(key, word, word);
        return std::nullopt;
    }
    if (node->kind != ConfigNode::Kind::list || node->items.size() != 2) {
        refuse(key, allowed);
    }
    const std::optional<int> low = parse<int>(node->items[0]->text);
    const std::optional<int> high = parse<int>(node->items[1]->text);
    if (!low.has_value() || !high.has_value() || *low > *high) {
        fail(key, "is [" + node->items[0]->text + ", " + node->items[1]->text +
                      "]; it must be " + allowed + ", the first not above the second.");
    }
    texts(key); // into the effective configuration
    effective_->at(key).default_text = word;
    return std::pair{*low, *high};
}

std::uint64_t ConfigSection::bytes(const std::string& key, const std::string& default_value)
{
    const std::string value = text(key, default_value);
    try {
        return parse_bytes(value);
    } catch (const ConfigError& error) {
        throw ConfigError(place_of(key) + ": '" + name_of(key) + "': " + error.what());
    }
}

ByteAmount ConfigSection::byte_amount(const std::string& key, const std::string& default_value)
{
    const std::string value = text(key, default_value);
    try {
        return parse_byte_amount(value);
    } catch (const ConfigError& error) {
        throw ConfigError(place_of(key) + ": '" + name_of(key) + "': " + error.what());
    }
}

} // namespace hsgm::io
