#include "tests/structure/include_rules.h"

#include <algorithm>
#include <map>
#include <optional>
#include <regex>
#include <set>

namespace hsgm::structure {

namespace {

// The part of the architecture that a file belongs to, by its path from the root; empty
// for none.
std::string module_of(const std::string& path)
{
    static const std::vector<std::string> kModules{"pipeline/geometry",
                                                   "pipeline/dsm",
                                                   "pipeline/synth",
                                                   "pipeline/evaluate",
                                                   "pipeline/ledger",
                                                   "pipeline",
                                                   "matcher",
                                                   "io",
                                                   "tiling",
                                                   "tests"};
    for (const std::string& module : kModules) {
        if (path.starts_with(module + "/")) {
            return module;
        }
    }
    return "";
}

// The modules that each module may include, besides itself.
bool may_include(const std::string& from, const std::string& to)
{
    static const std::map<std::string, std::set<std::string>> kLines{
        {"tiling", {}},
        {"io", {"tiling"}},
        {"matcher", {"tiling"}},
        {"pipeline/geometry", {"tiling"}},
        {"pipeline/dsm", {"tiling"}},
        {"pipeline/synth", {"tiling", "pipeline/geometry"}},
        {"pipeline/evaluate", {"tiling", "pipeline/geometry"}},
        {"pipeline/ledger", {"tiling", "io"}},
    };
    if (from == to || from == "tests") {
        return true;
    }
    if (to == "tests") {
        return false;
    }
    const auto line = kLines.find(from);
    return line == kLines.end() || line->second.contains(to);
}

// Which of the libraries that rules speak of a header belongs to.
std::optional<std::string> library_of(const std::string& header)
{
    static const std::vector<std::pair<std::string, std::regex>> kLibraries{
        {"GDAL", std::regex(R"(^(gdal/)?(gdal|ogr|cpl_|vrtdataset|memdataset|gnm).*\.h$)")},
        {"PROJ",
         std::regex(R"(^(proj/.*|proj|proj_api|proj_experimental|geodesic)(\.h|\.hpp)?$)")},
        {"OpenCV", std::regex(R"(^opencv.*)")},
    };
    for (const auto& [library, pattern] : kLibraries) {
        if (std::regex_search(header, pattern)) {
            return library;
        }
    }
    return std::nullopt;
}

bool is_private(const std::string& path)
{
    return path.ends_with("_private.h");
}

// A header that others may include, and that is installed.
bool is_public(const std::string& path)
{
    return (path.ends_with(".h") || path.ends_with(".cuh")) && !is_private(path);
}

std::string broken_rule_of_quoted(const std::string& path, const std::string& included)
{
    const std::string module = module_of(path);
    const std::string target = module_of(included);
    if (target.empty()) {
        return "a quoted include names a file of ours by its path from the root";
    }
    if (!may_include(module, target)) {
        return module + " must not include " + target;
    }
    if (is_private(included) && module != "tests" && (is_public(path) || module != target)) {
        return "a private header is for the sources of its module";
    }
    return "";
}

std::string broken_rule_of_bracketed(const std::string& path, const std::string& included)
{
    const std::string module = module_of(path);
    if (module == "tests") {
        return "";
    }
    if (!module_of(included).empty()) {
        return "files of ours are included in quotes";
    }
    // Where pixels lie is asked of the system.
    if (module == "tiling" && included.find_first_of("./") != std::string::npos &&
        included != "sys/mman.h") {
        return "tiling stands on the standard library alone";
    }
    const auto library = library_of(included);
    if (!library) {
        return "";
    }
    if (*library == "GDAL" && module != "io") {
        return "only io names GDAL";
    }
    if (module == "matcher") {
        return "matcher knows no " + *library;
    }
    return is_public(path) ? *library + " stays out of public headers" : "";
}

} // namespace

std::vector<std::string> include_violations(const SourceFile& file)
{
    static const std::regex kInclude(R"(^\s*#\s*include\s*(["<])([^">]+)[">])");
    std::vector<std::string> violations;
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
        std::smatch match;
        if (!std::regex_search(file.lines[i], match, kInclude)) {
            continue;
        }
        const std::string included = match[2];
        const std::string broken = match[1] == "\""
                                       ? broken_rule_of_quoted(file.path, included)
                                       : broken_rule_of_bracketed(file.path, included);
        if (!broken.empty()) {
            violations.push_back(file.path + ":" + std::to_string(i + 1) + ": " + broken +
                                 " (" + included + ")");
        }
    }
    return violations;
}

} // namespace hsgm::structure
