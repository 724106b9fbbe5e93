#include "pipeline/synth/city.h"

#include "pipeline/synth/hash.h"
#include "pipeline/synth/texture.h"

#include <algorithm>
#include <cmath>

namespace hsgm::synth {

namespace {

// Names for the random numbers of a lot, so that no two decisions share one.
enum Choice : std::uint64_t {
    kBuilt,
    kKind,
    kPlain,
    kRotated,
    kAngle,
    kTone,
    kHeight = 100,
    kRoof = 200,
    kSlanted = 300,
    kMean = 400,
    kExtent = 500,
    kPlace = 600,
    kPaint = 700,
};

double choose(std::uint64_t seed, std::uint64_t choice)
{
    return uniform(child_seed(seed, choice));
}

double between(double low, double high, double share)
{
    return low + (high - low) * share;
}

// How built-up a place is, 0 to 1: centres and suburbs over some dozen lots.
double density(std::uint64_t seed, double row, double col)
{
    const double noise = octave_noise(child_seed(seed, 77), 6, 2, col, row);
    return std::clamp(0.45 + 0.3 * noise, 0.0, 1.0);
}

} // namespace

CityMap::Lot CityMap::lot(int row, int col) const
{
    Lot lot;
    lot.seed = hash_at(seed_, row, col);
    lot.center_x = (col + 0.5) * city_.cell_px;
    lot.center_y = (row + 0.5) * city_.cell_px;
    lot.side_px = city_.cell_px - city_.street_px;
    lot.plain = choose(lot.seed, kPlain) < city_.plain;
    const double kind = choose(lot.seed, kKind) + 0.5 * (density(seed_, row, col) - 0.5);
    lot.kind = kind < 0.45 ? LotKind::houses : (kind < 0.85 ? LotKind::block : LotKind::tower);
    if (choose(lot.seed, kBuilt) >= city_.fill) {
        lot.kind = LotKind::park;
    }
    return lot;
}

// `share` of the range of heights that the lot's district allows.
double CityMap::height_px(const Lot& lot, std::uint64_t n, double share) const
{
    const double h = choose(lot.seed, kHeight + n);
    return between(city_.height_min_px, city_.height_max_px, share * (0.3 + 0.7 * h));
}

// A building's roof, its colour and texture; `height_px` is the height of its highest part.
Object CityMap::roofed(const Lot& lot, std::uint64_t n, double height_px) const
{
    Object object;
    object.height_px = height_px;
    object.texture = city_.texture;
    const double spread = choose(lot.seed, kMean + n) - 0.5;
    object.texture.mean *= 1 + 1.2 * spread;
    if (lot.plain) {
        object.texture.contrast = city_.plain_contrast;
    }
    if (choose(lot.seed, kRotated) < city_.rotated) {
        object.angle_deg = between(5, 40, choose(lot.seed, kAngle));
    }
    return object;
}

namespace {

// Footprints are shrunk when turned, so that they stay inside a circle in their lot.
void fit_turned(Object& object, double side_px)
{
    if (object.angle_deg == 0) {
        return;
    }
    const double diagonal =
        std::sqrt(object.length_px * object.length_px + object.width_px * object.width_px);
    const double scale = std::min(1.0, side_px / diagonal);
    object.length_px *= scale;
    object.width_px *= scale;
}

// Gives an object a slanted roof that keeps its highest part where it was.
void slant(Object& object, Roof roof, double pitch)
{
    const double run_px = roof == Roof::gable ? object.width_px / 2 : object.width_px;
    object.roof = roof;
    object.rise_px = std::min(pitch * run_px, object.height_px * 0.6);
    object.height_px -= object.rise_px;
}

} // namespace

void CityMap::append_block(const Lot& lot, std::vector<SeededObject>& objects) const
{
    Object block = roofed(lot, 0, height_px(lot, 0, 0.6));
    block.center_x = lot.center_x;
    block.center_y = lot.center_y;
    block.length_px = lot.side_px * between(0.6, 0.96, choose(lot.seed, kExtent));
    block.width_px = lot.side_px * between(0.5, 0.96, choose(lot.seed, kExtent + 1));
    fit_turned(block, lot.side_px);
    if (choose(lot.seed, kSlanted) < city_.slanted) {
        const bool gable = choose(lot.seed, kRoof) < 0.5;
        slant(block, gable ? Roof::gable : Roof::slope, 0.18);
    }
    objects.push_back({block, child_seed(lot.seed, kPaint)});
}

// A tower on a podium; now and then a round one.
void CityMap::append_tower(const Lot& lot, std::vector<SeededObject>& objects) const
{
    Object podium = roofed(lot, 0, height_px(lot, 0, 0.3));
    podium.center_x = lot.center_x;
    podium.center_y = lot.center_y;
    podium.length_px = podium.width_px = lot.side_px * 0.94;
    fit_turned(podium, lot.side_px);
    Object tower = roofed(lot, 1, height_px(lot, 1, 1.0));
    tower.height_px = std::max(tower.height_px, podium.height_px);
    tower.shape = choose(lot.seed, kRoof + 1) < 0.25 ? Shape::ellipse : Shape::rectangle;
    tower.length_px = podium.length_px * between(0.45, 0.7, choose(lot.seed, kExtent));
    tower.width_px = podium.width_px * between(0.45, 0.7, choose(lot.seed, kExtent + 1));
    const double play = 0.5 * lot.side_px * (podium.length_px / lot.side_px - 0.7) * 0.7;
    tower.center_x = lot.center_x + play * (2 * choose(lot.seed, kPlace) - 1);
    tower.center_y = lot.center_y + play * (2 * choose(lot.seed, kPlace + 1) - 1);
    objects.push_back({podium, child_seed(lot.seed, kPaint)});
    objects.push_back({tower, child_seed(lot.seed, kPaint + 1)});
}

// Two by two detached houses, each with its own roof.
void CityMap::append_houses(const Lot& lot, std::vector<SeededObject>& objects) const
{
    for (std::uint64_t n = 0; n < 4; ++n) {
        const double quarter = lot.side_px / 2;
        Object house = roofed(lot, n, height_px(lot, n, 0.25));
        house.center_x = lot.center_x + (n % 2 == 0 ? -0.5 : 0.5) * quarter;
        house.center_y = lot.center_y + (n < 2 ? -0.5 : 0.5) * quarter;
        house.length_px = quarter * between(0.65, 0.85, choose(lot.seed, kExtent + n));
        house.width_px = quarter * between(0.45, 0.65, choose(lot.seed, kExtent + 10 + n));
        house.angle_deg += choose(lot.seed, kRoof + n) < 0.5 ? 0 : 90;
        fit_turned(house, quarter);
        if (choose(lot.seed, kSlanted + n) < 2 * city_.slanted) {
            slant(house, Roof::gable, 0.3);
        }
        objects.push_back({house, child_seed(lot.seed, kPaint + n)});
    }
}

void CityMap::append_trees(const Lot& lot, std::vector<SeededObject>& objects) const
{
    if (lot.plain) {
        return; // a parking lot
    }
    for (std::uint64_t n = 0; n < 7; ++n) {
        Object tree;
        tree.shape = Shape::ellipse;
        tree.length_px = tree.width_px =
            lot.side_px * between(0.08, 0.16, choose(lot.seed, kExtent + n));
        const double play = 0.4 * lot.side_px;
        tree.center_x = lot.center_x + play * (2 * choose(lot.seed, kPlace + n) - 1);
        tree.center_y = lot.center_y + play * (2 * choose(lot.seed, kPlace + 10 + n) - 1);
        tree.height_px = height_px(lot, n, 0.15);
        tree.texture = city_.texture;
        tree.texture.mean *= 0.6;
        objects.push_back({tree, child_seed(lot.seed, kPaint + n)});
    }
}

void CityMap::append_objects(int row, int col, std::vector<SeededObject>& objects) const
{
    const Lot here = lot(row, col);
    switch (here.kind) {
    case LotKind::park:
        return append_trees(here, objects);
    case LotKind::block:
        return append_block(here, objects);
    case LotKind::tower:
        return append_tower(here, objects);
    case LotKind::houses:
        return append_houses(here, objects);
    }
}

Texture CityMap::ground_at(double x, double y, Texture ground) const
{
    const double cell = city_.cell_px;
    const int col = static_cast<int>(std::floor(x / cell));
    const int row = static_cast<int>(std::floor(y / cell));
    const double from_border = std::min(cell / 2 - std::abs(x - (col + 0.5) * cell),
                                        cell / 2 - std::abs(y - (row + 0.5) * cell));
    // 0 on the street, 1 on the lot. All streets look alike, so that lots change tone only
    // where this weight is 0.
    const double inside = smooth_step(from_border - city_.street_px / 2, 1.5);
    const std::uint64_t seed = hash_at(seed_, row, col);
    constexpr double kStreetTone = 0.58; // of the ground's brightness
    const double lot_tone = between(0.75, 1.25, choose(seed, kTone));
    const bool plain = choose(seed, kPlain) < city_.plain;
    const double lot_contrast = plain ? city_.plain_contrast : ground.contrast;
    ground.mean *= between(kStreetTone, lot_tone, inside);
    ground.contrast = between(0.5 * ground.contrast, lot_contrast, inside);
    return ground;
}

} // namespace hsgm::synth
