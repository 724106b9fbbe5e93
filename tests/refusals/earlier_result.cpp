#include "tests/refusals/earlier_result.h"

#include <algorithm>
#include <sstream>

namespace hsgm::tests {

namespace {

// The one sentence among the lines of standard error; the others may only inform.
std::string the_error(const std::string& err)
{
    std::vector<std::string> errors;
    std::istringstream lines(err);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("info: ")) {
            errors.push_back(line);
        }
    }
    INFO("standard error: " << err);
    REQUIRE(errors.size() == 1);
    CHECK(errors.front().starts_with("error: "));
    return errors.front();
}

} // namespace

EarlierResult::EarlierResult()
{
    make_pair(folder_);
    put_bytes(folder_ / "run.yaml", pair_config());
    std::filesystem::create_directory(folder_ / "result");
    for (const std::string name :
         {"d.tif", "d.confidence.tif", "d.reasons.tif", "result/config.used.yaml",
          "result/disparity.tif", "result/confidence.tif", "result/reasons.tif"}) {
        put_bytes(folder_ / name, name + " of an earlier run\n");
    }
    remember();
}

std::string EarlierResult::refused(const std::vector<std::string>& arguments, int code,
                                   const std::vector<std::string>& words) const
{
    const Outcome outcome = run_hsgm(arguments);
    const std::string sentence = the_error(outcome.err);
    INFO(sentence);
    CHECK(outcome.code == code);
    CHECK(outcome.out.empty());
    for (const std::string& word : words) {
        CHECK_THAT(sentence, Catch::Matchers::Contains(word));
    }
    CHECK_FALSE(sentence.ends_with(".."));
    const Snapshot after = snapshot(folder_.path().string());
    CHECK(names_in(after) == names_in(before_));
    CHECK((after == before_));
    return sentence;
}

std::string EarlierResult::refused_pair(const std::string& left, const std::string& right,
                                        int code, const std::vector<std::string>& words,
                                        const std::vector<std::string>& more) const
{
    std::vector<std::string> arguments{"match", folder_ / left, folder_ / right, "-o",
                                       folder_ / "d.tif"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (std::none_of(more.begin(), more.end(),
                     [](const std::string& word) { return word.starts_with("--disparity"); })) {
        arguments.insert(arguments.end(), {"--disparity", "0,10"});
    }
    return refused(arguments, code, words);
}

std::string EarlierResult::refused_config(const std::string& yaml,
                                          const std::vector<std::string>& words)
{
    put_bytes(folder_ / "bad.yaml", yaml);
    remember();
    return refused({"run", folder_ / "bad.yaml"}, 2, words);
}

} // namespace hsgm::tests
