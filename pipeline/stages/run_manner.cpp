#include "pipeline/stages/run_manner.h"

#include "io/error.h"

namespace hsgm::pipeline {

void RunManner::validate() const
{
    if (resume && restart) {
        throw io::ConfigError("--resume goes on and --restart begins anew: give one of them");
    }
    if (stage == RunStage::tiles && !shard) {
        throw io::ConfigError("--stage tiles needs to know which: add --shard I/N");
    }
    if ((stage == RunStage::coarse || stage == RunStage::assemble) && shard) {
        throw io::ConfigError("--stage coarse and assemble are for all shards together: leave "
                              "out --shard");
    }
    if (restart && (shard || stage == RunStage::tiles || stage == RunStage::assemble)) {
        throw io::ConfigError("--restart throws away the work of all shards: give it to "
                              "--stage coarse alone");
    }
    if (take_over && !shard) {
        throw io::ConfigError("--take-over is for one shard: add --shard I/N");
    }
}

} // namespace hsgm::pipeline
