#include "matcher/instructions.h"

#include <hwy/targets.h>

#include <array>
#include <stdexcept>
#include <string>
#include <utility>

namespace hsgm::matcher {

namespace {

constexpr std::array<std::pair<Instructions, std::string_view>, 3> kSets{{
    {Instructions::avx512, "avx512"},
    {Instructions::avx2, "avx2"},
    {Instructions::sse4, "sse4"},
}};

// The set as Highway counts: a better target has a lower bit. AVX-512 comes in two kinds,
// of which a part of the matcher uses the better one.
std::int64_t best_target([[maybe_unused]] Instructions set)
{
#if HWY_ARCH_X86
    switch (set) {
    case Instructions::avx512:
        return HWY_AVX3;
    case Instructions::avx2:
        return HWY_AVX2;
    case Instructions::sse4:
        return HWY_SSE4;
    }
#endif
    return 0;
}

// What the processor has, whatever was asked for before.
std::int64_t all_targets()
{
    hwy::SetSupportedTargetsForTest(0);
    return hwy::SupportedTargets();
}

// Highway keeps the target it chose; this makes it choose again.
void choose_again()
{
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

} // namespace

std::string_view name(Instructions set)
{
    for (const auto& [entry, text] : kSets) {
        if (entry == set) {
            return text;
        }
    }
    return "?";
}

Instructions instructions_from_name(std::string_view name)
{
    for (const auto& [set, text] : kSets) {
        if (text == name) {
            return set;
        }
    }
    throw std::invalid_argument("instructions must be one of avx512, avx2, sse4, not '" +
                                std::string(name) + "'");
}

std::vector<Instructions> usable_instructions()
{
    const std::int64_t restricted = hwy::SupportedTargets();
    const std::int64_t there = all_targets();
    hwy::SetSupportedTargetsForTest(restricted);
    std::vector<Instructions> usable;
    for (const auto& [set, text] : kSets) {
        if ((there & best_target(set)) != 0) {
            usable.push_back(set);
        }
    }
    choose_again();
    return usable;
}

void use_instructions(std::optional<Instructions> set)
{
    const std::int64_t there = all_targets();
    if (set && (there & best_target(*set)) == 0) {
        choose_again();
        throw std::invalid_argument("this processor has no " + std::string(name(*set)));
    }
    if (set && *set != Instructions::avx512) {
        hwy::SetSupportedTargetsForTest(there & -best_target(*set));
    }
    choose_again();
}

} // namespace hsgm::matcher
