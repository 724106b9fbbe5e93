#include "matcher/options.h"

#include "matcher/kernel.h"

#include <array>
#include <stdexcept>
#include <utility>

namespace hsgm::matcher {

namespace {

constexpr std::array<std::pair<Mode, std::string_view>, 4> kModes{{
    {Mode::hsgm, "hsgm"},
    {Mode::hsgm_paper, "hsgm-paper"},
    {Mode::sgm, "sgm"},
    {Mode::local, "local"},
}};

constexpr std::array<std::pair<Cost, std::string_view>, 9> kCosts{{
    {Cost::census5x5, "census5x5"},
    {Cost::census7x7, "census7x7"},
    {Cost::census9x7, "census9x7"},
    {Cost::pairs5x5, "pairs5x5"},
    {Cost::ternary5x5, "ternary5x5"},
    {Cost::census_ad, "census_ad"},
    {Cost::pairs_bt, "pairs_bt"},
    {Cost::birchfield_tomasi, "birchfield_tomasi"},
    {Cost::hmi, "hmi"},
}};

constexpr std::array<std::pair<Subpixel, std::string_view>, 2> kSubpixels{{
    {Subpixel::census, "census"},
    {Subpixel::sums, "sums"},
}};

constexpr std::array<std::pair<Fill, std::string_view>, 3> kFills{{
    {Fill::none, "none"},
    {Fill::occluded, "occluded"},
    {Fill::all, "all"},
}};

template <typename Table, typename Value>
std::string_view name_in(const Table& table, Value value)
{
    for (const auto& [entry, text] : table) {
        if (entry == value) {
            return text;
        }
    }
    return "?";
}

template <typename Table>
auto value_in(const Table& table, std::string_view text, const char* what)
{
    std::string allowed;
    for (const auto& [entry, entry_name] : table) {
        if (entry_name == text) {
            return entry;
        }
        allowed += (allowed.empty() ? "" : ", ") + std::string(entry_name);
    }
    throw std::invalid_argument(std::string(what) + " must be one of " + allowed + ", not '" +
                                std::string(text) + "'");
}

void require(bool holds, const char* option, int value, const char* allowed)
{
    if (!holds) {
        throw std::invalid_argument(std::string(option) + " must be " + allowed + ", not " +
                                    std::to_string(value));
    }
}

} // namespace

void Options::validate() const
{
    require(paths == 4 || paths == 5 || paths == 8 || paths == 16, "paths", paths,
            "4, 5, 8 or 16");
    require(levels >= 0 && levels <= 12, "levels", levels, "auto or 1..12");
    require(window_px >= 16 && window_px <= 1024 && window_px % 16 == 0, "window", window_px,
            "a multiple of 16 from 16 to 1024");
    require(halo_px >= 0 && halo_px <= window_px && halo_px % 2 == 0, "halo", halo_px,
            "an even number from 0 to the window size");
    require(p2 >= 0 && p2 <= 4000, "p2", p2, "0..4000");
    require(p1 >= 0 && p1 <= p2, "p1", p1, "0..p2");
    require(p2_half_tone >= 1 && p2_half_tone <= 255, "p2_half_tone", p2_half_tone, "1..255");
    require(left_right_px >= -1 && left_right_px <= 64, "left_right_px", left_right_px,
            "off or 0..64");
    require(speckle_px == 0 || (speckle_px >= 2 && speckle_px <= 500), "speckle_px", speckle_px,
            "off or 2..500");
    require(speckle_range_px >= 1 && speckle_range_px <= 64, "speckle_range_px",
            speckle_range_px, "1..64");
    require(min_confidence >= 0 && min_confidence <= 255, "min_confidence", min_confidence,
            "0..255");
    require(fill_px >= 1 && fill_px <= 256, "fill_px", fill_px, "1..256");
    require(median == 1 || median == 3 || median == 5, "median", median, "1 (off), 3 or 5");
    require(smooth == 1 || smooth == 3 || smooth == 5, "smooth", smooth, "1 (off), 3 or 5");
}

Options Options::resolved() const
{
    Options o = *this;
    if (mode == Mode::hsgm_paper) {
        o.halo_px = 0;
    }
    if (mode != Mode::hsgm) {
        o.prior = false;
        o.prune = false;
    }
    if (mode == Mode::sgm || mode == Mode::local) {
        o.levels = 1;
    }
    return o;
}

bool Options::fits_8_bits() const
{
    return traits(cost).max + (prior ? kPriorMax : 0) + p2 <= 255;
}

std::string_view name(Mode mode)
{
    return name_in(kModes, mode);
}

std::string_view name(Cost cost)
{
    return name_in(kCosts, cost);
}

std::string_view name(Subpixel subpixel)
{
    return name_in(kSubpixels, subpixel);
}

std::string_view name(Fill fill)
{
    return name_in(kFills, fill);
}

Mode mode_from_name(std::string_view name)
{
    return value_in(kModes, name, "mode");
}

Cost cost_from_name(std::string_view name)
{
    return value_in(kCosts, name, "cost");
}

Subpixel subpixel_from_name(std::string_view name)
{
    return value_in(kSubpixels, name, "subpixel");
}

Fill fill_from_name(std::string_view name)
{
    return value_in(kFills, name, "fill");
}

std::vector<Cost> all_costs()
{
    std::vector<Cost> costs;
    for (const auto& [cost, text] : kCosts) {
        costs.push_back(cost);
    }
    return costs;
}

CostTraits traits(Cost cost)
{
    switch (cost) {
    case Cost::census5x5:
        return {48, 2, 2};
    case Cost::census7x7:
        return {48, 3, 3};
    case Cost::census9x7:
        return {59, 3, 4};
    case Cost::ternary5x5:
        return {48, 2, 2};
    case Cost::pairs5x5:
    case Cost::census_ad:
    case Cost::pairs_bt:
        return {59, 2, 2};
    case Cost::birchfield_tomasi:
        return {58, 2, 3};
    case Cost::hmi:
        return {48, 0, 0};
    }
    throw std::logic_error("traits: no such cost");
}

} // namespace hsgm::matcher
