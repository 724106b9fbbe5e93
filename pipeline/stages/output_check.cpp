#include "pipeline/stages/output_check.h"

#include "io/error.h"
#include "io/geotiff_writer.h"

#include <fmt/format.h>

#include <string>
#include <system_error>
#include <vector>

namespace hsgm::pipeline {

namespace {

using std::filesystem::path;

void check_place(const path& output, const std::vector<path>& inputs)
{
    std::error_code nothing_there;
    if (std::filesystem::is_directory(output, nothing_there)) {
        throw io::StorageError(fmt::format(
            "Cannot write {}: it is a folder; name a file in it.", output.string()));
    }
    for (const path& input : inputs) {
        if (std::filesystem::equivalent(output, input, nothing_there)) {
            throw io::ConfigError(fmt::format(
                "The output {} is also an input, which it would replace; name another output.",
                output.string()));
        }
    }
}

} // namespace

void check_outputs(const Job& job)
{
    const OutputPaths& o = job.outputs;
    const std::vector<path> inputs{job.left.path, job.right.path, job.left.mask,
                                   job.right.mask};
    for (const path& output : o.files()) {
        check_place(output, inputs);
    }
    io::check_creation_options(o.disparity, io::PixelType::float32, o.creation_options);
    io::check_creation_options(o.confidence, io::PixelType::uint8, o.creation_options);
    io::check_creation_options(o.reasons, io::PixelType::uint16, o.creation_options);
}

} // namespace hsgm::pipeline
