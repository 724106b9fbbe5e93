#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace hsgm::matcher {

/// Sets of vector instructions that the matcher is compiled for, each holding those before
/// it. All give the same bits.
enum class Instructions { sse4, avx2, avx512 };

/// "sse4", "avx2", "avx512".
std::string_view name(Instructions set);
/// The set of that name; throws std::invalid_argument listing the names there are.
Instructions instructions_from_name(std::string_view name);

/// The sets that this processor has, best first; none where it is not an x86-64 one.
std::vector<Instructions> usable_instructions();

/// Makes the matcher use nothing beyond `set`; nothing given: the best there is, which it
/// does on its own. Holds for the whole process from the next match on, so call it while
/// none is at work. For measurements. Throws std::invalid_argument where the processor lacks
/// the set.
void use_instructions(std::optional<Instructions> set);

} // namespace hsgm::matcher
