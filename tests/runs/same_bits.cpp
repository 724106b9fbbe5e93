#include "tests/runs/same_bits.h"

#include "pipeline/ledger/checksum.h"
#include "tests/catch.h"
#include "tests/end_to_end/program.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace hsgm::tests {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr double kMiB = 1 << 20;

Sums sums_in(const fs::path& folder)
{
    Sums sums;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string ending = entry.path().extension().string();
        if (ending == ".tif" || ending == ".png") {
            sums[entry.path().filename().string()] = ledger::sha256_of_file(entry.path());
        }
    }
    return sums;
}

void make_scene(const TemporaryFolder& folder, const std::string& scene,
                const std::string& size)
{
    const Outcome made =
        run_hsgm({"--log-level", "warn", "synth", std::string(HSGM_CONFIGS_DIR) + "/" + scene,
                  "-o", folder / "scene", "--set", "size=" + size});
    INFO(made.err);
    REQUIRE(made.code == 0);
}

std::string joined(const std::vector<std::string>& words)
{
    std::string text;
    for (const std::string& word : words) {
        text += " " + word;
    }
    return text;
}

} // namespace

SameBits::SameBits(const std::string& size, const std::string& range)
{
    make_scene(folder_, "scene-city.yaml", size);
    put_bytes(folder_ / "run.yaml", "pair: {left: scene/left.tif, right: scene/right.tif}\n"
                                    "geometry: {kind: rectified, height_per_px_m: 0.5}\n"
                                    "output: {folder: result, quicklooks: true}\n"
                                    "matcher: {disparity: " +
                                        range + "}\n");
}

SameBits::SameBits(const std::string& map_size)
{
    make_scene(folder_, "scene-orbit.yaml", map_size);
    put_bytes(folder_ / "run.yaml", "pair: {left: scene/left.tif, right: scene/right.tif}\n"
                                    "geometry: {kind: rpc}\n"
                                    "output: {folder: result, quicklooks: true}\n");
}

std::vector<std::string> SameBits::command(const std::string& verb,
                                           const std::vector<std::string>& words) const
{
    std::vector<std::string> all{verb, folder_ / "run.yaml"};
    all.insert(all.end(), words.begin(), words.end());
    return all;
}

json SameBits::plan(std::vector<std::string> words) const
{
    words.insert(words.end(), {"--json", "--no-time"});
    const Outcome outcome = run_hsgm(command("plan", words));
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    json plan = json::parse(outcome.out);
    CHECK(plan["memory_bytes"]["estimate"] <= plan["memory_bytes"]["allowed"]);
    return plan;
}

int SameBits::tile_size(const std::vector<std::string>& words) const
{
    return plan(words)["tile_size_px"];
}

void SameBits::process(const std::string& name, const std::vector<std::string>& words,
                       std::int64_t bound_bytes)
{
    const Outcome outcome = run_hsgm(command("run", words));
    INFO(name << ": " << outcome.err);
    REQUIRE(outcome.code == 0);
    std::printf("%-44s peak %4.0f MiB, planned %4.0f\n", name.c_str(),
                static_cast<double>(outcome.peak_bytes) / kMiB,
                static_cast<double>(bound_bytes) / kMiB);
    std::fflush(stdout);
    CHECK(outcome.peak_bytes <= bound_bytes);
}

void SameBits::compare(const std::string& name)
{
    const Sums sums = sums_in(folder_ / "result");
    INFO(name);
    REQUIRE(sums.size() >= 6);
    if (first_.empty()) {
        first_ = sums;
        for (const auto& [file, sum] : sums) {
            std::printf("%s  %s\n", sum.c_str(), file.c_str());
        }
    }
    CHECK(sums == first_);
    // What the run says of itself.
    std::ifstream file(folder_ / "result/run.json");
    const json record = json::parse(file);
    CHECK(record["outputs"].size() == sums.size());
    for (const auto& [output, entry] : record["outputs"].items()) {
        INFO(output);
        REQUIRE(sums.contains(output));
        CHECK(entry["sha256"] == sums.at(output));
    }
    fs::remove_all(folder_ / "result");
}

void SameBits::run(const std::vector<std::string>& words)
{
    const std::string name = "run" + joined(words);
    process(name, words, plan(words)["memory_bytes"]["estimate"]);
    compare(name);
}

void SameBits::run_in_shards(int count, const std::vector<std::string>& words)
{
    std::vector<std::string> planning = words;
    planning.insert(planning.end(), {"--shards", std::to_string(count)});
    const json parts = plan(planning)["parts"];
    REQUIRE(parts.size() == static_cast<std::size_t>(count) + 2);
    for (const json& part : parts) {
        const std::string name = part["part"];
        std::vector<std::string> more = words;
        const auto space = name.find(' ');
        more.insert(more.end(), {"--stage", name.substr(0, space)});
        if (space != std::string::npos) {
            more.insert(more.end(), {"--shard", name.substr(space + 1)});
        }
        process(name, more, part["memory_bytes"]);
    }
    compare(std::to_string(count) + " shards");
}

void SameBits::refused(const std::vector<std::string>& words)
{
    const Outcome outcome = run_hsgm(command("run", words));
    INFO(outcome.err);
    CHECK(outcome.code == 4);
    CHECK(outcome.err.find(" of memory, but may take ") != std::string::npos);
    CHECK_FALSE(fs::exists(folder_ / "result"));
}

} // namespace hsgm::tests
