#pragma once

#include "pipeline/stages/run_books.h"

#include <string>
#include <vector>

namespace hsgm::pipeline {

/// A drawing (inline SVG) of who did what when: one lane for each worker of each shard and one
/// for the stages of each part, time to the right. Pauses in which nobody worked, of more than
/// a few seconds, are cut out and marked. Empty where nothing was done.
std::string gantt_svg(const std::vector<Book>& books);

/// Text for HTML: & < > and quotes written out.
std::string escaped(const std::string& text);

} // namespace hsgm::pipeline
