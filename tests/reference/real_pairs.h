#pragma once

#include "tests/reference/agreement.h"

#include <string>

namespace hsgm::reference {

/// Folder of real pairs: environment variable HSGM_DATA_DIR, or beside the sources.
std::string data_folder();
bool is_there(const std::string& scene);

/// A part of a real pair, in a few tiles; `sixteen_bit` makes it a picture whose tones are not
/// its values.
Case part_of(const std::string& scene, const Rect& part, DisparityRange asked,
             bool sixteen_bit);

} // namespace hsgm::reference
