#include "tests/reference/agreement.h"

#include "matcher/reduce.h"
#include "matcher/refine.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <utility>

namespace hsgm::reference {

namespace {

std::ostream& operator<<(std::ostream& out, const Rect& r)
{
    return out << "{" << r.row << ", " << r.col << ", " << r.rows << ", " << r.cols << "}";
}

std::ostream& operator<<(std::ostream& out, const DisparityRange& r)
{
    return out << "[" << r.min << ", " << r.max << "]";
}

/// The first pixel where two images differ, or nothing.
template <typename T, typename U>
std::string first_difference(const std::string& what, const Image<T>& matcher,
                             const Image<U>& twin)
{
    std::ostringstream out;
    if (matcher.size() != twin.size()) {
        out << what << ": sizes differ: matcher " << rect_of(matcher.size()) << ", twin "
            << rect_of(twin.size());
        return out.str();
    }
    int count = 0;
    for (int row = 0; row < twin.rows(); ++row) {
        for (int col = 0; col < twin.cols(); ++col) {
            if (matcher(row, col) != twin(row, col) && count++ == 0) {
                out << what << " at row " << row << ", col " << col << ": matcher "
                    << +matcher(row, col) << ", twin " << +twin(row, col);
            }
        }
    }
    if (count > 0) {
        out << " (" << count << " of " << twin.size().area() << " pixels differ)";
    }
    return out.str();
}

template <typename T>
tiling::Patch<T> cut(const Image<T>& image, const Rect& rect)
{
    tiling::Patch<T> patch(rect);
    for (int row = rect.row; row < rect.row_end(); ++row) {
        for (int col = rect.col; col < rect.col_end(); ++col) {
            patch.at(row, col) = image(row, col);
        }
    }
    return patch;
}

template <typename T>
void paste(Image<T>& image, const Rect& rect, const Image<T>& part)
{
    for (int row = 0; row < rect.rows; ++row) {
        for (int col = 0; col < rect.cols; ++col) {
            image(rect.row + row, rect.col + col) = part(row, col);
        }
    }
}

/// What the matcher makes of a case, tile by tile.
struct Outcome {
    Image<std::int32_t> disparity_q8;
    Image<std::uint8_t> first_confidence;
    Image<std::uint16_t> first_reasons;
    Image<std::uint32_t> right_keys;
    Image<float> disparity_px;
    Image<std::uint8_t> confidence;
    Image<std::uint16_t> reasons;
};

/// All levels of an image by the matcher's own step, in random pieces.
std::vector<Image<std::uint16_t>> matcher_pyramid(Random& random,
                                                  const Image<std::uint16_t>& image, int levels)
{
    std::vector<Image<std::uint16_t>> result{image};
    while (static_cast<int>(result.size()) < levels) {
        const Image<std::uint16_t>& fine = result.back();
        Image<std::uint16_t> coarse(tiling::halve(fine.size()));
        for (const Rect& piece : random_partition(random, coarse.size(), 2, 2)) {
            const Rect taps =
                tiling::rect_between(2 * piece.row - 1, 2 * piece.col - 1,
                                     2 * piece.row_end() + 1, 2 * piece.col_end() + 1);
            const auto patch = cut(fine, tiling::intersect(taps, rect_of(fine.size())));
            matcher::reduce(patch, fine.size(), piece, coarse.view().part(piece));
        }
        result.push_back(std::move(coarse));
    }
    return result;
}

Outcome run_matcher(const Case& c)
{
    Random random(c.seed + 1);
    const matcher::Matcher matcher(traits_of(c), c.options);
    const int levels = matcher.plan().levels();
    const auto lefts = matcher_pyramid(random, c.pair.left, levels);
    const auto rights = matcher_pyramid(random, c.pair.right, levels);
    const auto coarse = matcher.solve_coarse(lefts.back(), rights.back());

    const Size size = c.pair.left.size();
    Outcome outcome;
    outcome.disparity_q8 = Image<std::int32_t>(size);
    outcome.first_confidence = Image<std::uint8_t>(size);
    outcome.first_reasons = Image<std::uint16_t>(size);
    outcome.right_keys = Image<std::uint32_t>(c.pair.right.size(), kNoKey);
    for (const Rect& core : c.tiles) {
        const auto support = matcher.support(core);
        std::vector<matcher::LevelImages> images;
        for (int k = 0; k < matcher.plan().windowed_levels(); ++k) {
            const auto i = static_cast<std::size_t>(k);
            images.push_back(
                {cut(lefts[i], support[i].left_image), cut(rights[i], support[i].right_image)});
        }
        const matcher::TileMatch tile = matcher.match_tile(core, images, *coarse);
        paste(outcome.disparity_q8, core, tile.disparity_q8);
        paste(outcome.first_confidence, core, tile.confidence);
        paste(outcome.first_reasons, core, tile.reasons);
        const Rect& keys = tile.right_keys.rect;
        for (int row = keys.row; row < keys.row_end(); ++row) {
            for (int col = keys.col; col < keys.col_end(); ++col) {
                std::uint32_t& least = outcome.right_keys(row, col);
                least = std::min(least, tile.right_keys.at(row, col));
            }
        }
    }

    outcome.disparity_px = Image<float>(size);
    outcome.confidence = Image<std::uint8_t>(size);
    outcome.reasons = Image<std::uint16_t>(size);
    const matcher::PairShape shape = matcher.pair().shape;
    for (const Rect& piece : c.pieces) {
        const auto support = matcher::refine_support(piece, shape, c.options);
        const matcher::RefineInput input{cut(outcome.disparity_q8, support.first_pass),
                                         cut(outcome.first_confidence, support.first_pass),
                                         cut(outcome.first_reasons, support.first_pass),
                                         cut(outcome.right_keys, support.right_keys),
                                         cut(c.pair.left, support.left_image),
                                         cut(c.pair.right, support.right_image)};
        const matcher::Refined refined = matcher::refine(piece, input, shape, c.options);
        paste(outcome.disparity_px, piece, refined.disparity_px);
        paste(outcome.confidence, piece, refined.confidence);
        paste(outcome.reasons, piece, refined.reasons);
    }
    return outcome;
}

} // namespace

std::vector<Rect> random_partition(Random& random, Size size, int most_rows, int most_cols)
{
    const auto cuts = [&](int length, int most) {
        std::vector<int> at{0, length};
        for (int i = random.between(0, most - 1); i > 0; --i) {
            at.push_back(random.between(0, length));
        }
        std::sort(at.begin(), at.end());
        at.erase(std::unique(at.begin(), at.end()), at.end());
        return at;
    };
    const std::vector<int> rows = cuts(size.rows, most_rows);
    const std::vector<int> cols = cuts(size.cols, most_cols);
    std::vector<Rect> parts;
    for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
        for (std::size_t j = 0; j + 1 < cols.size(); ++j) {
            parts.push_back(tiling::rect_between(rows[i], cols[j], rows[i + 1], cols[j + 1]));
        }
    }
    return parts;
}

