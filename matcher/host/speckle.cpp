#include "matcher/host/speckle.h"

#include "matcher/reasons.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/speckle.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// One bit a pixel for the words of a row: whether it has a value, whether it belongs to the
// pixel left of it, and to the one above.
void connect_row(const std::int32_t* row, const std::int32_t* above, int words, int range,
                 std::uint64_t* valid, std::uint64_t* left, std::uint64_t* up)
{
    const hn::CappedTag<std::int32_t, 16> d;
    constexpr int kBits = 64;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto hole = hn::Set(d, kHole);
    const auto bound = hn::Set(d, range + 1);
    const auto bits_of = [&](auto mask, int at) HWY_ATTR {
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(d, mask, bytes);
        std::uint64_t bits = 0;
        std::memcpy(&bits, bytes, sizeof bits);
        return bits << at;
    };
    for (int w = 0; w < words; ++w) {
        std::uint64_t has = 0;
        std::uint64_t joins_left = 0;
        std::uint64_t joins_up = 0;
        for (int at = 0; at < kBits; at += lanes) {
            const int i = kBits * w + at;
            const auto value = hn::LoadU(d, row + i);
            const auto has_value = hn::Ne(value, hole);
            const auto joins = [&](auto other) HWY_ATTR {
                return hn::And(has_value, hn::Lt(hn::Abs(hn::Sub(value, other)), bound));
            };
            has |= bits_of(has_value, at);
            joins_left |= bits_of(joins(hn::LoadU(d, row + i - 1)), at);
            joins_up |= bits_of(joins(hn::LoadU(d, above + i)), at);
        }
        valid[w] = has;
        left[w] = joins_left;
        up[w] = joins_up;
    }
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(connect_row);

namespace {

using tiling::Patch;
using tiling::Rect;

constexpr int kBits = 64;
static_assert(kBits <= DisparityPlane::kFrameCols, "the last word ends in the frame");

int words_of(int cols)
{
    return (cols + kBits - 1) / kBits;
}

// Pixels of a row that belong together, and the segment they are part of. The first run of
// a segment counts its pixels, as a negative number; the others name an earlier run.
struct Run {
    int begin;
    int end;
    int parent;
};

// Connected runs of the whole plane (union-find over runs of rows).
class Segments {
public:
    Segments(const DisparityPlane& plane, int range_q8);

    /// Calls body(row, begin, end), relative columns, for every run of a segment of fewer
    /// than `least_px` pixels in the rows [first, end), relative to the plane.
    template <typename Body>
    void each_small(int least_px, int first, int end, Body body)
    {
        for (int r = first; r < end; ++r) {
            for (int i = first_run_[std::size_t(r)]; i < first_run_[std::size_t(r) + 1]; ++i) {
                if (-run(root(i)).parent < least_px) {
                    body(r, run(i).begin, run(i).end);
                }
            }
        }
    }

private:
    Run& run(int i) { return runs_[static_cast<std::size_t>(i)]; }
    int root(int i);
    void join(int a, int b);
    void find_connections(const DisparityPlane& plane, int range_q8);
    std::size_t count_runs() const;
    void add_runs(int r);
    void join_runs(int r);

    const std::uint64_t* row_of(const std::vector<std::uint64_t>& bits, int r) const
    {
        return bits.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(words_);
    }

    int words_;
    std::vector<std::uint64_t> valid_;
    std::vector<std::uint64_t> left_;
    std::vector<std::uint64_t> up_;
    std::vector<int> first_run_; // of every row, and one beyond the last
    std::vector<Run> runs_;
};

Segments::Segments(const DisparityPlane& plane, int range_q8)
    : words_(words_of(plane.rect().cols))
{
    find_connections(plane, range_q8);
    runs_.reserve(count_runs());
    first_run_.reserve(std::size_t(plane.rect().rows) + 1);
    for (int r = 0; r < plane.rect().rows; ++r) {
        first_run_.push_back(static_cast<int>(runs_.size()));
        add_runs(r);
        if (r > 0) {
            join_runs(r);
        }
    }
    first_run_.push_back(static_cast<int>(runs_.size()));
}

void Segments::find_connections(const DisparityPlane& plane, int range_q8)
{
    const Rect& part = plane.rect();
    const auto count = static_cast<std::size_t>(part.rows) * static_cast<std::size_t>(words_);
    for (auto* bits : {&valid_, &left_, &up_}) {
        bits->resize(count);
    }
    for (int r = 0; r < part.rows; ++r) {
        const auto at = static_cast<std::size_t>(r) * static_cast<std::size_t>(words_);
        HWY_DYNAMIC_DISPATCH(connect_row)
        (plane.at(part.row + r, part.col), plane.at(part.row + r - 1, part.col), words_,
         range_q8, valid_.data() + at, left_.data() + at, up_.data() + at);
    }
}

std::size_t Segments::count_runs() const
{
    std::size_t count = 0;
    for (std::size_t w = 0; w < valid_.size(); ++w) {
        count += static_cast<std::size_t>(std::popcount(valid_[w] & ~left_[w]));
    }
    return count;
}

// Runs begin where a pixel does not belong to its left neighbour, and end before one that
// does not.
void Segments::add_runs(int r)
{
    const std::uint64_t* valid = row_of(valid_, r);
    const std::uint64_t* left = row_of(left_, r);
    std::size_t open = runs_.size();
    for (int w = 0; w < words_; ++w) {
        for (std::uint64_t bits = valid[w] & ~left[w]; bits != 0; bits &= bits - 1) {
            runs_.push_back({kBits * w + std::countr_zero(bits), 0, 0});
        }
        const std::uint64_t next = w + 1 < words_ ? left[w + 1] << (kBits - 1) : 0;
        for (std::uint64_t bits = valid[w] & ~(left[w] >> 1 | next); bits != 0;
             bits &= bits - 1) {
            Run& ended = runs_[open++];
            ended.end = kBits * w + std::countr_zero(bits) + 1;
            ended.parent = ended.begin - ended.end;
        }
    }
}

// Joins the runs of a row to those above. Of neighbouring pixels whose runs meet in both
// rows, the first says all.
void Segments::join_runs(int r)
{
    const std::uint64_t* up = row_of(up_, r);
    const std::uint64_t* left = row_of(left_, r);
    const std::uint64_t* left_above = row_of(left_, r - 1);
    int here = first_run_[std::size_t(r)];
    int above = first_run_[std::size_t(r) - 1];
    std::uint64_t carry = 0;
    for (int w = 0; w < words_; ++w) {
        const std::uint64_t told = (up[w] << 1 | carry) & left[w] & left_above[w];
        carry = up[w] >> (kBits - 1);
        for (std::uint64_t bits = up[w] & ~told; bits != 0; bits &= bits - 1) {
            const int col = kBits * w + std::countr_zero(bits);
            while (run(here).end <= col) {
                ++here;
            }
            while (run(above).end <= col) {
                ++above;
            }
            join(here, above);
        }
    }
}

int Segments::root(int i)
{
    while (run(i).parent >= 0) {
        const int parent = run(i).parent;
        if (run(parent).parent >= 0) {
            run(i).parent = run(parent).parent;
        }
        i = parent;
    }
    return i;
}

void Segments::join(int a, int b)
{
    a = root(a);
    b = root(b);
    if (a == b) {
        return;
    }
    const int first = std::min(a, b);
    const int second = std::max(a, b);
    run(first).parent += run(second).parent;
    run(second).parent = first;
}

} // namespace

void remove_speckles(int least_px, int range_q8, const Rect& decided, DisparityPlane& plane,
                     Patch<std::uint16_t>& reasons)
{
    const Rect part = plane.rect();
    Segments segments(plane, range_q8);
    const auto remove = [&](int r, int begin, int end) {
        const int row = part.row + r;
        const int first = std::max(part.col + begin, decided.col);
        const int last = std::min(part.col + end, decided.col_end());
        for (int col = first; col < last; ++col) {
            *plane.at(row, col) = kHole;
            std::uint16_t& bits = reasons.at(row, col);
            bits = static_cast<std::uint16_t>(bits | kSpeckle);
        }
    };
    segments.each_small(least_px, decided.row - part.row, decided.row_end() - part.row, remove);
}

std::int64_t speckle_bytes(tiling::Size size)
{
    // Three bits a pixel, and a run for every pixel where no two belong together.
    const std::int64_t words = std::int64_t{size.rows} * words_of(size.cols);
    return words * 3 * 8 + size.area() * static_cast<std::int64_t>(sizeof(Run)) +
           (std::int64_t{size.rows} + 1) * static_cast<std::int64_t>(sizeof(int));
}

} // namespace hsgm::matcher::host
#endif
