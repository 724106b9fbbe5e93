#include "pipeline/stages/pair_stage.h"

#include "io/error.h"
#include "io/raster_source.h"
#include "pipeline/cancellable.h"
#include "pipeline/freed_memory.h"
#include "pipeline/stages/fingerprint_stage.h"
#include "pipeline/stages/pair_sources.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <charconv>
#include <filesystem>

namespace hsgm::pipeline {

namespace {

using ledger::Facts;

constexpr const char* kTones = "pair.tones";
constexpr const char* kHmiTable = "pair.hmi_table";

std::string text_of(const PairTones& tones)
{
    return fmt::format("{} {} {} {} {} {}", tones.left.lo, tones.left.hi, tones.left.noise,
                       tones.right.lo, tones.right.hi, tones.right.noise);
}

const std::string& fact(const Facts& facts, const char* name)
{
    const auto found = facts.find(name);
    if (found == facts.end()) {
        throw io::StorageError(fmt::format(
            "The ledger of the coarse stage has no '{}'; begin anew with --restart.", name));
    }
    return found->second;
}

PairTones tones_of(const Facts& facts)
{
    const std::string& text = fact(facts, kTones);
    std::array<int, 6> numbers{};
    const char* at = text.data();
    for (int& number : numbers) {
        at = std::from_chars(at, text.data() + text.size(), number).ptr + 1;
    }
    return {{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}};
}

std::string text_of(const matcher::HmiTable& table)
{
    std::string text;
    text.reserve(2 * table.cost.size());
    for (const std::uint8_t cost : table.cost) {
        text += "0123456789abcdef"[cost >> 4];
        text += "0123456789abcdef"[cost & 15];
    }
    return text;
}

std::shared_ptr<const matcher::HmiTable> hmi_table_of(const Facts& facts)
{
    const std::string& text = fact(facts, kHmiTable);
    auto table = std::make_shared<matcher::HmiTable>();
    for (std::size_t i = 0; i < table->cost.size() && 2 * i + 1 < text.size(); ++i) {
        std::from_chars(&text[2 * i], &text[2 * i] + 2, table->cost[i], 16);
    }
    return table;
}

matcher::PairTraits traits_of(const PlannedJob& planned, const PreparedPair& images)
{
    matcher::PairTraits pair;
    pair.shape = planned.shape;
    pair.left_tone = images.tones().left;
    pair.right_tone = images.tones().right;
    return pair;
}

bool needs_hmi(const PlannedJob& planned)
{
    return planned.job.matcher.cost == matcher::Cost::hmi;
}

// Whether the images that an earlier process prepared are all there.
bool are_there(const PlannedJob& planned, const RunLayout& layout, const OwnedLedger& book)
{
    if (!book.is_done("prepare")) {
        return false;
    }
    try {
        open_images(planned, layout, book->facts());
        return true;
    } catch (const io::StorageError& error) {
        spdlog::warn("{} The images are prepared again.", error.what());
        return false;
    }
}

void prepare_images(const PlannedJob& planned, const RunLayout& layout, const OwnedLedger& book,
                    bool durable)
{
    std::error_code none;
    std::filesystem::remove_all(layout.pair(), none);
    std::filesystem::create_directories(layout.pair(), none);
    const PairSources sources = open_sources(planned.job);
    const std::string stamp = stamp_of(planned); // whoever touches them from now on is noticed
    PairChecksums checksums;
    PreparedPair images(*sources.left, *sources.right, planned.pyramid_levels, layout.pair(),
                        checksums);
    if (durable) {
        images.sync();
    }
    book->set_facts({{kTones, text_of(images.tones())}});
    book->set_facts(pixel_facts(checksums, stamp));
}

void learn_hmi_table(const PlannedJob& planned, const RunLayout& layout,
                     const OwnedLedger& book)
{
    give_back_freed_memory(); // of the stage before
    const auto images = open_images(planned, layout, book->facts());
    const auto pixels = images->read_whole(matcher::hmi_level(planned.shape));
    std::shared_ptr<const matcher::HmiTable> table;
    run_until_stopped([&] {
        table = matcher::solve_hmi_table(traits_of(planned, *images), planned.job.matcher,
                                         pixels.left.pixels, pixels.right.pixels);
    });
    book->set_facts({{kHmiTable, text_of(*table)}});
}

} // namespace

void prepare_pair(const PlannedJob& planned, const RunLayout& layout, const OwnedLedger& book,
                  bool durable)
{
    const tiling::Rect whole = rect_of(planned.shape.left);
    if (!are_there(planned, layout, book)) {
        book.record("prepare", whole, [&] { prepare_images(planned, layout, book, durable); });
    }
    if (needs_hmi(planned) && !book.is_done("hmi")) {
        book.record("hmi", whole, [&] { learn_hmi_table(planned, layout, book); });
    }
}

std::unique_ptr<PreparedPair> open_images(const PlannedJob& planned, const RunLayout& layout,
                                          const Facts& facts)
{
    return std::make_unique<PreparedPair>(planned.shape, planned.pyramid_levels,
                                          tones_of(facts), layout.pair());
}

PairBasis open_pair(const PlannedJob& planned, const RunLayout& layout, const Facts& facts)
{
    std::shared_ptr<const PreparedPair> images = open_images(planned, layout, facts);
    matcher::PairTraits traits = traits_of(planned, *images);
    if (needs_hmi(planned)) {
        traits.hmi = hmi_table_of(facts);
    }
    auto matcher =
        std::make_shared<const matcher::Matcher>(std::move(traits), planned.job.matcher);
    return {std::move(images), std::move(matcher)};
}

std::shared_ptr<const matcher::CoarseSolution> solve_coarse(const PairBasis& pair)
{
    if (!pair.matcher->plan().coarsest_whole) {
        return pair.matcher->solve_coarse({}, {});
    }
    const auto pixels = pair.images->read_whole(pair.matcher->plan().levels() - 1);
    std::shared_ptr<const matcher::CoarseSolution> solution;
    run_until_stopped([&] {
        solution = pair.matcher->solve_coarse(pixels.left.pixels, pixels.right.pixels);
    });
    return solution;
}

} // namespace hsgm::pipeline
