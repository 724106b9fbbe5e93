#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace hsgm::structure {

/// The keys of a YAML map of maps by their dotted names, with their values as written; empty
/// for null, `[a, b]` for lists. Paths of keys that hold maps do not count.
std::map<std::string, std::string> flat_keys(const std::string& yaml);

/// The first and the third cell of every table row that begins with a key in backquotes:
/// "| `matcher.p1` | integer | 24 | ..." gives matcher.p1 -> 24.
std::map<std::string, std::string> documented_keys(const std::string& markdown);

/// The names of the properties of a JSON Schema, dotted, where they hold no properties of
/// their own.
std::set<std::string> schema_keys(const std::string& json);

/// The anchors that the headings of a page make, as GitHub spells them.
std::set<std::string> anchors(const std::string& markdown);

/// Targets of the inline links and pictures of a page, those with a scheme left out. Code
/// does not count.
std::vector<std::string> links(const std::string& markdown);

} // namespace hsgm::structure
