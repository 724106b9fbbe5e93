#include "tests/catch.h"

#include "tests/seam/seam_figure.h"

using namespace hsgm;
using namespace hsgm::seam;
using matcher::Mode;

namespace {

// Six small scenes tell the ratio to about 0.05, so this sees a seam but not a trace of one:
// the figure itself is held to 1.05 where there are scenes enough, in test_seam_table.cpp.
void check_no_seam(const std::vector<StereoPair>& pairs)
{
    const SeamFigures hsgm = seam_figures(pairs, with_mode(Mode::hsgm, 8));
    const SeamFigures windows_alone = seam_figures(pairs, with_mode(Mode::local, 0));
    INFO("hsgm: " << text(hsgm));
    INFO("local: " << text(windows_alone));
    CHECK(hsgm.raw.ratio_low <= 1.05);
    CHECK(hsgm.refined.ratio_low <= 1.05);
    CHECK(hsgm.raw.ratio <= 1.15);
    CHECK(hsgm.refined.ratio <= 1.15);
    // The figure can tell: windows on their own have steps at their borders.
    CHECK(windows_alone.raw.ratio_low > 1.5);
    CHECK(windows_alone.refined.ratio_low > 1.5);
}

} // namespace

TEST_CASE("matched cities have no steps at window borders")
{
    check_no_seam(render_series(city, {512, 576}, 6));
}

TEST_CASE("matched slopes have no steps at window borders")
{
    check_no_seam(render_series(ramps, {512, 576}, 6));
}
