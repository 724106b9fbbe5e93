#pragma once

#include "pipeline/ledger/checksum.h"
#include "pipeline/stages/pixel_source.h"

#include <string>

namespace hsgm::pipeline {

/// A checksum of all pixels of a source, as read: nodata is nodata, whatever number it is
/// stored as, and neither compression nor the file's blocks matter.
class PixelChecksum {
public:
    /// The windows of PixelSource::reading_windows, in their order. Gives every NaN in `values`
    /// the same bits.
    void add(tiling::ImageView<double> values);
    /// 16 hexadecimal digits.
    std::string hex() const { return sum_.hex(); }

private:
    ledger::Checksum sum_;
};

/// Reads the whole source for its checksum. Throws InputError and Interrupted.
std::string checksum_of(PixelSource& source);

} // namespace hsgm::pipeline
