#include "pipeline/commands/bench_arguments.h"

#include "io/error.h"
#include "pipeline/commands/range_argument.h"
#include "pipeline/configuration.h"
#include "pipeline/device_plan.h"
#include "pipeline/error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>

namespace hsgm::pipeline {

namespace {

using bench::BenchSettings;

// Puts the option before what a parser of names says about it.
template <typename Parse>
auto parsed(const char* option, Parse parse)
{
    try {
        return parse();
    } catch (const std::invalid_argument& refused) {
        throw io::ConfigError(fmt::format("{}: {}", option, refused.what()));
    }
}

// `auto` measures the devices there are.
std::vector<matcher::cuda::DeviceInfo> devices_of(const std::string& device)
{
    const std::string what = fmt::format("--device is '{}'", device);
    try {
        return chosen_devices(device_choice(device), what).usable;
    } catch (const std::invalid_argument& refused) {
        throw io::ConfigError(fmt::format("{}; {}", what, refused.what()));
    }
}

matcher::Options matcher_options(const std::vector<std::string>& overrides)
{
    auto document = io::ConfigDocument::empty("command line");
    for (const std::string& assignment : overrides) {
        if (!assignment.starts_with("matcher.")) {
            throw io::ConfigError(
                fmt::format("--set {}: bench takes keys of `matcher` alone; its "
                            "own options say the rest",
                            assignment));
        }
        document.set(assignment);
    }
    const Job job = read_knobs(document);
    document.refuse_unknown();
    return job.matcher;
}

std::vector<matcher::Cost> costs_of(const BenchArguments& a, matcher::Cost base)
{
    std::vector<matcher::Cost> costs;
    for (const std::string& text : a.costs) {
        if (text != "all") {
            costs.push_back(parsed("--cost", [&] { return matcher::cost_from_name(text); }));
        }
    }
    const bool all = a.costs.empty()
                         ? !a.quick
                         : std::find(a.costs.begin(), a.costs.end(), "all") != a.costs.end();
    if (costs.empty()) {
        costs.push_back(base);
    }
    for (const matcher::Cost cost : all ? matcher::all_costs() : std::vector<matcher::Cost>{}) {
        if (std::find(costs.begin(), costs.end(), cost) == costs.end()) {
            costs.push_back(cost);
        }
    }
    return costs;
}

std::vector<matcher::Instructions> instructions_of(const BenchArguments& a)
{
    const auto usable = matcher::usable_instructions();
    if (a.instructions.empty() || usable.empty()) {
        return usable;
    }
    std::vector<matcher::Instructions> sets;
    for (const std::string& text : a.instructions) {
        if (text == "auto") {
            sets.push_back(usable.front());
            continue;
        }
        const auto set =
            parsed("--instructions", [&] { return matcher::instructions_from_name(text); });
        if (std::find(usable.begin(), usable.end(), set) == usable.end()) {
            throw io::ConfigError(fmt::format("--instructions {}: this processor has not got "
                                              "them; its best are {}",
                                              text, name(usable.front())));
        }
        sets.push_back(set);
    }
    return sets;
}

std::vector<int> threads_of(const BenchArguments& a)
{
    const int all = tbb::info::default_concurrency();
    if (a.threads.empty()) {
        return all > 1 ? std::vector<int>{1, all} : std::vector<int>{1};
    }
    std::vector<int> counts;
    for (const std::string& text : a.threads) {
        int count = all;
        if (text != "all" &&
            (!CLI::detail::lexical_cast(text, count) || count < 1 || count > 1024)) {
            throw io::ConfigError(fmt::format(
                "--threads is '{}'; it must be all, or whole numbers from 1 to 1024", text));
        }
        counts.push_back(count);
    }
    return counts;
}

std::vector<bench::Peer> peers_of(const BenchArguments& a)
{
    if (a.peers.empty()) {
        return a.quick ? std::vector{bench::Peer::hh, bench::Peer::three_way}
                       : bench::all_peers();
    }
    if (a.peers.size() == 1 && (a.peers[0] == "none" || a.peers[0] == "all")) {
        return a.peers[0] == "all" ? bench::all_peers() : std::vector<bench::Peer>{};
    }
    std::vector<bench::Peer> peers;
    for (const std::string& text : a.peers) {
        peers.push_back(parsed("--peers", [&] { return bench::peer_from_name(text); }));
    }
    return peers;
}

// The pairs of a rendered scene: hills would be too steep, and peers count in sixteens.
void check_sizes(const BenchSettings& s)
{
    for (const int disparities : s.disparities) {
        if (!s.peers.empty() && disparities % 16 != 0) {
            throw io::ConfigError(fmt::format("--disparities is {}; beside OpenCV it must be a "
                                              "multiple of 16 (or --peers none)",
                                              disparities));
        }
        for (const int side : s.sides_px) {
            if (disparities > side / 4) {
                throw io::ConfigError(
                    fmt::format("--disparities is {}; in an image of {} px it "
                                "must be at most a quarter of that, {}",
                                disparities, side, side / 4));
            }
        }
    }
}

void set_pair(const BenchArguments& a, BenchSettings& s)
{
    s.left = a.left;
    s.right = a.right;
    if (a.left.empty()) {
        if (!a.disparity.empty()) {
            throw io::ConfigError("--disparity is for two images that are given; a rendered "
                                  "pair takes --disparities N");
        }
        s.sides_px = a.sides.empty() ? std::vector{a.quick ? 768 : 2048} : a.sides;
        s.disparities = a.disparities.empty() ? std::vector{128} : a.disparities;
        check_sizes(s);
        return;
    }
    if (a.right.empty()) {
        throw io::ConfigError("RIGHT is missing: give two images, or none for a rendered pair");
    }
    if (a.disparity.empty() || !a.sides.empty() || !a.disparities.empty()) {
        throw io::ConfigError("two images take --disparity MIN,MAX and neither --side nor "
                              "--disparities");
    }
    s.asked = parse_range(a.disparity);
}

// A list such as 1,all: one argument, so that what follows it stays an argument of its own.
template <typename Values>
CLI::Option* add_list(CLI::App& command, const char* option, Values& values, const char* help)
{
    return command.add_option(option, values, help)->delimiter(',')->allow_extra_args(false);
}

void add_pair_options(CLI::App& command, BenchArguments& a)
{
    command.add_option("LEFT", a.left, "left image; without images a scene is rendered");
    command.add_option("RIGHT", a.right, "right image");
    command.add_option("--disparity", a.disparity, "range of the two images: MIN,MAX in px")
        ->allow_extra_args(false);
    command.add_option("--scene", a.scene, "what to render: town or towers")
        ->check(CLI::IsMember({"town", "towers"}))
        ->capture_default_str();
    add_list(command, "--side", a.sides, "sides of the rendered pair in px (2048)")
        ->check(CLI::Range(64, 65536));
    add_list(command, "--disparities", a.disparities, "disparities 0..N-1 to search (128)")
        ->check(CLI::Range(1, 16000));
}

void add_contender_options(CLI::App& command, BenchArguments& a)
{
    add_list(command, "--cost", a.costs, "matching costs, or all (all)");
    add_list(command, "--instructions", a.instructions,
             "vector instructions: auto, avx512, avx2, sse4 (all that the processor has)");
    add_list(command, "--threads", a.threads, "numbers of threads (1,all)");
    add_list(command, "--peers", a.peers, "none, all or some of hh, hh4, sgbm, 3way (all)");
    command.add_option("--tile-size", a.tile_size_px, "side of a tile in px, 0 = untiled")
        ->check(CLI::Range(0, 1 << 20))
        ->capture_default_str();
    command
        .add_option("--device", a.device,
                    "auto, cpu, cuda or cuda:N: measured beside the processor")
        ->capture_default_str();
    command.add_option("--set", a.overrides, "override a key of matcher: --set matcher.p2=160")
        ->allow_extra_args(false)
        ->take_all();
}

} // namespace

void add_bench_options(CLI::App& command, BenchArguments& a)
{
    add_pair_options(command, a);
    add_contender_options(command, a);
    command.add_option("--repeats", a.repeats, "timed runs of each")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command.add_flag("--quick", a.quick,
                     "768 px, one cost, peers hh and 3way, unless told otherwise");
    command.add_flag("--whole", a.whole, "measure the match from files to files, too");
    command.add_flag("--json", a.json, "print JSON");
}

bench::BenchSettings bench_settings(const BenchArguments& a)
{
    BenchSettings s;
    s.devices = devices_of(a.device);
    s.scene = a.scene;
    s.options = matcher_options(a.overrides);
    s.costs = costs_of(a, s.options.cost);
    s.instructions = instructions_of(a);
    s.threads = threads_of(a);
    s.peers = peers_of(a);
    s.tile_size_px = a.tile_size_px;
    s.repeats = a.repeats;
    s.whole = a.whole;
    set_pair(a, s);
    return s;
}

} // namespace hsgm::pipeline
