#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace hsgm::pipeline {

/// Tells how far a stage over the whole image is, a line every ten seconds: nothing of a stage
/// that takes less. From one thread at a time.
class StageProgress {
public:
    /// `words` begin the line; `all` is what `advance` will add up to.
    StageProgress(std::string words, std::int64_t all);
    void advance(std::int64_t more);

private:
    using Clock = std::chrono::steady_clock;

    std::string words_;
    std::int64_t all_;
    std::int64_t done_ = 0;
    Clock::time_point start_ = Clock::now();
    Clock::time_point told_ = start_;
};

/// What a stage of the ledger does, for people: "refine" is "second pass and rasters".
std::string words_of_stage(const std::string& stage);

} // namespace hsgm::pipeline