Case random_case(std::uint64_t seed, const Theme& theme)
{
    Random random(seed);
    Case c;
    c.seed = seed;
    Options& o = c.options;
    o.mode = random.one_of(
        {Mode::hsgm, Mode::hsgm, Mode::hsgm, Mode::hsgm_paper, Mode::sgm, Mode::local});
    const auto costs = matcher::all_costs();
    o.cost =
        costs[static_cast<std::size_t>(random.between(0, static_cast<int>(costs.size()) - 1))];
    o.paths = random.one_of({4, 5, 8, 8, 16});
    o.levels = random.chance(80) ? random.between(1, 4) : 0;
    o.window_px = random.one_of({16, 16, 32, 64});
    o.halo_px = std::min(o.window_px, 2 * random.between(0, 8));
    o.p2 = random.chance(50) ? 192 : random.between(0, 207);
    o.p1 = random.chance(50) ? std::min(24, o.p2) : random.between(0, o.p2);
    o.p2_half_tone = random.chance(50) ? 5 : random.between(1, random.one_of({20, 255}));
    o.prior = random.chance(60);
    o.prune = random.chance(60);
    o.left_right_px = random.between(-1, 3);
    o.speckle_px = random.chance(30) ? 0 : random.between(2, random.one_of({4, 12, 60, 500}));
    o.speckle_range_px = random.one_of({1, 1, 2, 64});
    o.subpixel = random.chance(75) ? Subpixel::census : Subpixel::sums;
    o.min_confidence = random.chance(50) ? 0 : random.between(0, 255);
    o.median = random.one_of({1, 3, 3, 5});
    o.smooth = random.one_of({1, 3, 5, 5});
    o.fill = random.one_of({Fill::none, Fill::occluded, Fill::all});
    o.fill_px = random.one_of({1, 3, 20, 256});
    theme.vary(random, o);

    Size left{random.between(1, theme.most_side_px), random.between(1, theme.most_side_px)};
    if (theme.thin) {
        (random.chance(50) ? left.rows : left.cols) = random.between(1, 6);
    }
    const int right_cols =
        random.chance(50) ? left.cols : random.between(1, theme.most_side_px);
    const auto most_count = static_cast<int>(std::clamp<std::int64_t>(
        theme.most_work / (left.area() * o.paths), theme.least_count, theme.most_count));
    const int count = random.between(theme.least_count, most_count);
    // Some left pixel has a counterpart for some disparity of the range.
    const int first = -(right_cols - 1) - (count - 1);
    c.asked.min = random.chance(30) ? std::clamp(-count / 2, first, left.cols - 1)
                                    : random.between(first, left.cols - 1);
    c.asked.max = c.asked.min + count - 1;

    PairLook look;
    look.noise = random.chance(25);
    look.sixteen_bit = random.chance(30);
    look.grey_levels = random.chance(25) ? random.between(2, 20) : 0;
    look.flat_patches = random.chance(40) ? random.between(1, 4) : 0;
    look.holes = random.chance(30) ? random.between(1, 3) : 0;
    look.lost_percent = random.chance(15) ? random.between(1, 60) : 0;
    c.pair = random_pair(random, left, right_cols, c.asked, look);
    if (look.sixteen_bit) {
        c.tone_left = tone_ends(c.pair.left);
        c.tone_right = tone_ends(c.pair.right);
    } else if (random.chance(20)) {
        c.tone_left.lo = random.between(0, 200);
        c.tone_left.hi = c.tone_left.lo + random.between(1, 300);
    }
    c.tone_left.noise = random.chance(25) ? 0 : random.between(1, 9);
    c.tone_right.noise = c.tone_left.noise;
    if (o.cost == Cost::hmi) {
        c.hmi = HmiCosts({256, 256});
        for (int i = 0; i < 256; ++i) {
            for (int k = 0; k < 256; ++k) {
                c.hmi(i, k) = static_cast<std::uint8_t>(
                    std::min(48, std::abs(i - k) + random.between(0, 4)));
            }
        }
    }
    c.tiles = random.chance(30) ? std::vector<Rect>{tiling::rect_of(left)}
                                : random_partition(random, left, 3, 3);
    c.pieces = random_partition(random, left, 3, 3);
    return c;
}

