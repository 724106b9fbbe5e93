#include "pipeline/submit/slurm.h"

#include "tests/catch.h"

#include <fstream>
#include <iterator>

using namespace hsgm::pipeline;
using Catch::Matchers::Contains;

namespace {

std::string text_of(const std::string& path)
{
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

// What configs/slurm shows.
SlurmChain shown()
{
    SlurmChain chain;
    chain.config = "/shared/city.yaml";
    chain.results = "/shared/results";
    chain.shards = 16;
    return chain;
}

} // namespace

TEST_CASE("the scripts in configs/slurm are those that submit writes")
{
    const std::string folder = std::string(HSGM_SOURCE_DIR) + "/configs/slurm/";
    CHECK(text_of(folder + "coarse.sbatch") == slurm_script(shown(), RunStage::coarse));
    CHECK(text_of(folder + "tiles.sbatch") == slurm_script(shown(), RunStage::tiles));
    CHECK(text_of(folder + "assemble.sbatch") == slurm_script(shown(), RunStage::assemble));
}

TEST_CASE("words of a Slurm script reach the program as they are")
{
    SlurmChain chain = shown();
    chain.words = {"--set", "matcher.disparity=[0, 63]", "--set", "a='b'"};
    chain.directives = {"--partition=long"};
    const std::string script = slurm_script(chain, RunStage::tiles);
    CHECK_THAT(script, Contains(R"(--set 'matcher.disparity=[0, 63]' --set 'a='\''b'\''')"));
    CHECK_THAT(script, Contains("\n#SBATCH --partition=long\n"));
    CHECK_THAT(script, Contains("\n#SBATCH --array=0-15\n"));
    CHECK_THAT(script, Contains("--shard auto/16 --resume"));
}
