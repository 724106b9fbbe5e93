#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hsgm::matcher {

/// How paths start where they enter a window; see docs/algorithm.md.
enum class Mode {
    hsgm,       ///< windows with a halo, path costs inherited from the coarser level
    hsgm_paper, ///< eq. 2 and 3 of Won and Jung to the letter: no halo, no pruning, no prior
    sgm,        ///< the full image in one piece
    local,      ///< windows on their own, with an overlap
};

/// Matching costs; see docs/algorithm.md, section 3.
enum class Cost {
    census5x5,
    census7x7,
    census9x7,
    pairs5x5,          ///< census of touching pixels
    ternary5x5,        ///< census with a tolerance
    census_ad,         ///< census5x5 and the difference of tones
    pairs_bt,          ///< pairs5x5 and the difference of gradients, insensitive to sampling
    birchfield_tomasi, ///< differences of gradients and tones, insensitive to sampling
    hmi,               ///< hierarchical mutual information
};

/// What fractions of a pixel are read from.
enum class Subpixel {
    census, ///< a sparse census, summed over neighbours on the same surface
    sums,   ///< the sums of path costs
};

/// Which holes of the second pass are closed with values made up from what lies round them.
enum class Fill {
    none,
    occluded, ///< those behind something nearer, from the background
    all,      ///< and mismatches
};

/// Everything that defines a match, but for the disparity range and the images.
/// The defaults are those of mode `hsgm`.
struct Options {
    Mode mode = Mode::hsgm;
    Cost cost = Cost::ternary5x5;
    int paths = 8;            ///< 4, 5, 8 or 16
    int levels = 0;           ///< 1..12; 0 = auto
    int window_px = 64;       ///< multiple of 16, 16..1024
    int halo_px = 8;          ///< even, 0..window; in mode `local` this is the overlap
    int p1 = 24;              ///< penalty of a disparity step of one, 0..p2
    int p2 = 192;             ///< penalty of a larger step where the image is flat, up to 4000
    int p2_half_tone = 5;     ///< tone step at which p2 has fallen half-way to p1, 1..255
    bool prior = true;        ///< in flat areas, add a little of the coarser level's sums
    bool prune = true;        ///< search only round the coarser level's disparities
    int left_right_px = 1;    ///< tolerance of the left-right check, 0..64; -1 = off
    int speckle_px = 25;      ///< segments of fewer pixels lose their values, 2..500; 0 = off
    int speckle_range_px = 1; ///< neighbours of one segment differ by this at most, 1..64
    Subpixel subpixel = Subpixel::census;
    int min_confidence = 150; ///< values trusted less are taken away, 0..255
    int median = 3;           ///< side of the median filter: 3 or 5; 1 = off
    int smooth = 5;           ///< side of the mean over one surface: 3 or 5; 1 = off
    Fill fill = Fill::none;
    int fill_px = 32; ///< how far a hole looks for values to close it, 1..256

    /// Throws std::invalid_argument naming the option, its value and what is allowed.
    void validate() const;

    /// These options with what the mode dictates put in place of what it has no use for:
    /// `hsgm_paper` has neither halo, prior nor pruning; `sgm` and `local` have one level.
    Options resolved() const;

    /// Whether path costs fit 8 bits exactly: no sum of eq. 1 passes 255. Else they take 16.
    bool fits_8_bits() const;

    bool operator==(const Options&) const = default;
};

std::string_view name(Mode mode);
std::string_view name(Cost cost);
std::string_view name(Subpixel subpixel);
std::string_view name(Fill fill);
/// The enumerator of that name ("hsgm-paper", "census7x7", ...); throws
/// std::invalid_argument listing the names there are.
Mode mode_from_name(std::string_view name);
Cost cost_from_name(std::string_view name);
Subpixel subpixel_from_name(std::string_view name);
Fill fill_from_name(std::string_view name);

/// Every cost there is, in the order of the documentation.
std::vector<Cost> all_costs();

/// What a matching cost promises: its largest value, and how far round a pixel it reads.
struct CostTraits {
    int max;
    int radius_rows;
    int radius_cols;
};
CostTraits traits(Cost cost);

} // namespace hsgm::matcher
