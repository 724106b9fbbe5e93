#include "pipeline/commands/range_argument.h"

#include "io/error.h"

#include <charconv>
#include <string_view>

namespace hsgm::pipeline {

namespace {

int parse_integer(std::string_view text, const std::string& whole)
{
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || text.empty()) {
        throw io::ConfigError(
            "--disparity must be MIN,MAX in whole pixels, for example 0,63 or "
            "-64,64, not '" +
            whole + "'");
    }
    return value;
}

} // namespace

tiling::DisparityRange parse_range(const std::string& text)
{
    const auto comma = text.find(',');
    const std::string_view view = text;
    const tiling::DisparityRange range{
        parse_integer(view.substr(0, comma), text),
        parse_integer(comma == std::string::npos ? "" : view.substr(comma + 1), text)};
    if (range.count() < 1) {
        throw io::ConfigError("--disparity " + text +
                              " is reversed: give the smaller number first");
    }
    return range;
}

} // namespace hsgm::pipeline
