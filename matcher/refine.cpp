#include "matcher/refine.h"

#include "matcher/confidence.h"
#include "matcher/host/confidence.h"
#include "matcher/host/fill.h"
#include "matcher/host/finish.h"
#include "matcher/host/left_right.h"
#include "matcher/host/median_filter.h"
#include "matcher/host/smooth.h"
#include "matcher/host/speckle.h"
#include "matcher/host/subpixel.h"
#include "matcher/reasons.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace hsgm::matcher {

namespace {

using host::DisparityPlane;
using host::kHole;
using tiling::Patch;
using tiling::Rect;

/// The least confident value of all: one that was not measured.
constexpr std::uint8_t kInterpolatedConfidence = 1;

// The pixels whose result each step must give, so that the next one has all it reads.
struct Reach {
    Rect means;       // read where holes are filled
    Rect medians;     // read where means are taken
    Rect confidences; // of values that medians are taken from
    Rect fractions;
    Rect speckles;
    Rect first_pass;

    Reach(const Rect& core, const PairShape& shape, const Options& options)
    {
        const auto grown = [&shape](const Rect& rect, int px) {
            return intersect(expand(rect, px), rect_of(shape.left));
        };
        means = grown(core, options.fill == Fill::none ? 0 : options.fill_px);
        medians = grown(means, options.smooth / 2);
        confidences = grown(medians, options.median / 2);
        fractions = grown(confidences, kConfidenceReach);
        const bool census = options.subpixel == Subpixel::census;
        speckles = grown(fractions, census ? host::kSubpixelReach : 0);
        first_pass = grown(speckles, std::max(options.speckle_px - 1, 0));
    }
};

void require_holds(const Rect& has, const Rect& needed, const char* what)
{
    if (!has.contains(needed)) {
        throw std::invalid_argument(std::string("refine: its input holds too little of ") +
                                    what + "; refine_support says how much is needed");
    }
}

void require_support(const RefineInput& input, const RefineSupport& support)
{
    require_holds(input.disparity_q8.rect, support.first_pass, "the disparities");
    require_holds(input.confidence.rect, support.first_pass, "the confidences");
    require_holds(input.reasons.rect, support.first_pass, "the reasons");
    require_holds(input.right_keys.rect, support.right_keys, "the right view's keys");
    require_holds(input.left.rect, support.left_image, "the left image");
    require_holds(input.right.rect, support.right_image, "the right image");
}

template <typename T>
Patch<T> cut(const Patch<T>& from, const Rect& part)
{
    Patch<T> result(part);
    for (int row = part.row; row < part.row_end(); ++row) {
        std::copy_n(from.pixels.row(row - from.rect.row) + (part.col - from.rect.col),
                    part.cols, result.pixels.row(row - part.row));
    }
    return result;
}

// Values after the step that gives them their fractions.
DisparityPlane with_fractions(const DisparityPlane& checked, const RefineInput& input,
                              const PairShape& shape, const Options& options,
                              const Rect& wanted)
{
    DisparityPlane result(wanted);
    if (options.subpixel == Subpixel::census) {
        host::refine_fractions({checked, input.left, input.right, shape}, result);
        return result;
    }
    for (int row = wanted.row; row < wanted.row_end(); ++row) {
        std::copy_n(checked.at(row, wanted.col), wanted.cols, result.at(row, wanted.col));
    }
    return result;
}

void remove_uncertain(int min_confidence, const Patch<std::uint8_t>& confidences,
                      DisparityPlane& disparities, Patch<std::uint16_t>& reasons)
{
    const Rect& part = confidences.rect;
    for (int row = part.row; row < part.row_end(); ++row) {
        for (int col = part.col; col < part.col_end(); ++col) {
            std::int32_t& value = *disparities.at(row, col);
            if (value != kHole && confidences.at(row, col) < min_confidence) {
                value = kHole;
                std::uint16_t& bits = reasons.at(row, col);
                bits = static_cast<std::uint16_t>(bits | kUncertain);
            }
        }
    }
}

Patch<std::int32_t> medians_of(const DisparityPlane& disparities, const Options& options,
                               const Rect& wanted)
{
    if (options.median > 1) {
        return host::medians(disparities, options.median, wanted);
    }
    Patch<std::int32_t> result(wanted);
    for (int row = wanted.row; row < wanted.row_end(); ++row) {
        std::copy_n(disparities.at(row, wanted.col), wanted.cols,
                    result.pixels.row(row - wanted.row));
    }
    return result;
}

Refined result_of(const Rect& core, const Patch<std::int32_t>& disparity_q8,
                  const Patch<std::uint8_t>& confidences, const Patch<std::uint16_t>& reasons)
{
    Refined result{tiling::Image<float>(core.size()), tiling::Image<std::uint8_t>(core.size()),
                   tiling::Image<std::uint16_t>(core.size())};
    for (int r = 0; r < core.rows; ++r) {
        const int row = core.row + r;
        const std::uint16_t* bits = &reasons.at(row, core.col);
        std::copy_n(bits, core.cols, result.reasons.row(r));
        host::finish_row(
            {&disparity_q8.at(row, core.col), bits, &confidences.at(row, core.col), core.cols},
            kNodataDisparity, kInterpolatedConfidence, result.disparity_px.row(r),
            result.confidence.row(r));
    }
    return result;
}

} // namespace

