#include "pipeline/stages/pictures_stage.h"

#include "io/hillshade.h"
#include "io/quicklook.h"
#include "pipeline/error.h"

namespace hsgm::pipeline {

void write_hillshade_of(const OutputPaths& outputs)
{
    if (outputs.hillshade.empty()) {
        return;
    }
    io::HillshadeOptions options;
    options.creation_options = outputs.creation_options;
    const auto& heights = outputs.dsm.empty() ? outputs.height : outputs.dsm;
    if (!io::write_hillshade(heights.string(), outputs.hillshade.string(), options,
                             [] { return !stop_is_requested(); })) {
        check_stop();
    }
}

void write_pictures_of(const OutputPaths& outputs)
{
    const auto write = [](const std::filesystem::path& raster,
                          const std::filesystem::path& picture, io::QuicklookStyle style) {
        if (!picture.empty()) {
            io::QuicklookOptions options;
            options.style = style;
            io::write_quicklook_png(raster.string(), picture.string(), options);
        }
    };
    write(outputs.disparity, outputs.disparity_picture, io::QuicklookStyle::disparity);
    write(outputs.hillshade, outputs.hillshade_picture, io::QuicklookStyle::hillshade);
}

} // namespace hsgm::pipeline
