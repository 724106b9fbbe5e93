#include "tests/catch.h"

#include "tests/seam/seam_figure.h"

using namespace hsgm;
using namespace hsgm::seam;
using matcher::Mode;

namespace {

// In a few scenes chance puts up to a tenth more or less error at the grid's lines, and mode
// sgm, which knows no windows, shows how much: hsgm is held against it. The figure itself is
// held to 1.05 where there are scenes enough, in test_seam_table.cpp.
void check_no_seam(const std::vector<StereoPair>& pairs)
{
    const SeamFigures chance = seam_figures(pairs, with_mode(Mode::sgm, 0));
    const SeamFigures hsgm = seam_figures(pairs, with_mode(Mode::hsgm, 8));
    const SeamFigures windows_alone = seam_figures(pairs, with_mode(Mode::local, 0));
    INFO("sgm: " << text(chance));
    INFO("hsgm: " << text(hsgm));
    INFO("local: " << text(windows_alone));
    CHECK(hsgm.raw.ratio <= 1.12 * chance.raw.ratio);
    CHECK(hsgm.refined.ratio <= 1.12 * chance.refined.ratio);
    // The figure can tell: windows on their own have steps at their borders.
    CHECK(windows_alone.raw.ratio > 1.5 * chance.raw.ratio);
    CHECK(windows_alone.refined.ratio > 1.5 * chance.refined.ratio);
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
