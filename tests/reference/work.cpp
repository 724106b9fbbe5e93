#include "tests/reference/work.h"

namespace hsgm::reference {

namespace {

void add_window(const Window& window, Size image, int halo, int paths, Work& work)
{
    ++work.windows;
    for (int row = 0; row < image.rows; ++row) {
        for (int col = 0; col < image.cols; ++col) {
            if (row >= window.core.row - halo && row < window.core.row_end() + halo &&
                col >= window.core.col - halo && col < window.core.col_end() + halo) {
                work.cells += window.range.count();
            }
            for (const Step& step : directions(paths)) {
                if (path_region(window.core, step, halo, image).contains(row, col)) {
                    work.path_steps += window.range.count();
                }
            }
        }
    }
}

} // namespace

Work work_of(const MatchResult& twin, const Options& asked)
{
    const Options options = with_mode_applied(asked);
    Work work;
    for (std::size_t k = 0; k < twin.levels.size(); ++k) {
        const Level& level = twin.levels[k];
        const bool whole = k + 1 == twin.levels.size() && options.mode != Mode::local;
        for (const Window& window : level.windows) {
            add_window(window, level.pair.left.size(), whole ? 0 : options.halo_px,
                       options.paths, work);
        }
    }
    return work;
}

} // namespace hsgm::reference
