#include "tests/catch.h"

#include "io/raster_source.h"
#include "tests/reference/hmi.h"
#include "tests/reference/themes.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

using namespace hsgm::reference;

// Parts of real pairs from the data folder: environment variable HSGM_DATA_DIR, or beside the
// sources.
namespace {

std::string data_folder()
{
    const char* named = std::getenv("HSGM_DATA_DIR");
    return named != nullptr ? named : HSGM_DEFAULT_DATA_DIR;
}

Image<std::uint16_t> read_part(const std::string& path, const Rect& part)
{
    Image<double> values(part.size());
    hsgm::io::RasterSource({path}).read(part, values);
    Image<std::uint16_t> image(part.size());
    for (int row = 0; row < part.rows; ++row) {
        for (int col = 0; col < part.cols; ++col) {
            const double value = values(row, col);
            image(row, col) = std::isnan(value) ? kNodata : static_cast<std::uint16_t>(value);
        }
    }
    return image;
}

// The same picture as a 16-bit one whose tones are not its values.
void widen(Image<std::uint16_t>& image)
{
    for (int row = 0; row < image.rows(); ++row) {
        for (int col = 0; col < image.cols(); ++col) {
            if (image(row, col) != kNodata) {
                image(row, col) = static_cast<std::uint16_t>(image(row, col) * 201 + 77);
            }
        }
    }
}

Case part_of(const std::string& scene, const Rect& part, DisparityRange asked, bool sixteen_bit)
{
    const std::string folder = data_folder() + "/" + scene;
    Case c;
    c.pair = {read_part(folder + "/left.png", part), read_part(folder + "/right.png", part)};
    c.asked = asked;
    if (sixteen_bit) {
        widen(c.pair.left);
        widen(c.pair.right);
        c.tone_left = tone_ends(c.pair.left);
        c.tone_right = tone_ends(c.pair.right);
    }
    Random random(1);
    c.tiles = random_partition(random, part.size(), 2, 2);
    c.pieces = random_partition(random, part.size(), 2, 2);
    return c;
}

void compare_costs(Case c)
{
    for (const Cost cost : hsgm::matcher::all_costs()) {
        c.options.cost = cost;
        if (cost == Cost::hmi) {
            c.hmi = solve_hmi(c.pair.left, c.pair.right, c.asked, c.tone_left, c.tone_right,
                              c.options);
        }
        const std::string found = difference(c);
        INFO(c.describe());
        CHECK(found == "");
    }
}

} // namespace

TEST_CASE("matcher and twin agree for every cost on parts of real pairs")
{
    const auto [scene, part, asked] = GENERATE(table<std::string, Rect, DisparityRange>({
        {"middlebury_cones", {130, 150, 120, 140}, {0, 63}},
        {"sat_us3d_JAX_079_006_007", {300, 400, 100, 150}, {-40, 39}},
    }));
    if (!std::filesystem::exists(data_folder() + "/" + scene)) {
        WARN("SKIPPED: no test data in " + data_folder() + "/" + scene + "; see HSGM_DATA_DIR");
        return;
    }
    INFO(scene);
    for (const bool sixteen_bit : {false, true}) {
        compare_costs(part_of(scene, part, asked, sixteen_bit));
    }
}
