#include "io/byte_size.h"

#include "io/error.h"

#include <array>
#include <charconv>
#include <string>

namespace hsgm::io {

namespace {

struct Unit {
    std::string_view name;
    double bytes;
};

constexpr double kKibi = 1024;
constexpr std::array<Unit, 17> kUnits{{
    {"", 1},
    {"B", 1},
    {"K", kKibi},
    {"KiB", kKibi},
    {"M", kKibi* kKibi},
    {"MiB", kKibi* kKibi},
    {"G", kKibi* kKibi* kKibi},
    {"GiB", kKibi* kKibi* kKibi},
    {"T", kKibi* kKibi* kKibi* kKibi},
    {"TiB", kKibi* kKibi* kKibi* kKibi},
    {"kB", 1e3},
    {"KB", 1e3},
    {"MB", 1e6},
    {"GB", 1e9},
    {"TB", 1e12},
    {"PB", 1e15},
    {"PiB", kKibi* kKibi* kKibi* kKibi* kKibi},
}};

[[noreturn]] void refuse(std::string_view text, const char* example)
{
    throw ConfigError("'" + std::string(text) + "' is no amount of bytes; write a number " +
                      "with B, KiB, MiB, GiB, TiB, kB, MB, GB or TB, for example " + example +
                      ".");
}

/// Splits "1.5 GiB" into a number of at least 0 and what follows it.
bool split(std::string_view text, double& number, std::string_view& rest)
{
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    rest = text.substr(static_cast<std::size_t>(end - text.data()));
    while (rest.starts_with(' ')) {
        rest.remove_prefix(1);
    }
    return error == std::errc{} && number >= 0;
}

} // namespace

std::uint64_t parse_bytes(std::string_view text)
{
    double number = 0;
    std::string_view unit_name;
    if (split(text, number, unit_name)) {
        for (const Unit& unit : kUnits) {
            // 2^63 bytes are more than any machine has, and safe to turn into an integer.
            if (unit.name == unit_name && number * unit.bytes < 9.2e18) {
                return static_cast<std::uint64_t>(number * unit.bytes);
            }
        }
    }
    refuse(text, "8GiB");
}

std::uint64_t ByteAmount::of(std::uint64_t total_bytes) const
{
    return bytes.value_or(static_cast<std::uint64_t>(share * static_cast<double>(total_bytes)));
}

ByteAmount parse_byte_amount(std::string_view text)
{
    double number = 0;
    std::string_view rest;
    ByteAmount amount;
    if (split(text, number, rest) && rest == "%") {
        if (number <= 0 || number > 100) {
            throw ConfigError("'" + std::string(text) + "' is no share; it must lie above 0% " +
                              "and at most at 100%.");
        }
        amount.share = number / 100;
        return amount;
    }
    amount.bytes = parse_bytes(text);
    return amount;
}

} // namespace hsgm::io
