#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace hsgm::evaluate {

struct SeamOptions {
    int cell_px = 64;       ///< side of a window or tile; the grid is anchored at (0, 0)
    double cap_px = 8;      ///< larger jumps count as this much
    int far_px = 4;         ///< "elsewhere" is more than this from every border
    int resamples = 1000;   ///< of the bootstrap
    std::uint64_t seed = 1; ///< of the bootstrap

    /// Throws std::invalid_argument naming the option, its value and what is allowed.
    void validate() const;
};

/// Jumps of disparity at the borders of a grid against elsewhere. 1 = no seam; below 1
/// happens by chance, or where windows smooth.
struct SeamScore {
    double ratio = 0;     ///< mean jump at borders / mean jump elsewhere; NaN without pairs
    double ratio_low = 0; ///< 95 % bootstrap interval over image rows
    double ratio_high = 0;
    double border_jump_px = 0; ///< mean jump of pairs that straddle a border
    double far_jump_px = 0;    ///< mean jump of pairs far from every border
    std::int64_t border_pairs = 0;
    std::int64_t far_pairs = 0;
};

/// The seam figure. The error e = test - truth; the jump of two 4-neighbours is
/// |e_a - e_b|, capped. Without truth, the disparity itself stands for e.
///
///      cell   cell
///     . . . a|b . . .        a, b straddle a border: the line between columns k cell - 1
///     . . . .|. . . .        and k cell (rows alike). Pixels are centres, so a and b are
///     -------+-------        0.5 px from it, and a pair is far where both pixels are more
///     . . . .|. . . .        than far_px from every line.
///
/// Rows must come from top to bottom, every one; a row is kept for its pairs with the next.
class SeamScorer {
public:
    /// Throws std::invalid_argument where the options are not valid.
    explicit SeamScorer(const SeamOptions& options);

    /// The next row; all spans of one length. NaN (or infinity) = no value. `truth_px` may
    /// be empty (no truth at all), and so may `mask`; a pixel with mask 0 (occluded, say)
    /// is in no pair.
    void add_row(std::span<const float> test_px, std::span<const float> truth_px = {},
                 std::span<const std::uint8_t> mask = {});

    SeamScore score() const;

private:
    /// Jumps of one image row: of its pixels with their right neighbours and with those above.
    struct Sums {
        double border_px = 0;
        double far_px = 0;
        std::int64_t border_pairs = 0;
        std::int64_t far_pairs = 0;

        void add(const Sums& other);
        double ratio() const;
    };

    void add_pair(double a_px, double b_px, bool straddles, bool is_far, Sums& sums) const;
    bool is_far(int index) const;
    void bootstrap(SeamScore& score) const;

    SeamOptions options_;
    std::vector<double> previous_; ///< e of the row above; NaN = none
    std::vector<double> current_;
    std::vector<Sums> rows_;
};

} // namespace hsgm::evaluate
