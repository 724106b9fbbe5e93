#include "pipeline/stages/stage_progress.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <utility>

namespace hsgm::pipeline {

namespace {

constexpr auto kPause = std::chrono::seconds(10);

} // namespace

StageProgress::StageProgress(std::string words, std::int64_t all)
    : words_(std::move(words)), all_(std::max<std::int64_t>(all, 1))
{
}

void StageProgress::advance(std::int64_t more)
{
    done_ += more;
    const auto now = Clock::now();
    if (now - told_ < kPause || done_ >= all_) {
        return;
    }
    told_ = now;
    const std::chrono::duration<double> taken = now - start_;
    const double share = static_cast<double>(done_) / static_cast<double>(all_);
    spdlog::info("{}: {:.0f} %, {:.0f} s left", words_, 100 * share,
                 taken.count() * (1 - share) / share);
}

std::string words_of_stage(const std::string& stage)
{
    static const std::map<std::string, std::string> kWords{
        {"prepare", "reading the images, making pyramids"},
        {"hmi", "learning the table of mutual information"},
        {"coarse", "solving the coarsest level"},
        {"refine", "second pass and rasters"},
        {"dsm", "heights and surface model"},
        {"hillshade", "shading"},
        {"pictures", "pictures"},
        {"seam figure", "seam figure"},
        {"checksums", "checksums of the outputs"}};
    const auto found = kWords.find(stage);
    return found == kWords.end() ? stage : found->second;
}

} // namespace hsgm::pipeline
