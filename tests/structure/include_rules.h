#pragma once

#include "tests/structure/source_tree.h"

#include <string>
#include <vector>

namespace hsgm::structure {

/// The folders are the architecture: includes follow these lines downward.
///
///             pipeline            pipeline/geometry, pipeline/dsm  -> tiling
///            /   |    \           pipeline/synth, pipeline/evaluate -> tiling, geometry
///          io    |   matcher      the rest of pipeline              -> everything
///            \   |    /           tests may include everything; nobody includes tests
///              tiling             tiling stands on the standard library alone
///
/// GDAL is named only in io; GDAL, PROJ and OpenCV in no header, and none of them in matcher.
/// Quoted includes name files of ours by their path from the root; what others wrote goes
/// in angle brackets.
///
/// One sentence for each include that breaks a rule: "path:line: what is wrong".
std::vector<std::string> include_violations(const SourceFile& file);

} // namespace hsgm::structure
