#include "tests/catch.h"

#include "tests/cuda/comparison.h"
#include "tests/reference/hmi.h"
#include "tests/reference/real_pairs.h"

using namespace hsgm;
using namespace hsgm::reference;

TEST_CASE("device and host agree on two real pairs, in tiles")
{
    const auto [scene, part, asked] = GENERATE(table<std::string, Rect, DisparityRange>({
        {"middlebury_cones", {0, 0, 375, 450}, {0, 63}},
        {"sat_us3d_JAX_079_006_007", {200, 300, 300, 300}, {-40, 39}},
    }));
    if (!is_there(scene)) {
        WARN("SKIPPED: no test data in " + data_folder() + "/" + scene + "; see HSGM_DATA_DIR");
        return;
    }
    INFO(scene);
    Case c = part_of(scene, part, asked, false);
    cuda_test::Setting setting;
    setting.schedule = stand_in::all_schedules().front();
    setting.block_threads = 384;
    for (const bool prune : {true, false}) {
        c.options.prune = prune;
        INFO(c.describe());
        const auto outcome = cuda_test::compare_tiles(c, setting);
        CHECK_FALSE(outcome.refused);
        CHECK(outcome.difference == "");
    }
}
