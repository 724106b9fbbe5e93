#include "pipeline/synth/landscape.h"

#include "pipeline/synth/hash.h"
#include "pipeline/synth/texture.h"

#include <algorithm>
#include <cmath>

namespace hsgm::synth {

namespace {

// Children of the scene's seed.
enum SeedOf : std::uint64_t { kGroundSeed = 1, kCitySeed = 2, kObjectSeed = 1000 };

const Scene& validated(const Scene& scene)
{
    scene.validate();
    return scene;
}

bool touches(const Piece& piece, const Area& area)
{
    const double reach = piece.radius_px() + 1;
    return piece.center_x + reach >= area.x_begin && piece.center_x - reach <= area.x_end &&
           piece.center_y + reach >= area.y_begin && piece.center_y - reach <= area.y_end;
}

} // namespace

Landscape::Landscape(const Scene& scene)
    : scene_(validated(scene)), ground_(scene.terrain), bounds_(ground_.bounds(scene.size, 0))
{
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) {
        append_pieces(scene_.objects[i], child_seed(scene_.seed, kObjectSeed + i), ground_,
                      pieces_);
    }
    for (const Piece& piece : pieces_) {
        bounds_.max_px = std::max(bounds_.max_px, piece.highest_px());
    }
    if (scene_.city) {
        city_.emplace(*scene_.city, child_seed(scene_.seed, kCitySeed));
        // A building at the image's edge may stand on ground just outside.
        const DisparityBounds under = ground_.bounds(scene.size, city_->cell_px());
        bounds_.max_px = std::max(bounds_.max_px, under.max_px + city_->tallest_px());
    }
}

std::vector<Piece> Landscape::pieces_over(const Area& area) const
{
    std::vector<Piece> pieces;
    std::copy_if(pieces_.begin(), pieces_.end(), std::back_inserter(pieces),
                 [&](const Piece& piece) { return touches(piece, area); });
    if (city_) {
        append_city(area, pieces);
    }
    return pieces;
}

void Landscape::append_city(const Area& area, std::vector<Piece>& pieces) const
{
    const auto lot_of = [&](double v) {
        return static_cast<int>(std::floor(v / city_->cell_px()));
    };
    std::vector<SeededObject> objects;
    for (int row = lot_of(area.y_begin); row <= lot_of(area.y_end); ++row) {
        for (int col = lot_of(area.x_begin); col <= lot_of(area.x_end); ++col) {
            city_->append_objects(row, col, objects);
        }
    }
    for (const SeededObject& seeded : objects) {
        append_pieces(seeded.object, seeded.seed, ground_, pieces);
    }
}

// Low-texture areas have soft edges; where several overlap, each one scales.
double Landscape::contrast_scale(double x, double y) const
{
    double scale = 1;
    for (const LowTexture& area : scene_.low_texture) {
        const double inside =
            std::min({x - area.x, area.x + area.cols - x, y - area.y, area.y + area.rows - y});
        scale *= 1 + (area.contrast_scale - 1) * smooth_step(inside, 1.5);
    }
    return scale;
}

double Landscape::ground_brightness(double x, double y) const
{
    const Texture& own = scene_.terrain.texture;
    const Texture texture = city_ ? city_->ground_at(x, y, own) : own;
    return brightness(texture, child_seed(scene_.seed, kGroundSeed), x, y,
                      contrast_scale(x, y));
}

double Landscape::piece_brightness(const Piece& piece, double x, double y) const
{
    return brightness(piece.texture, piece.seed, x, y, contrast_scale(x, y));
}

} // namespace hsgm::synth
