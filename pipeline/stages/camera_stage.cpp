#include "pipeline/stages/camera_stage.h"

#include "io/error.h"

#include <fmt/format.h>

namespace hsgm::pipeline {

namespace {

geometry::RpcCamera of_file(const io::RasterSource& image, const std::string& rpc_file)
{
    const io::RpcMetadata stored = io::read_rpc_file(rpc_file);
    const auto first =
        io::first_pixel_in_scene(stored, image.geo_reference(), image.description());
    return geometry::RpcCamera(crop(to_model(stored), {first[0], first[1]}));
}

} // namespace

geometry::RpcModel to_model(const io::RpcMetadata& stored)
{
    geometry::RpcModel model;
    model.line_off = stored.line_off;
    model.samp_off = stored.samp_off;
    model.lat_off_deg = stored.lat_off;
    model.long_off_deg = stored.long_off;
    model.height_off_m = stored.height_off;
    model.line_scale = stored.line_scale;
    model.samp_scale = stored.samp_scale;
    model.lat_scale_deg = stored.lat_scale;
    model.long_scale_deg = stored.long_scale;
    model.height_scale_m = stored.height_scale;
    model.line_num = stored.line_num;
    model.line_den = stored.line_den;
    model.samp_num = stored.samp_num;
    model.samp_den = stored.samp_den;
    return model;
}

geometry::RpcCamera open_camera(const io::RasterSource& image, const std::string& rpc_file)
{
    if (!rpc_file.empty()) {
        return of_file(image, rpc_file);
    }
    if (const auto stored = io::stored_rpc(image)) {
        return geometry::RpcCamera(to_model(*stored));
    }
    if (const std::string geom = io::geom_beside(image.path()); !geom.empty()) {
        return of_file(image, geom);
    }
    throw io::InputError(fmt::format(
        "{} has no RPC: there is none in the file, nor in an .RPB, _RPC.TXT, DIMAP or .geom "
        "file beside it. Name one with `rpc:` (_RPC.TXT, .RPB, .geom, DIMAP XML, or an image "
        "that has one).",
        image.description()));
}

} // namespace hsgm::pipeline
