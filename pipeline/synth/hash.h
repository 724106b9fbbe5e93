#pragma once

#include <cstdint>

namespace hsgm::synth {

/// Stateless random numbers: everything random in a scene is a hash of where it is, so a
/// pixel has the same value in whatever strip, order or thread it is rendered.

/// The finaliser of SplitMix64 (Steele, Lea, Flood 2014): every input bit moves every
/// output bit.
inline std::uint64_t mix(std::uint64_t x)
{
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// The hash of a grid position. The odd multipliers keep small (row, col) apart before
/// mixing; negative positions are fine.
inline std::uint64_t hash_at(std::uint64_t seed, std::int64_t row, std::int64_t col)
{
    return mix(seed + static_cast<std::uint64_t>(row) * 0x9e3779b97f4a7c15u +
               static_cast<std::uint64_t>(col) * 0xd1b54a32d192ed03u);
}

/// The seed of something that belongs to `seed`: its n-th child.
inline std::uint64_t child_seed(std::uint64_t seed, std::uint64_t n)
{
    return mix(seed ^ (0x2545f4914f6cdd1du * (n + 1)));
}

/// Uniform in [0, 1).
inline double uniform(std::uint64_t hash)
{
    return static_cast<double>(hash >> 11) * 0x1p-53;
}

/// Uniform in [-1, 1).
inline double uniform_signed(std::uint64_t hash)
{
    return static_cast<double>(static_cast<std::int64_t>(hash)) * 0x1p-63;
}

/// The sum of the eight bytes of a word, 0..2040.
inline std::uint64_t sum_of_bytes(std::uint64_t word)
{
    constexpr std::uint64_t even = 0x00ff00ff00ff00ffu;
    const std::uint64_t pairs = (word & even) + ((word >> 8) & even);
    return (pairs * 0x0001000100010001u) >> 48;
}

/// Gaussian, mean 0 and standard deviation 1, cut at about 6.9: the sum of sixteen uniform
/// bytes. Integers until the last line, so no libm decides a pixel.
inline double gaussian(std::uint64_t hash)
{
    constexpr double mean = 16 * 127.5;
    constexpr double sigma = 295.6032926; // sqrt(16 * (256^2 - 1) / 12)
    const std::uint64_t sum = sum_of_bytes(hash) + sum_of_bytes(mix(hash + 1));
    return (static_cast<double>(sum) - mean) / sigma;
}

} // namespace hsgm::synth