std::string Case::describe() const
{
    std::ostringstream out;
    out << "seed " << seed << ": left " << pair.left.rows() << " x " << pair.left.cols()
        << ", right " << pair.right.cols() << " columns, asked " << asked << ", tones ["
        << tone_left.lo << ", " << tone_left.hi << "] [" << tone_right.lo << ", "
        << tone_right.hi << "], noise " << tone_left.noise << " and " << tone_right.noise
        << ", mode " << name(options.mode) << ", cost " << name(options.cost) << ", paths "
        << options.paths << ", levels " << options.levels << ", window " << options.window_px
        << ", halo " << options.halo_px << ", p1 " << options.p1 << ", p2 " << options.p2
        << ", p2_half_tone " << options.p2_half_tone << ", prior " << options.prior
        << ", prune " << options.prune << ", left_right_px " << options.left_right_px
        << ", speckle_px " << options.speckle_px << ", speckle_range_px "
        << options.speckle_range_px << ", subpixel " << name(options.subpixel)
        << ", min_confidence " << options.min_confidence << ", median " << options.median
        << ", smooth " << options.smooth << ", fill " << name(options.fill) << ", fill_px "
        << options.fill_px << ", tiles";
    for (const Rect& tile : tiles) {
        out << " " << tile;
    }
    out << ", pieces";
    for (const Rect& piece : pieces) {
        out << " " << piece;
    }
    return out.str();
}

matcher::PairTraits traits_of(const Case& c)
{
    matcher::PairTraits traits;
    traits.shape = {c.pair.left.size(), c.pair.right.size(), c.asked};
    traits.left_tone = {c.tone_left.lo, c.tone_left.hi, c.tone_left.noise};
    traits.right_tone = {c.tone_right.lo, c.tone_right.hi, c.tone_right.noise};
    if (c.options.cost == Cost::hmi) {
        traits.hmi = table_of(c.hmi);
    }
    return traits;
}

std::shared_ptr<const matcher::HmiTable> table_of(const HmiCosts& costs)
{
    auto table = std::make_shared<matcher::HmiTable>();
    std::copy(costs.pixels().begin(), costs.pixels().end(), table->cost.begin());
    return table;
}

std::string difference(const Case& c)
{
    const MatchResult twin =
        match(c.pair.left, c.pair.right, c.asked, c.tone_left, c.tone_right, c.options, &c.hmi);
    const RefineResult refined = refine(twin, c.asked, c.options);
    const Outcome outcome = run_matcher(c);
    for (const std::string& text :
         {first_difference("disparity_q8", outcome.disparity_q8, twin.disparity_q8),
          first_difference("first confidence", outcome.first_confidence, twin.confidence),
          first_difference("first reasons", outcome.first_reasons, twin.reasons),
          first_difference("right keys", outcome.right_keys, twin.right_keys),
          first_difference("final reasons", outcome.reasons, refined.reasons),
          first_difference("final disparity", outcome.disparity_px, refined.disparity_px),
          first_difference("final confidence", outcome.confidence, refined.confidence)}) {
        if (!text.empty()) {
            return text;
        }
    }
    return {};
}

} // namespace hsgm::reference
