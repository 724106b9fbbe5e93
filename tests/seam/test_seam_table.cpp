#include "tests/catch.h"

#include "tests/seam/seam_figure.h"

#include <cstdio>

using namespace hsgm;
using namespace hsgm::seam;
using matcher::Mode;

// Figure 5 of Won and Jung as numbers: what each way to start a path at a window's border
// costs, at equal penalties.
TEST_CASE("seam figures of all modes on larger scenes")
{
    synth::Scene high = city({1024, 1024}, 9);
    high.bits = 8;
    high.city->cell_px = 96;
    high.city->height_max_px = 48;
    const std::pair<const char*, synth::Scene> scenes[] = {
        {"city", city({768, 1024})}, {"high city", high}, {"ramps", ramps({768, 1024})}};
    const std::tuple<const char*, Mode, int> contenders[] = {
        {"sgm", Mode::sgm, 0},
        {"local, overlap 0", Mode::local, 0},
        {"local, overlap 8", Mode::local, 8},
        {"local, overlap 16", Mode::local, 16},
        {"hsgm-paper", Mode::hsgm_paper, 0},
        {"hsgm", Mode::hsgm, 8}};
    for (const auto& [scene_name, scene] : scenes) {
        const StereoPair pair = render(scene);
        std::printf("%s, disparities %d..%d\n", scene_name, pair.asked.min, pair.asked.max);
        for (const auto& [mode_name, mode, halo_px] : contenders) {
            const SeamFigures figures = seam_figures(pair, with_mode(mode, halo_px));
            std::printf("  %-18s %s\n", mode_name, text(figures).c_str());
            if (mode == Mode::hsgm) {
                CHECK(figures.raw.ratio <= 1.05);
                CHECK(figures.refined.ratio <= 1.05);
            }
        }
    }
}
