#include "pipeline/stages/surface_rows.h"

#include "io/error.h"
#include "io/map_reference.h"
#include "pipeline/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace hsgm::pipeline {

namespace {

using tiling::Image;
using tiling::Rect;
using tiling::Size;

constexpr int kStripRows = 128;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// Cell centres of a raster with north up: x = x0 + col * dx, y = y0 + row * dy.
struct Grid {
    double x0 = 0.5;
    double dx = 1;
    double y0 = -0.5;
    double dy = -1;
};

Grid grid_of(const io::RasterSource& source)
{
    const auto transform = source.geo_reference().transform;
    if (!transform) {
        return {};
    }
    const std::array<double, 6>& t = *transform;
    if (t[2] != 0 || t[4] != 0) {
        throw io::InputError(source.description() + " is rotated against its map; make its " +
                             "rows run east with gdalwarp first");
    }
    return {t[0] + t[1] / 2, t[1], t[3] + t[5] / 2, t[5]};
}

Image<float> read_floats(io::RasterSource& source, const Rect& window)
{
    check_stop();
    Image<double> stored(window.size());
    source.read(window, stored);
    Image<float> values(window.size());
    std::transform(stored.pixels().begin(), stored.pixels().end(), values.data(),
                   [](double v) { return static_cast<float>(v); });
    return values;
}

/// The part of the test that a strip needs, and how to look things up in it.
class TestWindow {
public:
    TestWindow(io::RasterSource& source, const Grid& grid, double x_low, double x_high,
               double y_low, double y_high)
        : grid_(grid)
    {
        const auto reach = [](double a, double b, int size) {
            const double first = std::floor(std::min(a, b));
            const double last = std::floor(std::max(a, b)) + 1;
            return std::pair{static_cast<int>(std::clamp<double>(first, 0, size)),
                             static_cast<int>(std::clamp<double>(last + 1, 0, size))};
        };
        const auto [row, row_end] = reach(row_at(y_low), row_at(y_high), source.size().rows);
        const auto [col, col_end] = reach(col_at(x_low), col_at(x_high), source.size().cols);
        rect_ = {row, col, row_end - row, col_end - col};
        if (!rect_.empty()) {
            heights_ = read_floats(source, rect_);
        }
    }

    /// NaN outside the raster, and where the nearest cell has no height.
    float at(double x, double y) const
    {
        const double row = row_at(y) - rect_.row;
        const double col = col_at(x) - rect_.col;
        const double top = std::floor(row);
        const double left = std::floor(col);
        const auto part_down = static_cast<float>(row - top);
        const auto part_right = static_cast<float>(col - left);
        const auto height = [&](int down, int right) {
            const double r = top + down;
            const double c = left + right;
            const bool inside = r >= 0 && c >= 0 && r < rect_.rows && c < rect_.cols;
            return inside ? heights_(static_cast<int>(r), static_cast<int>(c)) : kNone;
        };
        const float upper =
            (1 - part_right) * height(0, 0) + part_right * height(0, part_right > 0 ? 1 : 0);
        const float lower = part_down > 0 ? (1 - part_right) * height(1, 0) +
                                                part_right * height(1, part_right > 0 ? 1 : 0)
                                          : upper;
        const float between = (1 - part_down) * upper + part_down * lower;
        return std::isnan(between) ? height(part_down < 0.5F ? 0 : 1, part_right < 0.5F ? 0 : 1)
                                   : between;
    }

private:
    double row_at(double y) const { return (y - grid_.y0) / grid_.dy; }
    double col_at(double x) const { return (x - grid_.x0) / grid_.dx; }

    Grid grid_;
    Rect rect_;
    Image<float> heights_;
};

void require_size(const io::RasterSource& other, const io::RasterSource& reference)
{
    if (other.size() != reference.size()) {
        const auto words = [](Size s) {
            return std::to_string(s.rows) + " rows x " + std::to_string(s.cols) + " columns";
        };
        throw io::InputError(other.description() + " has " + words(other.size()) + ", but " +
                             reference.description() + ", on whose grid it must lie, has " +
                             words(reference.size()));
    }
}

void require_one_map(const io::RasterSource& test, const io::RasterSource& reference)
{
    const std::string map = test.geo_reference().wkt;
    const std::string other = reference.geo_reference().wkt;
    if (!io::same_crs(map, other)) {
        throw io::InputError(test.description() + " is in " + io::crs_name(map) + ", " +
                             reference.description() + " in " + io::crs_name(other) +
                             "; bring one into the other's with gdalwarp first");
    }
    if (io::in_degrees(map)) {
        throw io::InputError(test.description() + " is in degrees; slopes and shifts need a " +
                             "map in metres: reproject both with gdalwarp first");
    }
    if (test.geo_reference().transform.has_value() !=
        reference.geo_reference().transform.has_value()) {
        throw io::InputError("only one of " + test.description() + " and " +
                             reference.description() + " says where it lies on the map");
    }
}

} // namespace

void SurfaceInputs::validate() const
{
    if (mask_bits < 0) {
        throw io::ConfigError("--mask-bits is " + std::to_string(mask_bits) +
                              "; allowed: 1 and up");
    }
    if (mask_bits != 0 && mask.empty()) {
        throw io::ConfigError("--mask-bits needs --mask");
    }
    if (!excluded_classes.empty() && classes.empty()) {
        throw io::ConfigError("--exclude-classes needs --classes");
    }
}

