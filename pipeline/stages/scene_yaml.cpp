#include "pipeline/stages/scene_config.h"

#include "pipeline/stages/scene_fields.h"

#include <fmt/format.h>

#include <optional>

namespace hsgm::pipeline {

namespace {

// Writes fields as YAML: sections indented, the entries of lists in one line each. Numbers
// are as short as they can be and still come back as the same bits.
class YamlWriter {
public:
    explicit YamlWriter(std::string indent = "", bool one_line = false)
        : indent_(std::move(indent)), one_line_(one_line)
    {
    }

    template <typename Number>
    void value(const char* key, Number number)
    {
        put(key, fmt::format("{}", number));
    }

    void size(const char* key, tiling::Size size)
    {
        put(key, fmt::format("[{}, {}]", size.rows, size.cols));
    }

    template <typename Enum, typename Names>
    void choice(const char* key, Enum chosen, const Names& names)
    {
        for (const auto& [enumerator, word] : names) {
            if (enumerator == chosen) {
                put(key, std::string(word));
            }
        }
    }

    template <typename Struct>
    void section(const char* key, Struct& fields)
    {
        if (one_line_) {
            put(key, in_braces(fields));
            return;
        }
        YamlWriter inner(indent_ + "  ");
        visit_fields(inner, fields);
        text_ += indent_ + key + ":\n" + inner.text_;
    }

    template <typename Struct>
    void optional_section(const char* key, std::optional<Struct>& fields)
    {
        if (fields) {
            section(key, *fields);
        }
    }

    template <typename Struct>
    void list(const char* key, std::vector<Struct>& entries)
    {
        if (entries.empty()) {
            put(key, "[]");
            return;
        }
        text_ += indent_ + key + ":\n";
        for (Struct& entry : entries) {
            text_ += indent_ + "  - " + in_braces(entry) + "\n";
        }
    }

    const std::string& text() const { return text_; }

private:
    void put(const char* key, const std::string& value)
    {
        const std::string entry = std::string(key) + ": " + value;
        if (one_line_) {
            text_ += (text_.empty() ? "" : ", ") + entry;
        } else {
            text_ += indent_ + entry + "\n";
        }
    }

    template <typename Struct>
    static std::string in_braces(Struct& fields)
    {
        YamlWriter inner("", true);
        visit_fields(inner, fields);
        return "{" + inner.text_ + "}";
    }

    std::string indent_;
    bool one_line_;
    std::string text_;
};

} // namespace

std::string scene_as_yaml(const synth::Scene& scene)
{
    synth::Scene copy = scene; // visitors read and write through the same reference
    YamlWriter writer;
    visit_fields(writer, copy);
    return writer.text();
}

} // namespace hsgm::pipeline
