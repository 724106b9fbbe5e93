#pragma once

#include "io/config.h"
#include "pipeline/ledger/fingerprint.h"
#include "pipeline/stages/match_stage.h"

namespace hsgm::pipeline {

/// The keys of a configuration that define the result, for RunManner::settings: all but those
/// of `run` and `output`. Of a file other than an image (a mask, say) its identity instead of
/// its path, so that a folder may move. Throws InputError where such a file cannot be read.
ledger::Facts settings_of(const io::ConfigDocument& document);

/// Everything that defines the result of a run: `settings`, the program's version, and the
/// images: size, pixel type, georeference and a checksum of 64 small windows spread evenly
/// over their pixels as read. Reads those windows; throws InputError.
ledger::Facts fingerprint(const PlannedJob& planned, const ledger::Facts& settings);

} // namespace hsgm::pipeline