RefineSupport refine_support(const Rect& core, const PairShape& shape, const Options& options)
{
    const Reach reach(core, shape, options);
    RefineSupport support;
    support.first_pass = reach.first_pass;
    support.right_keys =
        intersect(right_reach(reach.first_pass, shape.asked), rect_of(shape.right));
    if (options.subpixel == Subpixel::census) {
        const auto images = host::subpixel_images(reach.fractions, shape);
        support.left_image = images.left;
        support.right_image = images.right;
    }
    return support;
}

Refined refine(const Rect& core, const RefineInput& input, const PairShape& shape,
               const Options& options)
{
    require_support(input, refine_support(core, shape, options));
    const Reach reach(core, shape, options);
    Patch<std::uint16_t> reasons = cut(input.reasons, reach.first_pass);
    DisparityPlane checked(reach.first_pass);
    host::check_left_right(input.disparity_q8, input.right_keys, shape, options.left_right_px,
                           core, reasons, checked);
    if (options.speckle_px > 0) {
        host::remove_speckles(options.speckle_px, 256 * options.speckle_range_px,
                              reach.speckles, checked, reasons);
    }
    DisparityPlane disparities =
        with_fractions(checked, input, shape, options, reach.fractions);
    const Patch<std::uint8_t> confidences =
        host::confidences(disparities, input.confidence, reach.confidences);
    if (options.min_confidence > 0) {
        remove_uncertain(options.min_confidence, confidences, disparities, reasons);
    }
    Patch<std::int32_t> values = medians_of(disparities, options, reach.medians);
    if (options.smooth > 1) {
        values = host::smoothed(values, options.smooth, reach.means);
    }
    if (options.fill != Fill::none) {
        values =
            host::filled(values, options.fill_px, options.fill == Fill::all, core, reasons);
    }
    return result_of(core, values, confidences, reasons);
}

std::int64_t refine_bytes(const Rect& core, const PairShape& shape, const Options& options)
{
    const Reach reach(core, shape, options);
    const RefineSupport support = refine_support(core, shape, options);
    constexpr std::int64_t kInput = 4 + 1 + 2;
    constexpr std::int64_t kResult = 4 + 1 + 2;
    const std::int64_t read = support.first_pass.area() * kInput +
                              support.right_keys.area() * 4 +
                              (support.left_image.area() + support.right_image.area()) * 2;
    const std::int64_t copied = support.first_pass.area() * 2; // the reasons
    std::int64_t work = DisparityPlane::bytes(reach.first_pass.size());
    const std::int64_t later =
        DisparityPlane::bytes(reach.fractions.size()) + reach.confidences.area() +
        2 * 4 * reach.medians.area() +
        (options.smooth > 1 ? host::smooth_bytes(reach.medians.size()) : 0) +
        host::subpixel_bytes(reach.fractions, shape);
    const std::int64_t speckles =
        options.speckle_px > 0 ? host::speckle_bytes(reach.first_pass.size()) : 0;
    work += std::max(speckles, later);
    return read + copied + work + core.area() * kResult;
}

} // namespace hsgm::matcher
