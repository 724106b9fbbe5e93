#include "pipeline/configuration.h"

#include "io/error.h"
#include "matcher/profile.h"
#include "pipeline/budget.h"
#include "pipeline/device_plan.h"
#include "pipeline/error.h"
#include "pipeline/satellite_configuration.h"

#include <fmt/format.h>

#include <stdexcept>

namespace hsgm::pipeline {

namespace {

using io::ConfigSection;

matcher::Options read_matcher(ConfigSection section)
{
    const std::string profile =
        section.choice("profile", "satellite", {"satellite", "aerial", "close"});
    matcher::Options o = options_of(matcher::profile_from_name(profile));
    o.mode = matcher::mode_from_name(
        section.choice("mode", "hsgm", {"hsgm", "hsgm-paper", "sgm", "local"}));
    o.cost = matcher::cost_from_name(
        section.choice("cost", std::string(name(o.cost)),
                       {"census5x5", "census7x7", "census9x7", "pairs5x5", "ternary5x5",
                        "census_ad", "pairs_bt", "birchfield_tomasi", "hmi"}));
    o.paths =
        std::stoi(section.choice("paths", std::to_string(o.paths), {"4", "5", "8", "16"}));
    o.levels = section.integer_or("levels", "auto", std::nullopt, 1, 12).value_or(0);
    o.window_px = section.integer("window", o.window_px, 16, 1024);
    o.halo_px = section.integer("halo", o.halo_px, 0, 1024);
    o.p1 = section.integer("p1", o.p1, 0, 4000);
    o.p2 = section.integer("p2", o.p2, 0, 4000);
    o.p2_half_tone = section.integer("p2_half_tone", o.p2_half_tone, 1, 255);
    o.prior = section.flag("prior", o.prior);
    o.prune = section.flag("prune", o.prune);
    o.left_right_px =
        section.integer_or("left_right_px", "off", o.left_right_px, 0, 64).value_or(-1);
    o.speckle_px = section.integer_or("speckle_px", "off", o.speckle_px, 2, 500).value_or(0);
    o.speckle_range_px = section.integer("speckle_range_px", o.speckle_range_px, 1, 64);
    o.subpixel =
        matcher::subpixel_from_name(section.choice("subpixel", "census", {"census", "sums"}));
    o.min_confidence = section.integer("min_confidence", o.min_confidence, 0, 255);
    o.median = section.integer_or("median", "off", o.median, 1, 5).value_or(1);
    o.smooth = section.integer_or("smooth", "off", o.smooth, 1, 5).value_or(1);
    o.fill =
        matcher::fill_from_name(section.choice("fill", "none", {"none", "occluded", "all"}));
    o.fill_px = section.integer("fill_px", o.fill_px, 1, 256);
    try {
        o.validate();
    } catch (const std::invalid_argument& error) {
        // "p1 must be ...": the option, named like its key, and what is wrong with it.
        const std::string sentence = error.what();
        const std::size_t space = sentence.find(' ');
        section.fail(sentence.substr(0, space), sentence.substr(space + 1));
    }
    return o;
}

tiling::TileOrder read_order(ConfigSection& section)
{
    const std::string order =
        section.choice("order", "rows", {"rows", "columns", "reversed", "shuffled"});
    if (order == "columns") {
        return tiling::TileOrder::columns;
    }
    if (order == "reversed") {
        return tiling::TileOrder::reversed;
    }
    return order == "shuffled" ? tiling::TileOrder::shuffled : tiling::TileOrder::rows;
}

// The device must be one that this build and this machine have.
std::string read_device(ConfigSection& section)
{
    const std::string device = section.text("device", "auto");
    DeviceChoice choice;
    try {
        choice = device_choice(device);
    } catch (const std::invalid_argument& error) {
        section.fail("device", fmt::format("is '{}'; {}", device, error.what()));
    }
    chosen_devices(choice, fmt::format("{}: '{}' is '{}'", section.place_of("device"),
                                       section.name_of("device"), device));
    return device;
}

RunOptions read_run(ConfigSection section)
{
    constexpr int kLargestTile = 1 << 20;
    RunOptions run;
    run.tile_size_px = section.integer_or("tile_size", "auto", std::nullopt, 0, kLargestTile);
    run.order = read_order(section);
    run.threads = section.integer_or("threads", "auto", std::nullopt, 1, 1024).value_or(0);
    const auto memory = section.byte_amount("memory", "80%");
    run.memory_bytes = memory.of(available_memory_bytes());
    run.tile_limit_s =
        section.number_or("tile_limit_s", "off", std::nullopt, 1e-3, 1e9).value_or(0);
    run.device = read_device(section);
    return run;
}

RectifiedGeometry read_geometry(ConfigSection section, const std::string& kind)
{
    RectifiedGeometry geometry;
    geometry.height_per_px_m = section.optional_number("height_per_px_m");
    if (geometry.height_per_px_m == 0.0) {
        section.fail("height_per_px_m", "is 0, which makes all heights equal; leave it out for "
                                        "disparities alone");
    }
    geometry.focal_px = section.optional_number("focal_px", 1e-9);
    geometry.baseline_m = section.optional_number("baseline_m", 1e-9);
    const auto reference = section.optional_number("reference_height_m");
    // Of orthoimages it is the plane that they were made on.
    if (reference && !geometry.height_per_px_m && kind != "ortho") {
        section.fail("reference_height_m", "has no meaning without height_per_px_m: "
                                           "give both, or neither");
    }
    geometry.reference_height_m = reference.value_or(0);
    if (geometry.focal_px.has_value() != geometry.baseline_m.has_value()) {
        section.fail(geometry.focal_px ? "focal_px" : "baseline_m",
                     "gives a depth only together: set both focal_px and baseline_m");
    }
    if (geometry.focal_px && geometry.height_per_px_m) {
        section.fail("focal_px",
                     "makes a depth and height_per_px_m a height: give one of them");
    }
    return geometry;
}

OutputPaths output_paths(const std::filesystem::path& folder, const Job& job, bool hillshade,
                         bool quicklooks)
{
    const RectifiedGeometry& geometry = job.geometry;
    OutputPaths outputs;
    outputs.disparity = folder / "disparity.tif";
    outputs.confidence = folder / "confidence.tif";
    outputs.reasons = folder / "reasons.tif";
    if (job.satellite) {
        outputs.residual = folder / "residual.tif";
        outputs.dsm = folder / "dsm.tif";
        outputs.dsm_confidence = folder / "dsm.confidence.tif";
        outputs.dsm_points = folder / "dsm.points.tif";
        outputs.dsm_spread = folder / "dsm.spread.tif";
        outputs.dsm_reasons = folder / "dsm.reasons.tif";
    }
    if (geometry.height_per_px_m || job.satellite) {
        outputs.height = folder / "height.tif";
        if (hillshade) {
            outputs.hillshade = folder / "hillshade.tif";
        }
    }
    if (geometry.focal_px) {
        outputs.depth = folder / "depth.tif";
    }
    if (quicklooks) {
        outputs.disparity_picture = folder / "disparity.png";
        if (!outputs.hillshade.empty()) {
            outputs.hillshade_picture = folder / "hillshade.png";
        }
    }
    return outputs;
}

// What a configuration must say. Asked for last, so that a misspelt key is named as such
// rather than as the one that is missing.
void require_kind(const ConfigSection& section, const std::string& kind)
{
    if (kind.empty()) {
        section.fail("kind", "is missing: it must be rectified, rpc or ortho in this version");
    }
    if (kind != "rectified" && kind != "rpc" && kind != "ortho") {
        section.fail(
            "kind",
            fmt::format("must be rectified, rpc or ortho in this version, not '{}'", kind));
    }
}

// What orthoimages were made on.
void require_base(const ConfigSection& section, const Job& job)
{
    if (job.satellite && job.satellite->search.ortho && !job.satellite->search.ortho->plane_m &&
        !job.satellite->dem) {
        section.fail("kind", "is ortho, so what the orthoimages were made on must be given: "
                             "reference_height_m for a plane, or reference_dem");
    }
}

// Rectified pairs need it; of raw ones the program finds it from the heights.
tiling::DisparityRange require_disparity(const ConfigSection& section,
                                         const std::optional<std::pair<int, int>>& range,
                                         const Job& job)
{
    if (job.satellite) {
        if (range) {
            section.fail("disparity", "is found by the program for geometry rpc and ortho: "
                                      "leave it out, or give geometry.heights_m");
        }
        return {};
    }
    if (!range) {
        section.fail("disparity", "must be given as [min, max] in pixels for geometry "
                                  "rectified, which holds no heights to find it from");
    }
    return {range->first, range->second};
}

// Keys of one kind that say something in another.
void refuse_mixtures(const ConfigSection& pair, const ConfigSection& geometry, const Job& job)
{
    if (job.satellite && (job.geometry.height_per_px_m || job.geometry.focal_px)) {
        geometry.fail(job.geometry.focal_px ? "focal_px" : "height_per_px_m",
                      "is for geometry kind rectified only: leave it out");
    }
    const bool ortho = job.satellite && job.satellite->search.ortho;
    for (const auto& [image, name] : {std::pair(&job.left, "left"), {&job.right, "right"}}) {
        if (!job.satellite && !image->rpc.empty()) {
            pair.fail(std::string(name) + ".rpc",
                      "is for geometry kind rpc or ortho only: leave it out");
        }
        if (!ortho && (image->view_deg || image->view_vector)) {
            pair.fail(std::string(name) + (image->view_deg ? ".azimuth_deg" : ".view_vector"),
                      "is for geometry kind ortho only: leave it out");
        }
    }
}

// Whether the penalties are fitted to how alike the images are. Said in the configuration that
// the run keeps, so that its p1 and p2 mean there what they meant here.
bool read_fit(ConfigSection& matcher, const std::string& kind)
{
    const bool raw = kind == "rpc" || kind == "ortho";
    const bool given = matcher.has("p1") || matcher.has("p2") || matcher.has("p2_half_tone");
    const bool fit = matcher.choice("penalties", raw && !given ? "auto" : "fixed",
                                    {"auto", "fixed"}) == "auto";
    if (fit && kind == "rectified") {
        matcher.fail("penalties", "is 'auto', which is for geometry kind rpc or ortho only: "
                                  "leave it out, or give p1 and p2");
    }
    return fit;
}

} // namespace

Job read_knobs(io::ConfigDocument& document)
{
    ConfigSection root = document.root();
    Job job;
    job.matcher = read_matcher(root.section("matcher"));
    job.run = read_run(root.section("run"));
    return job;
}

Configuration read_configuration(io::ConfigDocument& document)
{
    ConfigSection root = document.root();
    ConfigSection pair = root.section("pair");
    ConfigSection geometry = root.section("geometry");
    ConfigSection output = root.section("output");
    ConfigSection matcher = root.section("matcher");
    Configuration configuration;
    Job& job = configuration.job;
    job = read_knobs(document);
    const std::string kind = geometry.text("kind", "");
    const auto disparity = matcher.range_or("disparity", "auto");
    const bool fit_penalties = read_fit(matcher, kind);
    if (root.has("images") || root.has("pairs")) {
        root.fail(root.has("images") ? "images" : "pairs",
                  "is for several pairs of one area, which hsgm run alone takes, with `images` "
                  "and without `pair`");
    }
    job.geometry = read_geometry(geometry, kind);
    job.satellite = read_satellite(geometry, root.section("dsm"), kind);
    if (job.satellite) {
        job.satellite->search.likeness = fit_penalties;
    }
    const auto creation_options = output.texts("creation_options");
    const bool hillshade = output.flag("hillshade", true);
    const bool quicklooks = output.flag("quicklooks", false);
    const bool has_left = pair.has("left");
    const bool has_right = pair.has("right");
    const bool has_folder = output.has("folder");
    if (has_left && has_right && has_folder) {
        job.left = pair.image("left");
        job.right = pair.image("right");
        configuration.folder = output.path("folder");
    }
    document.refuse_unknown();
    require_kind(geometry, kind);
    require_base(geometry, job);
    job.disparity = require_disparity(matcher, disparity, job);
    job.left = pair.image("left");
    job.right = pair.image("right");
    refuse_mixtures(pair, geometry, job);
    configuration.folder = output.path("folder");
    job.outputs = output_paths(configuration.folder, job, hillshade, quicklooks);
    job.outputs.creation_options = creation_options;
    configuration.used_yaml = document.effective_yaml();
    return configuration;
}

} // namespace hsgm::pipeline
