#include "matcher/matcher.h"

#include "matcher/host/levels.h"

#include <algorithm>
#include <stdexcept>

namespace hsgm::matcher {

/// Buffers of the threads that ever worked for this matcher; one of the two is used.
struct Matcher::Workers {
    host::Workspaces<std::uint8_t> narrow;
    host::Workspaces<std::uint16_t> wide;
};

namespace {

tiling::Patch<std::uint16_t> copy(tiling::ImageView<const std::uint16_t> image)
{
    tiling::Patch<std::uint16_t> patch(rect_of(image.size()));
    for (int row = 0; row < image.rows(); ++row) {
        std::copy_n(image.row(row), image.cols(), patch.pixels.row(row));
    }
    return patch;
}

// One piece of work for whichever width the penalties need.
template <typename Work>
auto with_levels(const PairTraits& pair, const Options& options, const LevelPlan& plan,
                 Work work)
{
    if (options.fits_8_bits()) {
        return work(host::Levels<std::uint8_t>(pair, options, plan));
    }
    return work(host::Levels<std::uint16_t>(pair, options, plan));
}

const Options& validated(const Options& options)
{
    options.validate();
    return options;
}

} // namespace

MatchStatistics work_of(const CoarseSolution& coarse)
{
    return coarse.work;
}

Matcher::Matcher(PairTraits pair, const Options& options)
    : pair_(std::move(pair)), options_(validated(options).resolved()),
      plan_(plan_levels(pair_.shape, options_)), workers_(std::make_shared<Workers>())
{
    if (options_.cost == Cost::hmi && pair_.hmi == nullptr) {
        throw std::invalid_argument("cost hmi needs the pair's table: see solve_hmi_table");
    }
}

std::shared_ptr<const CoarseSolution>
Matcher::solve_coarse(tiling::ImageView<const std::uint16_t> left,
                      tiling::ImageView<const std::uint16_t> right) const
{
    return with_levels(pair_, options_, plan_, [&](const auto& levels) {
        return plan_.coarsest_whole ? levels.solve_whole({copy(left), copy(right)})
                                    : levels.no_whole();
    });
}

std::vector<tiling::LevelSupport> Matcher::support(const tiling::Rect& core) const
{
    return tiling::tile_support(core, plan_.left_sizes, plan_.right_sizes, plan_.ranges,
                                support_rule(options_));
}

TileMatch Matcher::match_tile(const tiling::Rect& core, std::span<const LevelImages> images,
                              const CoarseSolution& coarse) const
{
    const auto needed = support(core);
    if (options_.fits_8_bits()) {
        return host::Levels<std::uint8_t>(pair_, options_, plan_)
            .solve_tile(core, images, needed, coarse, workers_->narrow);
    }
    return host::Levels<std::uint16_t>(pair_, options_, plan_)
        .solve_tile(core, images, needed, coarse, workers_->wide);
}

} // namespace hsgm::matcher
