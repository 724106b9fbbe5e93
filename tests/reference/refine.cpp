#include "tests/reference/refine.h"

#include "matcher/reasons.h"

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

namespace hsgm::reference {

namespace {

bool has_value(std::uint16_t reasons)
{
    return (reasons & matcher::kInvalidating) == 0;
}

} // namespace

std::uint16_t left_right_reason(const Image<std::uint32_t>& right_keys, int row, int x,
                                int winner, DisparityRange asked, int tolerance_px)
{
    const auto inside = [&](int col) { return col >= 0 && col < right_keys.cols(); };
    // Does the right pixel that lies at disparity d from us agree with d?
    const auto agrees = [&](int d) {
        const std::uint32_t key = right_keys(row, x - d);
        const int right_winner = static_cast<int>(key & 0xFFFFu) + asked.min;
        return key != kNoKey && std::abs(d - right_winner) <= tolerance_px;
    };
    if (!inside(x - winner)) {
        return matcher::kOutside;
    }
    if (agrees(winner)) {
        return 0;
    }
    for (int d = asked.min; d <= asked.max; ++d) {
        if (inside(x - d) && agrees(d)) {
            return matcher::kInconsistent;
        }
    }
    return matcher::kOccluded;
}

std::int32_t median_of_valid(const Image<std::int32_t>& disparity_q8,
                             const Image<std::uint16_t>& reasons, int row, int col, int side)
{
    const Rect image = tiling::rect_of(disparity_q8.size());
    std::vector<std::int32_t> values;
    for (int r = row - side / 2; r <= row + side / 2; ++r) {
        for (int c = col - side / 2; c <= col + side / 2; ++c) {
            if (image.contains(r, c) && has_value(reasons(r, c))) {
                values.push_back(disparity_q8(r, c));
            }
        }
    }
    std::sort(values.begin(), values.end());
    return values[(values.size() - 1) / 2];
}

std::int32_t mean_of_near(const Surface& surface, int row, int col, int side)
{
    const std::int32_t own = surface.q8(row, col);
    std::int32_t sum = 0;
    std::int32_t count = 0;
    for (int r = row - side / 2; r <= row + side / 2; ++r) {
        for (int c = col - side / 2; c <= col + side / 2; ++c) {
            if (surface.has(r, c) && std::abs(surface.q8(r, c) - own) <= 256) {
                sum += surface.q8(r, c);
                ++count;
            }
        }
    }
    return tiling::floor_div(2 * sum + count, 2 * count);
}

Image<int> segment_sizes(const Surface& surface, int range_q8)
{
    const Size size = surface.q8.size();
    Image<int> sizes(size, 0);
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            if (!surface.has(row, col) || sizes(row, col) != 0) {
                continue;
            }
            std::vector<std::pair<int, int>> segment{{row, col}};
            sizes(row, col) = -1; // met
            for (std::size_t i = 0; i < segment.size(); ++i) {
                const auto [r, c] = segment[i];
                for (const auto& [nr, nc] :
                     {std::pair{r - 1, c}, {r + 1, c}, {r, c - 1}, {r, c + 1}}) {
                    if (surface.has(nr, nc) && sizes(nr, nc) == 0 &&
                        std::abs(surface.q8(r, c) - surface.q8(nr, nc)) <= range_q8) {
                        sizes(nr, nc) = -1;
                        segment.emplace_back(nr, nc);
                    }
                }
            }
            for (const auto& [r, c] : segment) {
                sizes(r, c) = static_cast<int>(segment.size());
            }
        }
    }
    return sizes;
}

std::vector<std::int32_t> values_around(const Surface& surface, int row, int col, int reach_px)
{
    std::vector<std::int32_t> values;
    for (int down = -1; down <= 1; ++down) {
        for (int right = -1; right <= 1; ++right) {
            for (int i = 1; i <= reach_px && (down != 0 || right != 0); ++i) {
                if (surface.has(row + i * down, col + i * right)) {
                    values.push_back(surface.q8(row + i * down, col + i * right));
                    break;
                }
            }
        }
    }
    std::sort(values.begin(), values.end());
    return values;
}

namespace {

/// The whole image on its way through the steps.
class Refinement {
public:
    Refinement(const MatchResult& match, DisparityRange asked, const Options& options)
        : match_(match), level_(match.levels[0]), asked_(asked), options_(options),
          size_(match.disparity_q8.size()), reasons_(match.reasons),
          confidence_(size_, std::uint8_t{0})
    {
        surface_.q8 = match.disparity_q8;
        surface_.winners = level_.winners;
        surface_.has_value = Image<std::uint8_t>(size_);
    }

