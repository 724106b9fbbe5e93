#include "pipeline/ledger/checksum.h"

#include "io/error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <vector>

namespace hsgm::ledger {

namespace {

std::string hex_digits(std::uint64_t value, int digits)
{
    std::string text(static_cast<std::size_t>(digits), '0');
    for (auto digit = text.rbegin(); digit != text.rend(); ++digit, value >>= 4) {
        *digit = "0123456789abcdef"[value & 15];
    }
    return text;
}

// The constants of FIPS 180-4: fractions of the square and cube roots of the first primes.
// Long double holds the 35 bits that each needs.
std::uint32_t fraction(long double root)
{
    return static_cast<std::uint32_t>((root - std::floor(root)) * 4294967296.0L);
}

struct Constants {
    std::array<std::uint32_t, 8> start{};
    std::array<std::uint32_t, 64> rounds{};

    Constants()
    {
        std::size_t found = 0;
        for (int n = 2; found < rounds.size(); ++n) {
            bool prime = true;
            for (int d = 2; d * d <= n; ++d) {
                prime = prime && n % d != 0;
            }
            if (!prime) {
                continue;
            }
            if (found < start.size()) {
                start[found] = fraction(std::sqrt(static_cast<long double>(n)));
            }
            rounds[found++] = fraction(std::cbrt(static_cast<long double>(n)));
        }
    }
};

const Constants& constants()
{
    static const Constants the_ones;
    return the_ones;
}

std::uint32_t big_endian(const std::byte* bytes)
{
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) {
        value = value << 8 | std::to_integer<std::uint32_t>(bytes[i]);
    }
    return value;
}

} // namespace

void Checksum::add(std::span<const std::byte> bytes)
{
    constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15ULL;
    const std::size_t length = bytes.size();
    while (!bytes.empty()) {
        std::uint64_t word = 0;
        const std::size_t n = std::min<std::size_t>(bytes.size(), sizeof(word));
        std::memcpy(&word, bytes.data(), n);
        // The product carries low bits of a word to high ones, the shift high ones to low.
        state_ = (state_ ^ word) * kOdd;
        state_ ^= state_ >> 32;
        bytes = bytes.subspan(n);
    }
    state_ = (state_ ^ length) * kOdd;
    state_ ^= state_ >> 32;
}

std::string Checksum::hex() const
{
    return hex_digits(state_, 16);
}

Sha256::Sha256() : state_(constants().start) {}

void Sha256::block(const std::byte* bytes)
{
    std::array<std::uint32_t, 64> w{};
    for (std::size_t i = 0; i < 16; ++i) {
        w[i] = big_endian(bytes + 4 * i);
    }
    for (std::size_t i = 16; i < 64; ++i) {
        const std::uint32_t a = w[i - 15];
        const std::uint32_t b = w[i - 2];
        w[i] = w[i - 16] + (std::rotr(a, 7) ^ std::rotr(a, 18) ^ a >> 3) + w[i - 7] +
               (std::rotr(b, 17) ^ std::rotr(b, 19) ^ b >> 10);
    }
    auto [a, b, c, d, e, f, g, h] = state_;
    for (std::size_t i = 0; i < 64; ++i) {
        const std::uint32_t one = h + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) +
                                  ((e & f) ^ (~e & g)) + constants().rounds[i] + w[i];
        const std::uint32_t two = (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) +
                                  ((a & b) ^ (a & c) ^ (b & c));
        h = g;
        g = f;
        f = e;
        e = d + one;
        d = c;
        c = b;
        b = a;
        a = one + two;
    }
    const std::array<std::uint32_t, 8> sums{a, b, c, d, e, f, g, h};
    std::transform(state_.begin(), state_.end(), sums.begin(), state_.begin(), std::plus<>());
}

void Sha256::add(std::span<const std::byte> bytes)
{
    std::size_t filled = length_ % waiting_.size();
    length_ += bytes.size();
    while (!bytes.empty()) {
        if (filled == 0 && bytes.size() >= waiting_.size()) {
            block(bytes.data());
            bytes = bytes.subspan(waiting_.size());
            continue;
        }
        const std::size_t n = std::min(bytes.size(), waiting_.size() - filled);
        std::memcpy(&waiting_[filled], bytes.data(), n);
        bytes = bytes.subspan(n);
        filled = (filled + n) % waiting_.size();
        if (filled == 0) {
            block(waiting_.data());
        }
    }
}

std::string Sha256::hex()
{
    const std::uint64_t bits = length_ * 8;
    std::vector<std::byte> end(1 + (119 - length_ % 64) % 64 + 8);
    end[0] = std::byte{0x80};
    for (std::size_t i = 0; i < 8; ++i) {
        end[end.size() - 1 - i] = static_cast<std::byte>(bits >> 8 * i);
    }
    add(end);
    std::string text;
    for (const std::uint32_t word : state_) {
        text += hex_digits(word, 8);
    }
    return text;
}

std::string sha256_of_file(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw io::StorageError("Cannot read " + path.string() + " back for its checksum.");
    }
    Sha256 sum;
    std::vector<char> bytes(std::size_t{1} << 20);
    while (file) {
        file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        sum.add(std::as_bytes(std::span(bytes).first(static_cast<std::size_t>(file.gcount()))));
    }
    if (file.bad()) {
        throw io::StorageError("Cannot read " + path.string() + " back for its checksum.");
    }
    return sum.hex();
}

} // namespace hsgm::ledger
