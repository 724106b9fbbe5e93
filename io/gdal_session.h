#pragma once

#include <cstddef>

namespace hsgm::io {

/// Registers GDAL's drivers and sets how much memory its block cache, which all threads
/// share, may take. Call once at the start with the plan's figure; without the call the
/// drivers are registered on first use and GDAL takes 5 % of the machine's memory.
void initialise_gdal(std::size_t cache_bytes);

/// Registers the drivers and nothing else; cheap to repeat, safe from every thread.
void register_gdal();

/// Of the library in use, for example "3.6.2".
const char* gdal_version();

} // namespace hsgm::io
