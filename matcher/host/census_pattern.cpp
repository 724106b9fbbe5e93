#include "matcher/host/census_pattern.h"

#include <algorithm>
#include <cstdlib>

namespace hsgm::matcher::host {

namespace {

std::vector<Offset> square(int radius_rows, int radius_cols)
{
    std::vector<Offset> offsets;
    for (int row = -radius_rows; row <= radius_rows; ++row) {
        for (int col = -radius_cols; col <= radius_cols; ++col) {
            offsets.push_back({row, col});
        }
    }
    return offsets;
}

constexpr Offset kCentre{0, 0};

// Each neighbour against the centre.
std::vector<CensusBit> centred(int radius_rows, int radius_cols)
{
    std::vector<CensusBit> bits;
    for (const Offset neighbour : square(radius_rows, radius_cols)) {
        if (neighbour != kCentre) {
            bits.push_back({neighbour, kCentre});
        }
    }
    return bits;
}

// Each neighbour against the centre, both ways.
std::vector<CensusBit> ternary(int radius)
{
    std::vector<CensusBit> bits;
    for (const CensusBit& bit : centred(radius, radius)) {
        bits.push_back(bit);
        bits.push_back({bit.more, bit.less});
    }
    return bits;
}

// Pixels that touch, at least one of them within a pixel of the centre: each pair once, and
// those of the 3 x 3 that share a side once more, the other way round.
std::vector<CensusBit> touching()
{
    std::vector<CensusBit> bits;
    std::vector<CensusBit> turned;
    const auto known = [&bits](Offset a, Offset b) {
        return std::any_of(bits.begin(), bits.end(), [&](const CensusBit& bit) {
            return bit.less == a && bit.more == b;
        });
    };
    for (const Offset a : square(1, 1)) {
        for (const Offset step : square(1, 1)) {
            const Offset b{a.row + step.row, a.col + step.col};
            if (step == kCentre || known(a, b)) {
                continue;
            }
            bits.push_back({b, a});
            const bool inside = std::abs(b.row) <= 1 && std::abs(b.col) <= 1;
            if (inside && (step.row == 0 || step.col == 0)) {
                turned.push_back({a, b});
            }
        }
    }
    bits.insert(bits.end(), turned.begin(), turned.end());
    return bits;
}

} // namespace

std::vector<CensusBit> census_bits(Cost cost)
{
    switch (cost) {
    case Cost::census5x5:
    case Cost::census_ad:
        return centred(2, 2);
    case Cost::census7x7:
        return centred(3, 3);
    case Cost::census9x7:
        return centred(3, 4);
    case Cost::ternary5x5:
        return ternary(2);
    case Cost::pairs5x5:
    case Cost::pairs_bt:
        return touching();
    default:
        return {};
    }
}

} // namespace hsgm::matcher::host