    RefineResult result()
    {
        check_left_right();
        remove_speckles();
        find_fractions();
        find_confidences();
        take_medians();
        take_means();
        fill_holes();
        RefineResult result{Image<float>(size_, -32768.0F), confidence_, reasons_};
        each_value([&](int row, int col) {
            result.disparity_px(row, col) = static_cast<float>(surface_.q8(row, col)) / 256.0F;
        });
        return result;
    }

private:
    template <typename Body>
    void each_pixel(Body body) const
    {
        for (int row = 0; row < size_.rows; ++row) {
            for (int col = 0; col < size_.cols; ++col) {
                body(row, col);
            }
        }
    }
    template <typename Body>
    void each_value(Body body) const
    {
        each_pixel([&](int row, int col) {
            if (surface_.has(row, col)) {
                body(row, col);
            }
        });
    }
    void take_away(int row, int col, int reason)
    {
        reasons_(row, col) = static_cast<std::uint16_t>(reasons_(row, col) | reason);
    }
    void see_what_is_left()
    {
        each_pixel([&](int row, int col) {
            surface_.has_value(row, col) = has_value(reasons_(row, col)) ? 1 : 0;
            if (surface_.has_value(row, col) == 0) {
                confidence_(row, col) = 0;
            }
        });
    }

    void check_left_right()
    {
        see_what_is_left();
        if (options_.left_right_px < 0) {
            return;
        }
        each_value([&](int row, int col) {
            take_away(row, col,
                      left_right_reason(match_.right_keys, row, col, surface_.winners(row, col),
                                        asked_, options_.left_right_px));
        });
        see_what_is_left();
    }

    void remove_speckles()
    {
        if (options_.speckle_px == 0) {
            return;
        }
        const Image<int> sizes = segment_sizes(surface_, 256 * options_.speckle_range_px);
        each_value([&](int row, int col) {
            if (sizes(row, col) < options_.speckle_px) {
                take_away(row, col, matcher::kSpeckle);
            }
        });
        see_what_is_left();
    }

    void find_fractions()
    {
        if (options_.subpixel != matcher::Subpixel::census) {
            return;
        }
        Image<std::int32_t> values = surface_.q8;
        each_value([&](int row, int col) {
            values(row, col) = census_fraction(level_.pair.left, level_.pair.right, surface_,
                                               asked_, row, col);
        });
        surface_.q8 = values;
    }

    void find_confidences()
    {
        each_value([&](int row, int col) {
            confidence_(row, col) = confidence_at(surface_, match_.confidence, row, col);
        });
        each_value([&](int row, int col) {
            if (confidence_(row, col) < options_.min_confidence) {
                take_away(row, col, matcher::kUncertain);
            }
        });
        see_what_is_left();
    }

    void take_medians()
    {
        Image<std::int32_t> values = surface_.q8;
        each_value([&](int row, int col) {
            values(row, col) =
                median_of_valid(surface_.q8, reasons_, row, col, options_.median);
        });
        surface_.q8 = values;
    }

    void take_means()
    {
        Image<std::int32_t> values = surface_.q8;
        each_value([&](int row, int col) {
            values(row, col) = mean_of_near(surface_, row, col, options_.smooth);
        });
        surface_.q8 = values;
    }

    void fill_holes()
    {
        if (options_.fill == matcher::Fill::none) {
            return;
        }
        int closed = matcher::kOccluded;
        if (options_.fill == matcher::Fill::all) {
            closed |= matcher::kInconsistent | matcher::kSpeckle | matcher::kUncertain;
        }
        Surface filled = surface_;
        each_pixel([&](int row, int col) {
            const int reasons = reasons_(row, col);
            if ((reasons & closed) == 0) {
                return;
            }
            const auto values = values_around(surface_, row, col, options_.fill_px);
            if (values.size() < 2) {
                return;
            }
            const bool occluded = (reasons & matcher::kOccluded) != 0;
            filled.q8(row, col) = occluded ? values[1] : values[(values.size() - 1) / 2];
            filled.has_value(row, col) = 1;
            confidence_(row, col) = 1;
            reasons_(row, col) =
                static_cast<std::uint16_t>((reasons & 0xFF00) | matcher::kInterpolated);
        });
        surface_ = filled;
    }

    const MatchResult& match_;
    const Level& level_;
    DisparityRange asked_;
    const Options& options_;
    Size size_;
    Surface surface_;
    Image<std::uint16_t> reasons_;
    Image<std::uint8_t> confidence_;
};

} // namespace

RefineResult refine(const MatchResult& match, DisparityRange asked, const Options& options)
{
    return Refinement(match, asked, options).result();
}

} // namespace hsgm::reference
