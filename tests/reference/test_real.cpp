#include "tests/catch.h"

#include "tests/reference/hmi.h"
#include "tests/reference/real_pairs.h"
#include "tests/reference/themes.h"

#include <string>

using namespace hsgm::reference;

namespace {

void compare_costs(Case c)
{
    for (const Cost cost : hsgm::matcher::all_costs()) {
        c.options.cost = cost;
        if (cost == Cost::hmi) {
            c.hmi = solve_hmi(c.pair.left, c.pair.right, c.asked, c.tone_left, c.tone_right,
                              c.options);
        }
        const std::string found = difference(c);
        INFO(c.describe());
        CHECK(found == "");
    }
}

} // namespace

TEST_CASE("matcher and twin agree for every cost on parts of real pairs")
{
    const auto [scene, part, asked] = GENERATE(table<std::string, Rect, DisparityRange>({
        {"middlebury_cones", {130, 150, 120, 140}, {0, 63}},
        {"sat_us3d_JAX_079_006_007", {300, 400, 100, 150}, {-40, 39}},
    }));
    if (!is_there(scene)) {
        WARN("SKIPPED: no test data in " + data_folder() + "/" + scene + "; see HSGM_DATA_DIR");
        return;
    }
    INFO(scene);
    for (const bool sixteen_bit : {false, true}) {
        compare_costs(part_of(scene, part, asked, sixteen_bit));
    }
}
