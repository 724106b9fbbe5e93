#include "pipeline/stages/disparity_rows.h"

#include "io/error.h"
#include "pipeline/error.h"
#include "pipeline/evaluate/occlusion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hsgm::pipeline {

namespace {

constexpr int kStripRows = 64;

std::string in_words(tiling::Size size)
{
    return std::to_string(size.rows) + " rows x " + std::to_string(size.cols) + " columns";
}

// One raster of disparities or mask values, in memory strip by strip.
class Strips {
public:
    Strips(io::ImageSpec spec, double scale, bool zero_is_unknown)
        : source_(std::move(spec)), scale_(scale), zero_is_unknown_(zero_is_unknown)
    {
    }

    tiling::Size size() const { return source_.size(); }
    std::string description() const { return source_.description(); }

    void read(int row, int rows)
    {
        check_stop();
        const tiling::Size strip{rows, size().cols};
        stored_ = tiling::Image<double>(strip);
        values_ = tiling::Image<float>(strip);
        source_.read({row, 0, rows, strip.cols}, stored_);
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        std::transform(stored_.pixels().begin(), stored_.pixels().end(), values_.data(),
                       [&](double v) {
                           const bool unknown = zero_is_unknown_ && v == 0;
                           return static_cast<float>(unknown ? kNone : v / scale_);
                       });
    }

    std::span<const float> row(int r) const { return values_.view().row_span(r); }

private:
    io::RasterSource source_;
    double scale_;
    bool zero_is_unknown_;
    tiling::Image<double> stored_;
    tiling::Image<float> values_;
};

using OptionalStrips = std::unique_ptr<Strips>;

OptionalStrips open(const std::string& path, double scale)
{
    return path.empty() ? nullptr : std::make_unique<Strips>(io::ImageSpec{path}, scale, false);
}

// Integer rasters have no NaN, and by custom store 0 where the truth is unknown.
OptionalStrips open_truth(const std::string& path, const DisparityInputs& inputs)
{
    if (path.empty()) {
        return nullptr;
    }
    const io::ImageSpec spec{path, 0, inputs.truth_nodata};
    const bool integer = !io::is_floating(io::RasterSource(spec).pixel_type());
    return std::make_unique<Strips>(spec, inputs.truth_scale, integer && !inputs.truth_nodata);
}

struct Rasters {
    OptionalStrips test;
    OptionalStrips truth;
    OptionalStrips truth_right;
    OptionalStrips mask;
    OptionalStrips confidence;

    explicit Rasters(const DisparityInputs& inputs)
        : test(open(inputs.test, inputs.test_scale)), truth(open_truth(inputs.truth, inputs)),
          truth_right(open_truth(inputs.truth_right, inputs)), mask(open(inputs.mask, 1)),
          confidence(open(inputs.confidence, 1))
    {
        require_size_of_test(truth, test->size().cols);
        require_size_of_test(mask, test->size().cols);
        require_size_of_test(confidence, test->size().cols);
        if (truth_right) {
            require_size_of_test(truth_right, truth_right->size().cols); // rows alone
        }
    }

    void require_size_of_test(const OptionalStrips& other, int cols) const
    {
        const tiling::Size wanted{test->size().rows, cols};
        if (other && other->size() != wanted) {
            throw io::InputError(other->description() + " has " + in_words(other->size()) +
                                 ", but " + test->description() + " has " +
                                 in_words(test->size()));
        }
    }

    void read(int row, int rows)
    {
        for (const OptionalStrips* raster : {&test, &truth, &truth_right, &mask, &confidence}) {
            if (*raster) {
                (*raster)->read(row, rows);
            }
        }
    }
};

// What counts on row r of the strip in memory.
void fill_mask(const Rasters& rasters, const DisparityInputs& inputs, int r,
               std::vector<std::uint8_t>& counts)
{
    std::fill(counts.begin(), counts.end(), std::uint8_t{255});
    if (rasters.truth_right) {
        evaluate::nonoccluded_by_cross_check(rasters.truth->row(r), rasters.truth_right->row(r),
                                             counts);
    } else if (inputs.zbuffer) {
        evaluate::nonoccluded_by_zbuffer(rasters.truth->row(r), rasters.test->size().cols,
                                         counts);
    }
    if (!rasters.mask) {
        return;
    }
    const std::span<const float> mask = rasters.mask->row(r);
    for (std::size_t c = 0; c < counts.size(); ++c) {
        const bool chosen = inputs.mask_value
                                ? mask[c] == static_cast<float>(*inputs.mask_value)
                                : mask[c] != 0 && !std::isnan(mask[c]);
        counts[c] = chosen ? counts[c] : 0;
    }
}

void require_scale(const char* option, double scale)
{
    if (!(scale > 0) || !std::isfinite(scale)) {
        throw io::ConfigError(std::string(option) + " is " + std::to_string(scale) +
                              "; allowed: above 0");
    }
}

} // namespace

void DisparityInputs::validate() const
{
    require_scale("--scale", truth_scale);
    require_scale("--test-scale", test_scale);
    if (truth.empty() && (!truth_right.empty() || zbuffer)) {
        throw io::ConfigError("--truth-right and --nonoccluded need a truth of the left view");
    }
    if (!truth_right.empty() && zbuffer) {
        throw io::ConfigError("--truth-right and --nonoccluded zbuffer are two ways to find "
                              "the non-occluded pixels; give one");
    }
    if (mask_value && mask.empty()) {
        throw io::ConfigError("--mask-value needs --mask");
    }
}

void for_each_row(const DisparityInputs& inputs, const RowVisitor& visit)
{
    inputs.validate();
    Rasters rasters(inputs);
    const tiling::Size size = rasters.test->size();
    std::vector<std::uint8_t> counts(static_cast<std::size_t>(size.cols));
    for (int row = 0; row < size.rows; row += kStripRows) {
        const int rows = std::min(kStripRows, size.rows - row);
        rasters.read(row, rows);
        for (int r = 0; r < rows; ++r) {
            fill_mask(rasters, inputs, r, counts);
            const auto row_of = [r](const OptionalStrips& raster) {
                return raster ? raster->row(r) : std::span<const float>{};
            };
            visit({rasters.test->row(r), row_of(rasters.truth), counts,
                   row_of(rasters.confidence)});
        }
    }
}

} // namespace hsgm::pipeline
