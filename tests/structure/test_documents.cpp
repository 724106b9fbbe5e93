// What people read and what the program does are the same: every key of the configuration is
// in the reference, in the defaults and in the schema, and links lead somewhere.

#include "io/config.h"
#include "io/error.h"
#include "matcher/reasons.h"
#include "pipeline/configuration.h"
#include "pipeline/stages/scene_config.h"
#include "tests/catch.h"
#include "tests/structure/documents.h"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iterator>
#include <sstream>

namespace {

namespace fs = std::filesystem;
using namespace hsgm::structure;
using hsgm::io::ConfigDocument;
using Keys = std::set<std::string>;

const fs::path kRoot = HSGM_SOURCE_DIR;

// What a configuration must say, and nothing else, as configs/defaults.yaml says it.
const char* const kLeast = R"(pair: {left: {path: left.tif}, right: {path: right.tif}}
geometry: {kind: rectified}
matcher: {disparity: [0, 63]}
output: {folder: result}
)";
const Keys kRequired{"pair.left.path", "pair.right.path", "geometry.kind", "matcher.disparity",
                     "output.folder"};

std::string text_of(const fs::path& path)
{
    std::ifstream in(kRoot / path, std::ios::binary);
    REQUIRE(in);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

Keys names(const std::map<std::string, std::string>& keys)
{
    Keys result;
    for (const auto& [name, value] : keys) {
        result.insert(name);
    }
    return result;
}

std::map<std::string, std::string> defaults()
{
    return flat_keys(text_of("configs/defaults.yaml"));
}

std::string used_yaml(const std::string& text)
{
    ConfigDocument document = ConfigDocument::parse(text, "run.yaml", kRoot / "configs");
    return hsgm::pipeline::read_configuration(document).used_yaml;
}

// The keys that the program knows beside `key`, from what it says of one it does not know.
Keys known_beside(const std::string& section)
{
    ConfigDocument document = ConfigDocument::parse(kLeast, "run.yaml");
    document.set(section.empty() ? "qqqqqqqqqqqq" : section + ".qqqqqqqqqqqq", "1");
    std::string said;
    try {
        hsgm::pipeline::read_configuration(document);
    } catch (const hsgm::io::ConfigError& error) {
        said = error.what();
    }
    const std::string mark = "known here: ";
    CAPTURE(said);
    REQUIRE(said.find(mark) != std::string::npos);
    std::string list = said.substr(said.find(mark) + mark.size());
    list.pop_back(); // the full stop
    std::replace(list.begin(), list.end(), ',', ' ');
    std::istringstream words(list);
    return {std::istream_iterator<std::string>(words), std::istream_iterator<std::string>()};
}

// The keys of a section of configs/defaults.yaml.
Keys listed_in(const std::string& section)
{
    const std::string prefix = section.empty() ? "" : section + ".";
    Keys keys;
    for (const auto& [name, value] : defaults()) {
        if (name.starts_with(prefix)) {
            keys.insert(
                name.substr(prefix.size(), name.find('.', prefix.size()) - prefix.size()));
        }
    }
    return keys;
}

std::vector<fs::path> pages()
{
    std::vector<fs::path> found{"README.md", "CHANGELOG.md"};
    for (const auto& entry : fs::directory_iterator(kRoot / "docs")) {
        if (entry.path().extension() == ".md") {
            found.push_back(fs::path("docs") / entry.path().filename());
        }
    }
    return found;
}

bool leads_somewhere(const fs::path& page, const std::string& target)
{
    const auto hash = target.find('#');
    const std::string file = target.substr(0, hash);
    const fs::path path = file.empty() ? page : page.parent_path() / file;
    if (!fs::exists(kRoot / path)) {
        return false;
    }
    return hash == std::string::npos ||
           anchors(text_of(path)).contains(target.substr(hash + 1));
}

} // namespace

