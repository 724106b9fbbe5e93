// The rules of the house that a machine can read: who includes whom, which folders there
// are, how long a file may grow, and that nothing is left half done. Each checker is first
// shown something that breaks its rule.

#include "tests/catch.h"
#include "tests/structure/include_rules.h"
#include "tests/structure/source_tree.h"

#include <algorithm>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

using hsgm::structure::include_violations;
using hsgm::structure::read_sources;
using hsgm::structure::SourceFile;
using hsgm::structure::split_lines;
using hsgm::structure::top_folders;

const std::string kRoot = HSGM_SOURCE_DIR;
constexpr std::size_t kMaxLines = 450;

using Sentences = std::vector<std::string>;

template <typename Checker>
Sentences over_all_sources(Checker checker)
{
    Sentences all;
    for (const SourceFile& file : read_sources(kRoot)) {
        const Sentences found = checker(file);
        all.insert(all.end(), found.begin(), found.end());
    }
    return all;
}

Sentences too_long(const SourceFile& file)
{
    if (file.lines.size() <= kMaxLines) {
        return {};
    }
    return {file.path + " has " + std::to_string(file.lines.size()) + " lines, more than " +
            std::to_string(kMaxLines)};
}

Sentences unfinished_marks(const SourceFile& file)
{
    // Written in pieces, so that this file does not find itself.
    static const std::regex kMark("\\b(TO"
                                  "DO|FIX"
                                  "ME|XX"
                                  "X|not imple"
                                  "mented|st"
                                  "ub)\\b",
                                  std::regex::icase);
    Sentences found;
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
        if (std::regex_search(file.lines[i], kMark)) {
            found.push_back(file.path + ":" + std::to_string(i + 1) + ": " + file.lines[i]);
        }
    }
    return found;
}

// The sentences about a made-up file with one include line.
Sentences about(const std::string& path, const std::string& include)
{
    return include_violations({path, split_lines("#pragma once\n#include " + include + "\n")});
}

} // namespace

TEST_CASE("every include follows a line of the architecture")
{
    CHECK(over_all_sources(include_violations) == Sentences{});
}

TEST_CASE("an include against the architecture is reported with its place")
{
    CHECK(about("io/raster.cpp", "\"matcher/options.h\"") ==
          Sentences{"io/raster.cpp:2: io must not include matcher (matcher/options.h)"});
    const auto [path, include] = GENERATE(table<std::string, std::string>({
        {"tiling/a.h", "\"io/error.h\""},
        {"tiling/a.cpp", "\"pipeline/plan.h\""},
        {"tiling/a.cpp", "<tbb/parallel_for.h>"},
        {"matcher/a.cpp", "\"io/error.h\""},
        {"matcher/host/a.cpp", "\"pipeline/plan.h\""},
        {"matcher/a.cpp", "<opencv2/core.hpp>"},
        {"matcher/a.cpp", "<proj.h>"},
        {"pipeline/geometry/a.cpp", "\"io/error.h\""},
        {"pipeline/dsm/a.cpp", "\"pipeline/geometry/rpc.h\""},
        {"pipeline/synth/a.cpp", "\"matcher/options.h\""},
        {"pipeline/evaluate/a.cpp", "\"pipeline/synth/scene.h\""},
        {"pipeline/evaluate/a.cpp", "\"pipeline/plan.h\""},
        {"pipeline/ledger/a.cpp", "\"matcher/options.h\""},
        {"pipeline/stages/a.cpp", "\"tests/catch.h\""},
        {"pipeline/stages/a.cpp", "<gdal_priv.h>"},
        {"pipeline/stages/a.cpp", "<cpl_conv.h>"},
        {"io/a.h", "<gdal.h>"},
        {"io/a.h", "<ogr_spatialref.h>"},
        {"pipeline/geometry/a.h", "<proj.h>"},
        {"pipeline/geometry/a.h", "<proj_experimental.h>"},
        {"pipeline/stages/a.h", "<opencv2/imgproc.hpp>"},
        {"io/a.h", "\"io/gdal_private.h\""},
        {"pipeline/stages/a.cpp", "\"io/gdal_private.h\""},
        {"io/a.cpp", "\"error.h\""},
        {"io/a.cpp", "\"../tiling/rect.h\""},
        {"io/a.cpp", "<tiling/rect.h>"},
    }));
    CAPTURE(path, include);
    CHECK(about(path, include).size() == 1);
}

TEST_CASE("includes along the architecture are accepted")
{
    const auto [path, include] = GENERATE(table<std::string, std::string>({
        {"tiling/a.h", "<vector>"},
        {"tiling/a.h", "\"tiling/rect.h\""},
        {"io/a.cpp", "\"tiling/rect.h\""},
        {"io/a.cpp", "<gdal_priv.h>"},
        {"io/a_private.h", "<gdal_priv.h>"},
        {"io/a.cpp", "\"io/a_private.h\""},
        {"io/b_private.h", "\"io/a_private.h\""},
        {"matcher/a.cpp", "\"tiling/rect.h\""},
        {"matcher/a.cpp", "<hwy/highway.h>"},
        {"pipeline/geometry/a.cpp", "<proj.h>"},
        {"pipeline/synth/a.cpp", "\"pipeline/geometry/rpc.h\""},
        {"pipeline/stages/a.cpp", "\"matcher/options.h\""},
        {"pipeline/stages/a.cpp", "\"pipeline/synth/scene.h\""},
        {"pipeline/ledger/a.cpp", "\"io/error.h\""},
        {"pipeline/main.cpp", "\"io/error.h\""},
        {"pipeline/main.cpp", "<opencv2/imgproc.hpp>"},
        {"tests/unit/a.cpp", "\"matcher/options.h\""},
        {"tests/unit/a.cpp", "<gdal.h>"},
    }));
    CAPTURE(path, include);
    CHECK(about(path, include) == Sentences{});
}

TEST_CASE("the top folders are those of the layout")
{
    const std::set<std::string> allowed{"configs",  "docs",  "io",    "matcher",
                                        "pipeline", "tests", "tiling"};
    for (const std::string& folder : top_folders(kRoot)) {
        CAPTURE(folder);
        CHECK(allowed.contains(folder));
    }
    CHECK(top_folders(kRoot).size() == allowed.size());
}

TEST_CASE("no source file has more than 450 lines")
{
    const SourceFile long_file{"io/long.cpp", std::vector<std::string>(kMaxLines + 1)};
    CHECK(too_long(long_file).size() == 1);
    CHECK(over_all_sources(too_long) == Sentences{});
}

TEST_CASE("no source file carries a mark of unfinished work")
{
    const SourceFile marked{"io/a.cpp",
                            {"int a; // TO"
                             "DO: b",
                             "int todos;"}};
    CHECK(unfinished_marks(marked).size() == 1);
    CHECK(over_all_sources(unfinished_marks) == Sentences{});
}
