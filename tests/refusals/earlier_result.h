#pragma once

#include "tests/end_to_end/pairs.h"
#include "tests/end_to_end/program.h"

namespace hsgm::tests {

/// A folder with a good pair, run.yaml for it, and files that stand for the results of
/// earlier runs: d.tif and its siblings of `hsgm match`, and those of `hsgm run` in result/.
/// Every refusal must leave all of it alone.
class EarlierResult {
public:
    EarlierResult();

    const TemporaryFolder& folder() const { return folder_; }
    std::string operator/(const std::string& name) const { return folder_ / name; }
    /// Takes what is there now for the state to be left alone.
    void remember() { before_ = snapshot(folder_.path().string()); }

    /// Runs hsgm, which must end with `code`, say one sentence with each of `words` in it, and
    /// leave every file as it was. Returns the sentence.
    std::string refused(const std::vector<std::string>& arguments, int code,
                        const std::vector<std::string>& words) const;
    /// `hsgm match LEFT RIGHT -o d.tif --disparity 0,10 MORE...`, refused.
    std::string refused_pair(const std::string& left, const std::string& right, int code,
                             const std::vector<std::string>& words,
                             const std::vector<std::string>& more = {}) const;
    /// `hsgm run` on a file of this text, refused with code 2.
    std::string refused_config(const std::string& yaml, const std::vector<std::string>& words);

private:
    TemporaryFolder folder_;
    Snapshot before_;
};

} // namespace hsgm::tests