struct SurfaceRows::State {
    SurfaceInputs inputs;
    io::RasterSource test;
    io::RasterSource reference;
    std::optional<io::RasterSource> mask;
    std::optional<io::RasterSource> classes;
    Grid test_grid;
    Grid grid;

    // Of the strip in memory.
    Rect strip;
    Image<float> heights; // of the reference, with a row more on either side
    int rows_before = 0;
    Image<float> mask_values;
    Image<float> class_values;

    // Of the row handed over.
    std::vector<float> difference, slope_east, slope_north;
    std::vector<std::uint8_t> counts, class_row;

    explicit State(const SurfaceInputs& given)
        : inputs(given), test(io::ImageSpec{given.test}),
          reference(io::ImageSpec{given.reference}), test_grid(grid_of(test)),
          grid(grid_of(reference))
    {
        require_one_map(test, reference);
        if (!given.mask.empty()) {
            mask.emplace(io::ImageSpec{given.mask});
            require_size(*mask, reference);
        }
        if (!given.classes.empty()) {
            classes.emplace(io::ImageSpec{given.classes});
            require_size(*classes, reference);
        }
        const auto cols = static_cast<std::size_t>(reference.size().cols);
        for (std::vector<float>* values : {&difference, &slope_east, &slope_north}) {
            values->resize(cols);
        }
        counts.resize(cols);
        class_row.resize(classes ? cols : 0);
    }

    double x_of(int col) const { return grid.x0 + col * grid.dx; }
    double y_of(int row) const { return grid.y0 + row * grid.dy; }
    float height(int row, int col) const
    {
        const int r = row - strip.row + rows_before;
        const bool inside = r >= 0 && r < heights.rows() && col >= 0 && col < heights.cols();
        return inside ? heights(r, col) : kNone;
    }

    void read_strip(int row)
    {
        const Size size = reference.size();
        strip = intersect({row, 0, kStripRows, size.cols}, rect_of(size));
        const Rect grown = intersect({row - 1, 0, strip.rows + 2, size.cols}, rect_of(size));
        rows_before = strip.row - grown.row;
        heights = read_floats(reference, grown);
        if (mask) {
            mask_values = read_floats(*mask, strip);
        }
        if (classes) {
            class_values = read_floats(*classes, strip);
        }
    }

    bool in_mask(int row, int col) const
    {
        const float value = mask_values(row - strip.row, col);
        if (std::isnan(value)) {
            return false;
        }
        return inputs.mask_bits == 0
                   ? value != 0
                   : (static_cast<int>(value) & inputs.mask_bits) == inputs.mask_bits;
    }

    void fill_counts(int row)
    {
        for (int col = 0; col < strip.cols; ++col) {
            const auto i = static_cast<std::size_t>(col);
            bool counted = !std::isnan(height(row, col)) && (!mask || in_mask(row, col));
            if (classes) {
                const float value = class_values(row - strip.row, col);
                const bool known = value >= 0 && value <= 255;
                class_row[i] = known ? static_cast<std::uint8_t>(value) : std::uint8_t{255};
                const auto& out = inputs.excluded_classes;
                counted = counted && known &&
                          std::find(out.begin(), out.end(), class_row[i]) == out.end();
            }
            counts[i] = counted ? 255 : 0;
        }
    }

    void fill_row(int row, const TestWindow& window, const evaluate::SurfaceShift& shift)
    {
        const double y = y_of(row) + shift.north;
        for (int col = 0; col < strip.cols; ++col) {
            const auto i = static_cast<std::size_t>(col);
            const float moved =
                window.at(x_of(col) + shift.east, y) - static_cast<float>(shift.up);
            difference[i] = moved - height(row, col);
            slope_east[i] = static_cast<float>((height(row, col + 1) - height(row, col - 1)) /
                                               (2 * grid.dx));
            slope_north[i] = static_cast<float>((height(row + 1, col) - height(row - 1, col)) /
                                                (2 * grid.dy));
        }
        fill_counts(row);
    }
};

SurfaceRows::SurfaceRows(const SurfaceInputs& inputs)
{
    inputs.validate();
    state_ = std::make_unique<State>(inputs);
}

SurfaceRows::~SurfaceRows() = default;

Size SurfaceRows::size() const
{
    return state_->reference.size();
}

io::GeoReference SurfaceRows::geo_reference() const
{
    return state_->reference.geo_reference();
}

double SurfaceRows::cell_m() const
{
    return std::max(std::abs(state_->grid.dx), std::abs(state_->grid.dy));
}

void SurfaceRows::for_each(const evaluate::SurfaceShift& shift, const SurfaceVisitor& visit)
{
    State& s = *state_;
    for (int row = 0; row < size().rows; row += kStripRows) {
        s.read_strip(row);
        const TestWindow window(
            s.test, s.test_grid, s.x_of(0) + shift.east, s.x_of(s.strip.cols - 1) + shift.east,
            s.y_of(row) + shift.north, s.y_of(s.strip.row_end() - 1) + shift.north);
        for (int r = row; r < s.strip.row_end(); ++r) {
            s.fill_row(r, window, shift);
            visit({r, s.difference, s.slope_east, s.slope_north, s.counts, s.class_row});
        }
    }
}

} // namespace hsgm::pipeline
