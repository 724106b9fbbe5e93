#include "pipeline/stages/run_layout.h"

#include "pipeline/ledger/succession.h"

#include <algorithm>
#include <regex>
#include <system_error>
#include <tuple>

namespace hsgm::pipeline {

namespace {

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder)
{
    std::vector<std::filesystem::path> files;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
        files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

} // namespace

std::string name(tiling::Shard shard)
{
    return std::to_string(shard.index) + "-of-" + std::to_string(shard.count);
}

std::filesystem::path RunLayout::coarse_ledger() const
{
    return ledger::latest_of(ledgers() / "coarse.sqlite");
}

std::filesystem::path RunLayout::assemble_ledger() const
{
    return ledger::latest_of(ledgers() / "assemble.sqlite");
}

std::filesystem::path RunLayout::tiles_ledger(tiling::Shard shard) const
{
    return ledger::latest_of(ledgers() / ("tiles-" + name(shard) + ".sqlite"));
}

std::filesystem::path RunLayout::part(tiling::Shard shard, int number) const
{
    return work() / ("tiles-" + name(shard)) / std::to_string(number);
}

std::vector<tiling::Shard> RunLayout::shards() const
{
    static const std::regex kName(R"(tiles-(\d{1,9})-of-(\d{1,9})\.sqlite)");
    std::vector<tiling::Shard> found;
    for (const auto& file : files_in(ledgers())) {
        std::smatch match;
        const std::string file_name = file.filename().string();
        if (std::regex_match(file_name, match, kName)) {
            found.push_back({std::stoi(match[1]), std::stoi(match[2])});
        }
    }
    std::sort(found.begin(), found.end(), [](tiling::Shard a, tiling::Shard b) {
        return std::tie(a.count, a.index) < std::tie(b.count, b.index);
    });
    return found;
}

std::vector<std::filesystem::path> RunLayout::all_ledgers() const
{
    std::vector<std::filesystem::path> ledgers_there = files_in(ledgers());
    std::erase_if(ledgers_there,
                  [](const auto& file) { return file.extension() != ".sqlite"; });
    return ledgers_there;
}

} // namespace hsgm::pipeline
