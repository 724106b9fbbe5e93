#include "pipeline/stages/pair_sources.h"

#include "pipeline/stages/resampled_source.h"

namespace hsgm::pipeline {

PairSources open_sources(const Job& job)
{
    if (!job.satellite) {
        return {std::make_unique<FileSource>(io::RasterSource(job.left)),
                std::make_unique<FileSource>(io::RasterSource(job.right))};
    }
    const geometry::PairGeometry& pair = *job.satellite->pair;
    const auto source = [&](const io::ImageSpec& image, const geometry::SensorModel& model,
                            const geometry::Lattice& lattice) {
        const auto& ortho = job.satellite->search.ortho;
        return std::make_unique<ResampledSource>(io::RasterSource(image), lattice,
                                                 pair.frame.size,
                                                 ortho ? warp_of(model, *ortho) : nullptr);
    };
    return {source(job.left, pair.left, pair.frame.left),
            source(job.right, pair.right, pair.frame.right)};
}

} // namespace hsgm::pipeline
