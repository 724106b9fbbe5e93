#include "pipeline/pairs/pair_list.h"

#include "io/error.h"
#include "pipeline/geometry/map_projection.h"
#include "pipeline/pairs/pair_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace hsgm::pipeline {

namespace {

namespace fs = std::filesystem;
using io::ConfigDocument;
using io::ConfigSection;

/// The names of a pair's images.
using Names = std::pair<std::string, std::string>;
/// Keys of the configuration with their values.
using Settings = std::map<std::string, std::string>;

void check_name(const ConfigSection& images, const std::string& name)
{
    if (name.find('/') != std::string::npos || name.starts_with('.')) {
        images.fail(name, "cannot be part of a folder's name; choose another name");
    }
}

/// The images by name, each as YAML for `pair.left` or `pair.right`.
std::map<std::string, std::string> read_images(ConfigSection& images,
                                               std::vector<NamedImage>& opened)
{
    std::map<std::string, std::string> written;
    for (const std::string& name : images.keys()) {
        check_name(images, name);
        opened.push_back({name, images.image(name)});
        written[name] = images.yaml(name);
    }
    if (written.size() < 2) {
        images.fail("", "must name two images or more: {first: a.tif, second: b.tif}");
    }
    return written;
}

std::vector<Names> given_pairs(ConfigSection& root,
                               const std::map<std::string, std::string>& images)
{
    std::vector<Names> pairs;
    std::set<Names> seen;
    for (ConfigSection& pair : root.sections("pairs")) {
        for (const char* side : {"left", "right"}) {
            const std::string name = pair.required_text(side);
            if (!images.contains(name)) {
                std::string known;
                for (const auto& [image, yaml] : images) {
                    known += (known.empty() ? "" : ", ") + image;
                }
                pair.fail(side,
                          fmt::format("is '{}', which `images` does not name; there are {}",
                                      name, known));
            }
        }
        const Names names{pair.required_text("left"), pair.required_text("right")};
        if (names.first == names.second) {
            pair.fail("right", "is the same image as left");
        }
        if (!seen.insert(names).second) {
            pair.fail("left", "and right are a pair that comes twice");
        }
        pairs.push_back(names);
    }
    return pairs;
}

std::vector<Names> chosen_pairs(const std::vector<NamedImage>& images, PairList& list)
{
    std::vector<Names> pairs;
    std::string reasons;
    for (const PairChoice& pair : choose_pairs(images)) {
        if (pair.refusal.empty()) {
            pairs.emplace_back(pair.left, pair.right);
        } else {
            list.left_out.push_back(pair.name() + ": " + pair.refusal);
            reasons += "; " + list.left_out.back();
        }
    }
    if (pairs.empty()) {
        throw io::InputError("no two of the images make a pair" + reasons);
    }
    return pairs;
}

/// The document without what is of several pairs alone.
void strip(ConfigDocument& document)
{
    document.set("images", "~");
    document.set("pairs", "~");
}

std::string in_quotes(const fs::path& path)
{
    return fmt::format("'{}'", fs::absolute(path).string());
}

ConfigDocument loaded(const fs::path& config, const Knobs& knobs, const std::string& output)
{
    auto document = ConfigDocument::load(config);
    knobs.apply(document);
    if (!output.empty()) {
        document.set("output.folder", in_quotes(output));
    }
    return document;
}

/// What the run of one pair reads.
Configuration configuration_of(ConfigDocument document, const Names& names,
                               const std::map<std::string, std::string>& images,
                               const fs::path& folder, const Settings& shared)
{
    strip(document);
    document.set("pair.left", images.at(names.first));
    document.set("pair.right", images.at(names.second));
    document.set("output.folder", in_quotes(folder));
    for (const auto& [key, value] : shared) {
        document.set(key, value);
    }
    return read_configuration(document);
}

/// Map and cells, which must be the same for all: those of one pair where nothing is said.
Settings shared_settings(ConfigSection dsm, const std::vector<NamedImage>& images,
                         const Names& names)
{
    const auto image = [&](const std::string& name) {
        return std::find_if(images.begin(), images.end(),
                            [&](const NamedImage& i) { return i.name == name; })
            ->image;
    };
    Settings shared;
    const auto ground = ground_of(image(names.first), image(names.second));
    if (ground && dsm.text("crs", "auto") == "auto") {
        shared["dsm.crs"] = ground->crs;
    }
    if (ground && dsm.text("gsd_m", "auto") == "auto") {
        shared["dsm.gsd_m"] = fmt::format("{}", ground->cell_m);
    }
    return shared;
}

void refuse_degrees(ConfigSection dsm)
{
    const std::string crs = dsm.text("crs", "auto");
    if (crs == "auto") {
        return;
    }
    try {
        if (!geometry::MapProjection::from_text(crs).in_metres()) {
            dsm.fail("crs", "is in degrees, but several pairs are fused on a map in metres: "
                            "choose another one, and reproject the result with gdalwarp");
        }
    } catch (const std::invalid_argument& error) {
        dsm.fail("crs", std::string("cannot be used: ") + error.what());
    }
}

void refuse_contradictions(ConfigSection& root)
{
    if (root.has("pair")) {
        root.fail("pair", "and images both name images: give one of them");
    }
    ConfigSection geometry = root.section("geometry");
    if (geometry.text("kind", "") != "rpc") {
        geometry.fail("kind", "must be rpc where there are several pairs");
    }
    if (geometry.has("stored")) {
        geometry.fail("stored", "is of one pair, but there are several: leave it out");
    }
    refuse_degrees(root.section("dsm"));
}

} // namespace

bool has_several_pairs(const ConfigDocument& document)
{
    ConfigDocument copy = document;
    return copy.root().has("images");
}

PairList read_pair_list(const fs::path& config, const Knobs& knobs, const std::string& output)
{
    ConfigDocument document = loaded(config, knobs, output);
    ConfigSection root = document.root();
    refuse_contradictions(root);
    PairList list;
    std::vector<NamedImage> opened;
    ConfigSection section = root.section("images");
    const auto images = read_images(section, opened);
    list.folder = root.section("output").path("folder");
    auto pairs = root.has("pairs") ? given_pairs(root, images) : chosen_pairs(opened, list);
    std::sort(pairs.begin(), pairs.end());
    const Settings shared = shared_settings(root.section("dsm"), opened, pairs.front());
    for (const Names& names : pairs) {
        ListedPair pair;
        pair.name = names.first + "-" + names.second;
        pair.folder = list.folder / "pairs" / pair.name;
        try {
            pair.configuration = configuration_of(loaded(config, knobs, output), names, images,
                                                  pair.folder, shared);
        } catch (const io::ConfigError& error) {
            throw io::ConfigError(fmt::format("pair {}: {}", pair.name, error.what()));
        }
        list.pairs.push_back(std::move(pair));
    }
    list.of_all = configuration_of(loaded(config, knobs, output), pairs.front(), images,
                                   list.folder, shared);
    return list;
}

} // namespace hsgm::pipeline
