#include "pipeline/stages/pair_sources.h"

#include "pipeline/stages/resampled_source.h"

namespace hsgm::pipeline {

PairSources open_sources(const Job& job)
{
    if (!job.satellite) {
        return {std::make_unique<FileSource>(io::RasterSource(job.left)),
                std::make_unique<FileSource>(io::RasterSource(job.right))};
    }
    const geometry::EpipolarFrame& frame = job.satellite->pair->frame;
    return {
        std::make_unique<ResampledSource>(io::RasterSource(job.left), frame.left, frame.size),
        std::make_unique<ResampledSource>(io::RasterSource(job.right), frame.right,
                                          frame.size)};
}

} // namespace hsgm::pipeline
