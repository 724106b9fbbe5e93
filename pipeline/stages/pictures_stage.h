#pragma once

#include "pipeline/job.h"

namespace hsgm::pipeline {

/// Shades the DSM, or the heights where there is none; nothing where no hillshade was asked
/// for. Interrupted comes out of it.
void write_hillshade_of(const OutputPaths& outputs);

/// Pictures for people, made from the finished rasters; those that were asked for.
void write_pictures_of(const OutputPaths& outputs);

} // namespace hsgm::pipeline
