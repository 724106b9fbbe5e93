#include "io/rpc_metadata.h"

#include "io/error.h"
#include "io/rpc_items_private.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>

namespace hsgm::io {

namespace {

/// "+009600.00 pixels" is a number, a unit and a sign that from_chars does not know.
const char* skip_to_number(const char* begin, const char* end)
{
    while (begin != end && (std::isspace(static_cast<unsigned char>(*begin)) != 0)) {
        ++begin;
    }
    return begin != end && *begin == '+' ? begin + 1 : begin;
}

/// Reads `values.size()` numbers separated by blanks or commas; false where there are fewer.
bool read_numbers(const std::string& text, std::span<double> values)
{
    const char* at = text.data();
    const char* const end = at + text.size();
    for (double& value : values) {
        at = skip_to_number(at, end);
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc{} || !std::isfinite(value)) {
            return false;
        }
        at = next;
        while (at != end && (*at == ',' || std::isspace(static_cast<unsigned char>(*at)))) {
            ++at;
        }
    }
    return true;
}

void read_item(const RpcItems& items, const std::string& key, std::span<double> values,
               const std::string& origin)
{
    const auto item = items.find(key);
    if (item == items.end()) {
        throw InputError("The RPC of " + origin + " has no " + key +
                         "; a model needs all ten offsets and scales and 80 coefficients.");
    }
    if (!read_numbers(item->second, values)) {
        throw InputError("The RPC of " + origin + " has '" + item->second + "' for " + key +
                         "; expected " + std::to_string(values.size()) +
                         (values.size() == 1 ? " number." : " numbers."));
    }
}

std::string text_of(std::span<const double> values)
{
    std::string text;
    for (const double value : values) {
        char digits[40];
        const auto [end, error] = std::to_chars(std::begin(digits), std::end(digits), value);
        if (!text.empty()) {
            text += ' ';
        }
        text.append(digits, end);
    }
    return text;
}

} // namespace

RpcMetadata rpc_from_items(const RpcItems& items, const std::string& origin)
{
    RpcMetadata rpc;
    rpc.origin = origin;
    const auto number = [&](const char* key, double& value) {
        read_item(items, key, {&value, 1}, origin);
    };
    number("LINE_OFF", rpc.line_off);
    number("SAMP_OFF", rpc.samp_off);
    number("LAT_OFF", rpc.lat_off);
    number("LONG_OFF", rpc.long_off);
    number("HEIGHT_OFF", rpc.height_off);
    number("LINE_SCALE", rpc.line_scale);
    number("SAMP_SCALE", rpc.samp_scale);
    number("LAT_SCALE", rpc.lat_scale);
    number("LONG_SCALE", rpc.long_scale);
    number("HEIGHT_SCALE", rpc.height_scale);
    for (const double scale :
         {rpc.line_scale, rpc.samp_scale, rpc.lat_scale, rpc.long_scale, rpc.height_scale}) {
        if (scale == 0) {
            throw InputError("The RPC of " + origin + " has a scale of 0, so it maps nothing.");
        }
    }
    read_item(items, "LINE_NUM_COEFF", rpc.line_num, origin);
    read_item(items, "LINE_DEN_COEFF", rpc.line_den, origin);
    read_item(items, "SAMP_NUM_COEFF", rpc.samp_num, origin);
    read_item(items, "SAMP_DEN_COEFF", rpc.samp_den, origin);
    return rpc;
}

RpcItems rpc_items(const RpcMetadata& rpc)
{
    const auto one = [](double value) { return text_of({&value, 1}); };
    return {{"LINE_OFF", one(rpc.line_off)},
            {"SAMP_OFF", one(rpc.samp_off)},
            {"LAT_OFF", one(rpc.lat_off)},
            {"LONG_OFF", one(rpc.long_off)},
            {"HEIGHT_OFF", one(rpc.height_off)},
            {"LINE_SCALE", one(rpc.line_scale)},
            {"SAMP_SCALE", one(rpc.samp_scale)},
            {"LAT_SCALE", one(rpc.lat_scale)},
            {"LONG_SCALE", one(rpc.long_scale)},
            {"HEIGHT_SCALE", one(rpc.height_scale)},
            {"LINE_NUM_COEFF", text_of(rpc.line_num)},
            {"LINE_DEN_COEFF", text_of(rpc.line_den)},
            {"SAMP_NUM_COEFF", text_of(rpc.samp_num)},
            {"SAMP_DEN_COEFF", text_of(rpc.samp_den)}};
}

std::array<double, 2> first_pixel_in_scene(const RpcMetadata& rpc, const GeoReference& geo,
                                           const std::string& image)
{
    if (!rpc.of_whole_scene || !geo.transform || !geo.wkt.empty()) {
        return {};
    }
    const auto& t = *geo.transform;
    if (t[1] != 1 || t[2] != 0 || t[4] != 0 || t[5] != 1) {
        const std::array<double, 4> steps{t[1], t[4], t[2], t[5]};
        throw InputError(rpc.origin + " is of a whole scene, but the geotransform of " + image +
                         " does not say which of its pixels the image holds: expected steps "
                         "of 1 0 0 1 px, found " +
                         text_of(steps) + ". Give an RPC of the image itself.");
    }
    return {t[0], t[3]};
}

std::optional<RpcMetadata> stored_rpc(const RasterSource& image)
{
    const RpcItems items = image.metadata("RPC");
    if (items.empty()) {
        return std::nullopt;
    }
    return rpc_from_items(items, image.description());
}

} // namespace hsgm::io
