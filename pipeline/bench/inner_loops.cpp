#include "pipeline/bench/inner_loops.h"

#include "matcher/matcher.h"
#include "pipeline/bench/measure.h"
#include "pipeline/error.h"

#include <random>

namespace hsgm::bench {

namespace {

constexpr int kSide = 256; // 16 windows, whose images and results fit the second cache
constexpr int kDisparities = 128;
constexpr double kLeast_s = 0.1; // of one measurement

tiling::Patch<std::uint16_t> noise(tiling::Size size, std::uint32_t seed)
{
    std::mt19937 random(seed);
    tiling::Patch<std::uint16_t> patch(rect_of(size));
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            patch.at(row, col) = static_cast<std::uint16_t>(64 + random() % 128);
        }
    }
    return patch;
}

matcher::Options options_of(int path_bits)
{
    matcher::Options options;
    options.mode = matcher::Mode::local;
    options.cost = matcher::Cost::census5x5;
    options.halo_px = 0;
    options.prior = options.prune = false;
    options.p2 = path_bits == 8 ? 192 : 400;
    return options;
}

// Runs `work` until it has taken long enough to be timed; returns the computing time of one,
// which for one thread is its time where nothing else disturbs it.
template <typename Work>
double seconds_of(Work work)
{
    const double start_s = cpu_clock_s();
    double time_s = 0;
    int times = 0;
    while (time_s < kLeast_s) {
        work();
        ++times;
        time_s = cpu_clock_s() - start_s;
    }
    return time_s / times;
}

double cells_per_s(int path_bits, int repeats)
{
    // Every disparity of every pixel has a counterpart.
    matcher::PairTraits pair;
    pair.shape = {{kSide, kSide}, {kSide, kSide + kDisparities}, {1 - kDisparities, 0}};
    const matcher::Matcher matcher(pair, options_of(path_bits));
    const std::vector<matcher::LevelImages> images{
        {noise(pair.shape.left, 1), noise(pair.shape.right, 2)}};
    const auto none = matcher.solve_coarse({}, {});
    std::int64_t cells = 0;
    std::vector<double> seconds;
    on_threads(1, [&] {
        for (int i = 0; i < repeats; ++i) {
            pipeline::check_stop();
            seconds.push_back(seconds_of([&] {
                cells = matcher.match_tile(rect_of(pair.shape.left), images, *none).work.cells;
            }));
        }
    });
    return static_cast<double>(cells) / median(seconds);
}

} // namespace

std::vector<InnerRate> measure_inner_loops(const std::vector<matcher::Instructions>& sets,
                                           int repeats)
{
    std::vector<std::optional<matcher::Instructions>> asked(sets.begin(), sets.end());
    if (asked.empty()) {
        asked.emplace_back();
    }
    std::vector<InnerRate> rates;
    for (const auto& set : asked) {
        matcher::use_instructions(set);
        for (const int bits : {8, 16}) {
            rates.push_back({set, bits, cells_per_s(bits, repeats)});
        }
    }
    matcher::use_instructions(std::nullopt);
    return rates;
}

} // namespace hsgm::bench
