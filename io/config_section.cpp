#include "io/config.h"
#include "io/config_state.h"
#include "io/error.h"
#include "io/pending_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

namespace hsgm::io {

namespace {

/// `NETCDF:file.nc:band` and the like: GDAL's business, no path of ours.
bool has_driver_prefix(const std::string& path)
{
    const std::size_t colon = path.find(':');
    return colon != std::string::npos && colon >= 2 &&
           std::all_of(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(colon),
                       [](unsigned char c) {
                           return std::isupper(c) != 0 || std::isdigit(c) != 0 || c == '_';
                       });
}

} // namespace

ConfigSection::ConfigSection(std::shared_ptr<ConfigState> state, const ConfigNode* given,
                             ConfigNode* effective, std::string name)
    : state_(std::move(state)), given_(given), effective_(effective), name_(std::move(name))
{
    if (given_ != nullptr && given_->kind == ConfigNode::Kind::null) {
        given_ = nullptr; // "matcher:" and nothing below it
    }
    if (given_ != nullptr && given_->kind != ConfigNode::Kind::map) {
        throw ConfigError(given_->place + ": '" + name_ + "' is " + describe(*given_) +
                          "; it must be a section of keys and values.");
    }
    effective_->kind = ConfigNode::Kind::map;
}

ConfigSection ConfigSection::section(const std::string& key)
{
    const ConfigNode* given = find(key);
    return ConfigSection(state_, given, &effective_->at(key), name_of(key));
}

std::vector<ConfigSection> ConfigSection::sections(const std::string& key)
{
    std::vector<ConfigSection> found;
    const ConfigNode* list = find(key);
    if (list == nullptr) {
        return found;
    }
    if (list->kind != ConfigNode::Kind::list) {
        refuse(key, "a list of sections, each begun with a dash");
    }
    ConfigNode& effective = effective_->at(key);
    effective.kind = ConfigNode::Kind::list;
    effective.items.resize(list->items.size());
    for (std::size_t i = 0; i < list->items.size(); ++i) {
        if (effective.items[i] == nullptr) {
            effective.items[i] = std::make_unique<ConfigNode>();
        }
        found.push_back(ConfigSection(state_, list->items[i].get(), effective.items[i].get(),
                                      name_of(key) + "." + std::to_string(i)));
    }
    return found;
}

std::vector<std::string> ConfigSection::keys()
{
    std::vector<std::string> names;
    if (given_ != nullptr) {
        for (const ConfigNode::Entry& entry : given_->entries) {
            effective_->learn(entry.key);
            names.push_back(entry.key);
        }
    }
    return names;
}

const ConfigNode* ConfigSection::find(const std::string& key)
{
    effective_->learn(key);
    return given_ == nullptr ? nullptr : given_->find(key);
}

bool ConfigSection::has(const std::string& key)
{
    const ConfigNode* node = find(key);
    return node != nullptr && node->kind != ConfigNode::Kind::null;
}

const std::string* ConfigSection::find_scalar(const std::string& key,
                                              const std::string& allowed)
{
    const ConfigNode* node = find(key);
    if (node == nullptr) {
        return nullptr;
    }
    if (node->kind != ConfigNode::Kind::scalar) {
        refuse(key, allowed);
    }
    return &node->text;
}

const std::string* ConfigSection::find_required(const std::string& key,
                                                const std::string& allowed)
{
    const std::string* found = find_scalar(key, allowed);
    if (found == nullptr) {
        fail(key, "is missing; it must be " + allowed + ".");
    }
    return found;
}

void ConfigSection::record(const std::string& key, const std::string& value,
                           const std::string& default_value)
{
    ConfigNode& node = effective_->at(key);
    node.kind = ConfigNode::Kind::scalar;
    node.text = value;
    node.default_text = value == default_value ? "" : default_value;
}

std::string ConfigSection::yaml(const std::string& key)
{
    const ConfigNode* node = find(key);
    if (node == nullptr) {
        return "";
    }
    std::string text = to_yaml(*node);
    text.erase(text.find_last_not_of('\n') + 1);
    return text;
}

std::string ConfigSection::name_of(const std::string& key) const
{
    return name_.empty() || key.empty() ? name_ + key : name_ + "." + key;
}

std::string ConfigSection::place_of(const std::string& key) const
{
    const ConfigNode* node = given_ == nullptr ? nullptr : given_->find(key);
    if (node != nullptr) {
        return node->place;
    }
    return given_ == nullptr || given_->place.empty() ? state_->name : given_->place;
}

void ConfigSection::fail(const std::string& key, const std::string& sentence) const
{
    throw ConfigError(place_of(key) + ": '" + name_of(key) + "' " + sentence);
}

void ConfigSection::refuse(const std::string& key, const std::string& allowed) const
{
    fail(key, "is " + describe(*given_->find(key)) + "; it must be " + allowed + ".");
}

std::string ConfigSection::resolve(const std::string& path) const
{
    if (is_virtual_path(path) || has_driver_prefix(path)) {
        return path;
    }
    return (state_->folder / path).lexically_normal().string(); // absolute: stays itself
}

/// Resolves a path and notes its absolute form, which means the same wherever the effective
/// configuration is kept.
std::string ConfigSection::note_path(const std::string& key, const std::string& written)
{
    const std::string resolved = resolve(written);
    const bool ours = !is_virtual_path(resolved) && !has_driver_prefix(resolved);
    record(key, ours ? std::filesystem::absolute(resolved).string() : resolved, "");
    effective_->at(key).is_file = true;
    return resolved;
}

std::string ConfigSection::path(const std::string& key)
{
    const std::string* written = find_required(key, "a path");
    if (written->empty()) {
        refuse(key, "a path");
    }
    return note_path(key, *written);
}

std::optional<std::string> ConfigSection::optional_path(const std::string& key)
{
    return has(key) ? std::optional(path(key)) : std::nullopt;
}

std::string ConfigSection::path_or(const std::string& key, const std::string& default_value)
{
    return has(key) ? path(key) : note_path(key, default_value);
}

void ConfigSection::read_view(ImageSpec& spec)
{
    constexpr double kMostIncidence = 80;
    const auto azimuth = optional_number("azimuth_deg", -360, 360);
    const auto incidence = optional_number("incidence_deg", 0, kMostIncidence);
    const std::vector<double> vector =
        has("view_vector") ? numbers("view_vector", 2) : std::vector<double>{};
    if (azimuth.has_value() != incidence.has_value()) {
        fail(azimuth ? "azimuth_deg" : "incidence_deg",
             "says how the image was taken only together: give azimuth_deg and incidence_deg");
    }
    if (azimuth) {
        spec.view_deg = {*azimuth, *incidence};
    }
    if (!vector.empty()) {
        if (azimuth || std::abs(vector[0]) > 5 || std::abs(vector[1]) > 5) {
            fail("view_vector", azimuth ? "and azimuth_deg say the same: give one of them"
                                        : "must be [east, north] in metres that a ray moves "
                                          "per metre up, each within -5 to 5");
        }
        spec.view_vector = {vector[0], vector[1]};
    }
}

ImageSpec ConfigSection::image(const std::string& key)
{
    const ConfigNode* node = find(key);
    if (node == nullptr || node->kind == ConfigNode::Kind::null) {
        fail(key, "is missing; it must be a path or {path: ..., band: ..., nodata: ..., "
                  "mask: ...}.");
    }
    ImageSpec spec;
    if (node->kind == ConfigNode::Kind::scalar) {
        spec.path = path(key);
        effective_->at(key).is_image = true;
        return spec;
    }
    ConfigSection part = section(key);
    spec.path = part.path("path");
    part.effective_->at("path").is_image = true;
    spec.band = part.integer_or("band", "auto", std::nullopt, 1).value_or(0);
    if (part.has("nodata")) {
        spec.nodata =
            part.number_or("nodata", "none").value_or(std::numeric_limits<double>::quiet_NaN());
    }
    spec.mask = part.optional_path("mask").value_or("");
    spec.rpc = part.optional_path("rpc").value_or("");
    part.read_view(spec);
    return spec;
}

} // namespace hsgm::io
