#pragma once

#include "tests/end_to_end/program.h"

#include "io/raster_source.h"
#include "tests/catch.h"

#include <nlohmann/json.hpp>

namespace hsgm::tests {

/// What `gdalinfo -json` has to say: somebody else's view of a raster.
inline nlohmann::json gdalinfo(const std::string& path)
{
    const Outcome outcome = run_program({"gdalinfo", "-json", path});
    INFO(path << ": " << outcome.err);
    REQUIRE(outcome.code == 0);
    return nlohmann::json::parse(outcome.out);
}

/// The pixels of a raster, NaN where it has no value.
inline tiling::Image<double> pixels_of(const std::string& path)
{
    io::RasterSource source(io::ImageSpec{path});
    tiling::Image<double> image(source.size());
    source.read(tiling::rect_of(source.size()), image);
    return image;
}

/// Runs hsgm, which must succeed.
inline Outcome hsgm_does(const std::vector<std::string>& arguments)
{
    const Outcome outcome = run_hsgm(arguments);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return outcome;
}

} // namespace hsgm::tests
