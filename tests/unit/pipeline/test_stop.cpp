#include "tests/catch.h"

#include "tests/unit/pipeline/fake_workers.h"

#include "pipeline/error.h"

#include <numeric>

using namespace hsgm;
using namespace hsgm::pipeline;
using namespace hsgm::pipeline::testing;

// A request to stop holds for the rest of the process, so this is the only test of its
// program.
TEST_CASE("a request to stop ends a run between two tiles")
{
    CHECK_NOTHROW(check_stop());
    std::vector<int> sequence(1000);
    std::iota(sequence.begin(), sequence.end(), 0);
    int written = 0;
    TileSteps steps{numbered_task,
                    [&](int, const matcher::TileMatch&) {
                        if (++written == 10) {
                            request_stop();
                        }
                    },
                    {}};
    CHECK_THROWS_AS(run_tiles_with(sequence, steps, fake_workers(2, [](int) {}), 3),
                    Interrupted);
    CHECK(written >= 10);
    CHECK(written < 20);
    CHECK_THROWS_AS(check_stop(), Interrupted);
}
