#include "pipeline/batch/manifest.h"

#include "io/config.h"
#include "io/error.h"
#include "io/pending_file.h"
#include "pipeline/batch/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

namespace hsgm::pipeline {

namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw io::ConfigError(fmt::format("The manifest {} cannot be read.", path.string()));
    }
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string resolved(const fs::path& folder, const std::string& path)
{
    if (path.empty() || io::is_virtual_path(path)) {
        return path;
    }
    return fs::absolute(folder / path).lexically_normal().string();
}

// Files in one folder that look like images of a pair, by what comes before "left", "right".
struct FoundImages {
    std::map<std::string, fs::path> left;
    std::map<std::string, fs::path> right;
};

FoundImages images_in(const fs::path& folder)
{
    FoundImages found;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string stem = entry.path().stem().string();
        const std::string ending = entry.path().extension().string();
        if (!entry.is_regular_file() || ending == ".xml" || ending == ".ovr") {
            continue; // GDAL's side files
        }
        for (const auto& [word, images] :
             {std::pair{"left", &found.left}, {"right", &found.right}}) {
            if (stem.ends_with(word)) {
                const std::string before =
                    stem.substr(0, stem.size() - std::string(word).size());
                images->emplace(before, entry.path());
            }
        }
    }
    return found;
}

std::vector<BatchPair> pairs_in_folder(const fs::path& folder)
{
    std::vector<BatchPair> pairs;
    const auto add = [&](const std::string& name, const fs::path& left, const fs::path& right) {
        pairs.push_back({name, fs::absolute(left).string(), fs::absolute(right).string(), {}});
    };
    const FoundImages here = images_in(folder);
    for (const auto& [before, left] : here.left) {
        if (before.ends_with('_') && here.right.contains(before)) {
            add(before.substr(0, before.size() - 1), left, here.right.at(before));
        }
    }
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (!entry.is_directory()) {
            continue;
        }
        const FoundImages inside = images_in(entry.path());
        if (inside.left.contains("") && inside.right.contains("")) {
            add(entry.path().filename().string(), inside.left.at(""), inside.right.at(""));
        }
    }
    std::sort(pairs.begin(), pairs.end(),
              [](const BatchPair& a, const BatchPair& b) { return a.name < b.name; });
    return pairs;
}

std::vector<BatchPair> pairs_in_csv(const fs::path& path)
{
    const auto rows = parse_csv(text_of(path), path.string());
    if (rows.empty()) {
        return {};
    }
    const std::vector<std::string>& columns = rows.front();
    for (const char* needed : {"left", "right"}) {
        if (std::find(columns.begin(), columns.end(), needed) == columns.end()) {
            throw io::ConfigError(fmt::format(
                "{}: the first row names no column '{}'; there must be left, right, "
                "and may be name and keys such as matcher.disparity",
                path.string(), needed));
        }
    }
    std::vector<BatchPair> pairs;
    for (std::size_t r = 1; r < rows.size(); ++r) {
        if (rows[r].size() > columns.size()) {
            throw io::ConfigError(
                fmt::format("{}: row {} has {} cells, but there are {} columns", path.string(),
                            r + 1, rows[r].size(), columns.size()));
        }
        BatchPair pair;
        for (std::size_t c = 0; c < rows[r].size(); ++c) {
            const std::string& cell = rows[r][c];
            if (columns[c] == "name") {
                pair.name = cell;
            } else if (columns[c] == "left" || columns[c] == "right") {
                (columns[c] == "left" ? pair.left : pair.right) =
                    resolved(path.parent_path(), cell);
            } else if (!cell.empty()) {
                pair.overrides.emplace_back(columns[c], cell);
            }
        }
        pairs.push_back(std::move(pair));
    }
    return pairs;
}

std::vector<BatchPair> pairs_in_yaml(const fs::path& path)
{
    auto document = io::ConfigDocument::load(path);
    io::ConfigSection root = document.root();
    std::vector<BatchPair> pairs;
    for (io::ConfigSection& section : root.sections("pairs")) {
        BatchPair pair;
        pair.name = section.text("name", "");
        pair.left = fs::absolute(section.path("left")).string();
        pair.right = fs::absolute(section.path("right")).string();
        io::ConfigSection set = section.section("set");
        for (const std::string& key : set.keys()) {
            pair.overrides.emplace_back(key, set.yaml(key));
        }
        pairs.push_back(std::move(pair));
    }
    document.refuse_unknown();
    return pairs;
}

void check_names(std::vector<BatchPair>& pairs, const fs::path& path)
{
    std::set<std::string> names;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        BatchPair& pair = pairs[i];
        if (pair.left.empty() || pair.right.empty()) {
            throw io::ConfigError(fmt::format("{}: pair {} has no {} image", path.string(),
                                              i + 1, pair.left.empty() ? "left" : "right"));
        }
        if (pair.name.empty()) {
            pair.name = fs::path(pair.left).stem().string();
        }
        if (pair.name.find('/') != std::string::npos || pair.name.starts_with('.') ||
            pair.name == "logs") {
            throw io::ConfigError(
                fmt::format("{}: the name '{}' of pair {} cannot be the name of "
                            "its output folder; choose another",
                            path.string(), pair.name, i + 1));
        }
        if (!names.insert(pair.name).second) {
            throw io::ConfigError(
                fmt::format("{}: two pairs are named '{}'; each needs a name of its own",
                            path.string(), pair.name));
        }
    }
}

} // namespace

std::vector<BatchPair> read_manifest(const fs::path& path)
{
    if (!fs::exists(path)) {
        throw io::ConfigError(fmt::format(
            "There is no manifest or folder {}; name a folder of pairs, a CSV or a YAML file.",
            path.string()));
    }
    std::vector<BatchPair> pairs;
    if (fs::is_directory(path)) {
        pairs = pairs_in_folder(path);
    } else if (path.extension() == ".csv") {
        pairs = pairs_in_csv(path);
    } else if (path.extension() == ".yaml" || path.extension() == ".yml") {
        pairs = pairs_in_yaml(path);
    } else {
        throw io::ConfigError(
            fmt::format("{} is neither a folder nor a file that ends in .csv, .yaml or .yml",
                        path.string()));
    }
    if (pairs.empty()) {
        throw io::ConfigError(fmt::format(
            "{} holds no pair: a folder needs folders with left.* and right.*, or files "
            "NAME_left.* and NAME_right.*; a manifest needs a row or an entry for each pair",
            path.string()));
    }
    check_names(pairs, path);
    return pairs;
}

} // namespace hsgm::pipeline
