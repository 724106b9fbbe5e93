#pragma once

#include "pipeline/synth/scene.h"

#include <cstdint>
#include <vector>

namespace hsgm::synth {

/// An object and the seed of its texture.
struct SeededObject {
    Object object;
    std::uint64_t seed = 0;
};

/// The town as a function of the lot's place: nothing is stored, so a town of any size
/// costs no memory, and a lot is the same whoever asks.
///
///     +--------+--------+     lots of cell_px; half a street inside each lot's border;
///     | [####] | [/\/\] |     no object leaves its lot
///     +--------+--------+
class CityMap {
public:
    CityMap(const City& city, std::uint64_t seed) : city_(city), seed_(seed) {}

    double cell_px() const { return city_.cell_px; }
    double tallest_px() const { return city_.height_max_px; }

    /// What stands on lot (row, col), which covers x in [col, col + 1) * cell_px.
    void append_objects(int row, int col, std::vector<SeededObject>& objects) const;

    /// The ground's texture at a point: `ground` with streets, and with a tone for each lot.
    Texture ground_at(double x, double y, Texture ground) const;

private:
    enum class LotKind { park, block, tower, houses };
    struct Lot {
        std::uint64_t seed;
        LotKind kind;
        bool plain;
        double center_x;
        double center_y;
        double side_px; ///< without the streets
    };

    Lot lot(int row, int col) const;
    double height_px(const Lot& lot, std::uint64_t n, double share) const;
    Object roofed(const Lot& lot, std::uint64_t n, double height_px) const;
    void append_block(const Lot& lot, std::vector<SeededObject>& objects) const;
    void append_tower(const Lot& lot, std::vector<SeededObject>& objects) const;
    void append_houses(const Lot& lot, std::vector<SeededObject>& objects) const;
    void append_trees(const Lot& lot, std::vector<SeededObject>& objects) const;

    City city_;
    std::uint64_t seed_;
};

} // namespace hsgm::synth