TEST_CASE("configs/defaults.yaml says what the program takes where nothing is said")
{
    CHECK(used_yaml(text_of("configs/defaults.yaml")) == used_yaml(kLeast));
}

TEST_CASE("configs/defaults.yaml lists every key that the program knows")
{
    const std::string section =
        GENERATE("", "pair", "pair.left", "geometry", "dsm", "matcher", "run", "output");
    CAPTURE(section);
    CHECK(known_beside(section) == listed_in(section));
}

TEST_CASE("docs/configuration.md has every key with its default")
{
    const auto documented = documented_keys(text_of("docs/configuration.md"));
    CHECK(names(documented) == names(defaults()));
    for (const auto& [name, value] : defaults()) {
        CAPTURE(name);
        const std::string expected =
            kRequired.contains(name) ? "required" : (value.empty() ? "–" : value);
        CHECK((documented.contains(name) ? documented.at(name) : "") == expected);
    }
}

TEST_CASE("the JSON Schema has every key")
{
    CHECK(schema_keys(text_of("configs/schema/run.schema.json")) == names(defaults()));
}

TEST_CASE("docs/outputs.md has every reason with its bit, and whether it takes the value away")
{
    const std::string page = text_of("docs/outputs.md");
    for (const auto& [bit, name] : hsgm::matcher::kReasonNames) {
        std::ostringstream row;
        row << "| " << std::countr_zero(static_cast<unsigned>(bit)) << " | " << std::hex
            << std::uppercase << std::setw(4) << std::setfill('0') << static_cast<unsigned>(bit)
            << " | `" << name << "` |";
        const auto start = page.find(row.str());
        CAPTURE(row.str());
        REQUIRE(start != std::string::npos);
        const std::string line = page.substr(start, page.find('\n', start) - start);
        const bool invalidates = (bit & hsgm::matcher::kInvalidating) != 0;
        CHECK(line.ends_with(invalidates ? "| no |" : "| yes |"));
    }
}

TEST_CASE("every file in configs can be read")
{
    for (const auto& entry : fs::directory_iterator(kRoot / "configs")) {
        CAPTURE(entry.path());
        if (entry.path().filename().string().starts_with("scene-")) {
            CHECK_NOTHROW(hsgm::pipeline::read_scene(entry.path().string(), {}));
        } else if (entry.path().extension() == ".yaml") {
            ConfigDocument document = ConfigDocument::load(entry.path());
            CHECK_NOTHROW(hsgm::pipeline::read_configuration(document));
        }
    }
}

TEST_CASE("links between the documents lead somewhere")
{
    for (const fs::path& page : pages()) {
        for (const std::string& link : links(text_of(page))) {
            CAPTURE(page, link);
            CHECK(leads_somewhere(page, link));
        }
    }
    CHECK_FALSE(leads_somewhere("docs/README.md", "nowhere.md"));
    CHECK_FALSE(leads_somewhere("docs/README.md", "configuration.md#nowhere"));
}

TEST_CASE("the index names every page")
{
    const auto named = links(text_of("docs/README.md"));
    for (const fs::path& page : pages()) {
        if (page.parent_path() == "docs" && page.filename() != "README.md") {
            CAPTURE(page);
            CHECK(std::count(named.begin(), named.end(), page.filename().string()) == 1);
        }
    }
}

TEST_CASE("anchors, links and keys are found in a page")
{
    const std::string page =
        "# Left and right: *checks*\n"
        "```\n# no heading [no](link)\n```\n"
        "See [a](b.md#c) and `[code](none)`, ![p](p.png), [w](https://x).\n"
        "| `run.memory` | text | `80%` | any |\n";
    CHECK(anchors(page) == std::set<std::string>{"left-and-right-checks"});
    CHECK(links(page) == std::vector<std::string>{"b.md#c", "p.png"});
    CHECK(documented_keys(page) == std::map<std::string, std::string>{{"run.memory", "80%"}});
}
