#pragma once

#include "io/config.h"
#include "pipeline/ledger/fingerprint.h"
#include "pipeline/stages/plan_stage.h"
#include "pipeline/stages/prepare_stage.h"

#include <string>
#include <vector>

namespace hsgm::pipeline {

/// The keys of a configuration that define the result, for RunManner::settings: all but those
/// of `run` and `output`. Of a file other than an image (a mask, say) its identity instead of
/// its path, so that a folder may move. Throws InputError where such a file cannot be read.
ledger::Facts settings_of(const io::ConfigDocument& document);

/// What defines the result of a run, pixels apart: `settings`, the program's version, and of
/// the images size, pixel type and georeference. Reads no pixels; throws InputError.
ledger::Facts fingerprint(const PlannedJob& planned, const ledger::Facts& settings);

/// Stamp of all files that a pair comes from; empty where there is none.
std::string stamp_of(const PlannedJob& planned);

/// The images' pixels as facts of the coarse stage's ledger: a checksum of all of them, made
/// while they were read, and the stamp that the file system gave their files then.
ledger::Facts pixel_facts(const PairChecksums& checksums, const std::string& stamp);
/// Those checksums as they are shown to people; empty where the facts have none.
ledger::Facts pixels_in(const ledger::Facts& facts);

/// What differs between the pixels that these facts tell of and those of today's files, one
/// entry an image. Trusts files whose stamp is the same; others are read whole and compared,
/// because a copy has another stamp but may have the same pixels.
std::vector<std::string> changed_pixels(const PlannedJob& planned, const ledger::Facts& facts);

} // namespace hsgm::pipeline
