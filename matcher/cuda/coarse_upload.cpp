#include "matcher/cuda/coarse_upload.h"

#include "matcher/host/levels.h"
#include "matcher/kernel.h"

#include <algorithm>
#include <array>

namespace hsgm::matcher::cuda {

namespace {

using tiling::Rect;

constexpr std::size_t kTones = 256;

// Copies of host arrays, in a stream that is waited for at once: this happens once a run.
class Uploader {
public:
    template <typename T>
    void copy(T* to, const T* from, std::size_t count)
    {
        if (count > 0) {
            check(cudaMemcpyAsync(to, from, count * sizeof(T), cudaMemcpyHostToDevice,
                                  stream_.get()),
                  "copying the coarsest level");
            stream_.wait();
        }
    }

private:
    Stream stream_;
};

template <typename Cell>
const host::CoarseSolutionOf<Cell>& typed(const CoarseSolution& coarse)
{
    return dynamic_cast<const host::CoarseSolutionOf<Cell>&>(coarse);
}

// Winners and prior of every pixel, in the store's order.
template <typename Cell>
void upload_pixels(Uploader& uploader, const LevelStore<Cell>& store,
                   const host::LevelResult<Cell>& level)
{
    const host::BlockResult<Cell>& block = level.blocks.front();
    const auto winners = level.winners.pixels.pixels();
    uploader.copy(store.winner, winners.data(), winners.size());
    if (store.prior == nullptr) {
        return;
    }
    const auto stride = static_cast<std::size_t>(store.stride);
    const auto count = static_cast<std::size_t>(block.range.count());
    std::vector<std::uint8_t> row(std::size_t(store.area.cols) * stride);
    for (int r = 0; r < store.area.rows; ++r) {
        for (int c = 0; c < store.area.cols; ++c) {
            std::copy_n(block.prior_at(r, c), count, row.data() + std::size_t(c) * stride);
        }
        uploader.copy(store.prior + std::size_t(r) * row.size(), row.data(), row.size());
    }
}

// Path costs of all start rows and start columns of a direction.
template <typename Cell>
void upload_lines(Uploader& uploader, const LevelStore<Cell>& store, int d,
                  const host::BlockResult<Cell>& block)
{
    const auto stride = static_cast<std::size_t>(store.stride);
    const auto count = static_cast<std::size_t>(block.range.count());
    const host::LineStore<Cell>& lines = block.lines[static_cast<std::size_t>(d)];
    const int dr = store.directions.row[d];
    const int dc = store.directions.col[d];
    std::vector<Cell> line;
    const auto add = [&](int row, int col) {
        line.resize(line.size() + stride);
        std::copy_n(lines.at(row, col), count,
                    line.end() - static_cast<std::ptrdiff_t>(stride));
    };
    std::size_t at = store.line_begin[d] * stride;
    const auto flush = [&] {
        uploader.copy(store.lines + at, line.data(), line.size());
        at += line.size();
        line.clear();
    };
    for (int row = 0; row < store.rows; ++row) {
        for (int col = 0; store.grid.holds(row, dr) && col < store.cols; ++col) {
            add(row, col);
        }
        flush();
    }
    for (int col = 0; col < store.cols; ++col) {
        for (int row = 0; store.grid.holds(col, dc) && row < store.rows; ++row) {
            add(row, col);
        }
        flush();
    }
}

std::array<std::uint16_t, kTones> penalties(const Options& options)
{
    std::array<std::uint16_t, kTones> p2{};
    for (int a = 0; a < static_cast<int>(kTones); ++a) {
        p2[std::size_t(a)] = static_cast<std::uint16_t>(
            options.mode == Mode::hsgm_paper
                ? p2_equation3(options.p1, options.p2, a)
                : p2_gradient(options.p1, options.p2, options.p2_half_tone, a));
    }
    return p2;
}

template <typename Cell>
std::int64_t counted_bytes(const Matcher& matcher)
{
    Arena arena;
    lay_out_shared<Cell>(arena, matcher);
    return static_cast<std::int64_t>(arena.used());
}

} // namespace

template <typename Cell>
SharedMemory<Cell> lay_out_shared(Arena& arena, const Matcher& matcher)
{
    const LevelPlan& plan = matcher.plan();
    SharedMemory<Cell> memory;
    memory.p2 = arena.take<std::uint16_t>(kTones);
    if (matcher.options().cost == Cost::hmi) {
        memory.hmi = arena.take<std::uint8_t>(kTones * kTones);
    }
    memory.has_coarse = plan.coarsest_whole && plan.levels() > 1;
    if (memory.has_coarse) {
        const Rect whole = rect_of(plan.left_sizes.back());
        memory.store = lay_out_store<Cell>(arena, matcher.options(), whole.size(), whole, 0,
                                           plan.ranges.back().count());
        memory.window = arena.take<Window>(1);
        memory.store.windows = memory.window;
        memory.tone = {arena.take<std::uint8_t>(static_cast<std::size_t>(whole.area())),
                       Area(whole)};
    }
    return memory;
}

template <typename Cell>
CoarseOnDevice<Cell>::CoarseOnDevice(const Matcher& matcher, const CoarseSolution& coarse,
                                     const DeviceInfo&)
    : buffer_(counted_bytes<Cell>(matcher))
{
    Arena arena(buffer_.data(), buffer_.size());
    memory_ = lay_out_shared<Cell>(arena, matcher);
    Uploader uploader;
    const auto p2 = penalties(matcher.options());
    uploader.copy(memory_.p2, p2.data(), p2.size());
    if (memory_.hmi != nullptr) {
        uploader.copy(memory_.hmi, matcher.pair().hmi->cost.data(), kTones * kTones);
    }
    if (!memory_.has_coarse) {
        return;
    }
    const auto& solution = typed<Cell>(coarse);
    const host::BlockResult<Cell>& block = solution.level.blocks.front();
    const Window window{memory_.store.area, block.range.min, block.range.count()};
    uploader.copy(memory_.window, &window, 1);
    const auto tones = solution.tone.pixels.pixels();
    uploader.copy(memory_.tone.data, tones.data(), tones.size());
    upload_pixels(uploader, memory_.store, solution.level);
    for (int d = 0; d < memory_.store.directions.count; ++d) {
        upload_lines(uploader, memory_.store, d, block);
    }
}

template SharedMemory<std::uint8_t> lay_out_shared(Arena&, const Matcher&);
template SharedMemory<std::uint16_t> lay_out_shared(Arena&, const Matcher&);
template class CoarseOnDevice<std::uint8_t>;
template class CoarseOnDevice<std::uint16_t>;

} // namespace hsgm::matcher::cuda
