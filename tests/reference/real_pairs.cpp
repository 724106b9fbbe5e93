#include "tests/reference/real_pairs.h"

#include "io/raster_source.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>

namespace hsgm::reference {

namespace {

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

} // namespace

std::string data_folder()
{
    const char* named = std::getenv("HSGM_DATA_DIR");
    return named != nullptr ? named : HSGM_DEFAULT_DATA_DIR;
}

bool is_there(const std::string& scene)
{
    return std::filesystem::exists(data_folder() + "/" + scene);
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

} // namespace hsgm::reference
