#pragma once

#include "io/geotiff_writer.h"
#include "tiling/image.h"

#include <cstdint>
#include <functional>
#include <string>

namespace hsgm::pipeline {

/// Fills one rectangle of a raster; called from many threads at once.
template <typename T>
using RenderPart = std::function<void(const tiling::Rect& part, tiling::ImageView<T> pixels)>;

/// Writes a raster whose pixels are computed part by part, strip by strip, on all threads that
/// TBB lends. T: float, std::uint8_t or std::uint16_t.
template <typename T>
void write_computed(const std::string& path, tiling::Size size, io::RasterOptions options,
                    const RenderPart<T>& render);

/// The same for gray levels, in one byte each where `bits` is 8.
void write_gray(const std::string& path, tiling::Size size, int bits, io::RasterOptions options,
                const RenderPart<std::uint16_t>& render);

/// Makes a folder and what leads to it. Throws io::StorageError.
void make_output_folder(const std::string& folder);

} // namespace hsgm::pipeline
