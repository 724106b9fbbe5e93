#include "io/byte_size.h"
#include "tests/runs/run_place.h"

#include "tests/catch.h"

#include <yaml-cpp/yaml.h>

#include <cstdlib>

using namespace hsgm;
using namespace hsgm::tests;

// configs/kubernetes/run.yaml without a cluster: that it hangs together, and that its command
// line, given to our program as a pod would, makes a run.
namespace {

YAML::Node manifest()
{
    return YAML::LoadFile(std::string(HSGM_CONFIGS_DIR) + "/kubernetes/run.yaml");
}

YAML::Node pod()
{
    return manifest()["spec"]["template"]["spec"];
}

std::vector<std::string> command()
{
    return pod()["containers"][0]["command"].as<std::vector<std::string>>();
}

std::string after(const std::vector<std::string>& words, const std::string& option)
{
    const auto found = std::find(words.begin(), words.end(), option);
    REQUIRE(found != words.end());
    REQUIRE(found + 1 != words.end());
    return *(found + 1);
}

} // namespace

TEST_CASE("the Kubernetes manifest is an indexed Job that agrees with itself")
{
    const YAML::Node job = manifest();
    CHECK(job["apiVersion"].as<std::string>() == "batch/v1");
    CHECK(job["kind"].as<std::string>() == "Job");
    const YAML::Node spec = job["spec"];
    CHECK(spec["completionMode"].as<std::string>() == "Indexed");
    const int completions = spec["completions"].as<int>();
    CHECK(spec["parallelism"].as<int>() <= completions);
    const auto words = command();
    CHECK(after(words, "--shard") == "auto/" + std::to_string(completions));
    CHECK(std::count(words.begin(), words.end(), "--resume") == 1);
    // A failure policy asks for pods that are not restarted in place.
    CHECK(pod()["restartPolicy"].as<std::string>() == "Never");
    const YAML::Node container = pod()["containers"][0];
    const YAML::Node rule = spec["podFailurePolicy"]["rules"][0];
    CHECK(rule["action"].as<std::string>() == "FailJob");
    CHECK(rule["onExitCodes"]["containerName"].as<std::string>() ==
          container["name"].as<std::string>());
    CHECK(rule["onExitCodes"]["values"].as<std::vector<int>>() == std::vector<int>{2, 3, 4});
    // Threads and memory are what the pod has.
    const YAML::Node resources = container["resources"];
    CHECK(after(words, "--threads") == resources["requests"]["cpu"].as<std::string>());
    const auto bytes = [](std::string text) {
        return io::parse_bytes(text.ends_with("Gi") || text.ends_with("Mi") ? text + "B"
                                                                            : text);
    };
    CHECK(bytes(after(words, "--memory")) <
          bytes(resources["limits"]["memory"].as<std::string>()));
    CHECK(resources["limits"]["memory"].as<std::string>() ==
          resources["requests"]["memory"].as<std::string>());
    // Everything lies on the shared volume.
    const YAML::Node mount = container["volumeMounts"][0];
    CHECK(mount["name"].as<std::string>() == pod()["volumes"][0]["name"].as<std::string>());
    const std::string shared = mount["mountPath"].as<std::string>() + "/";
    CHECK(after(words, "run").starts_with(shared));
    CHECK(after(words, "-o").starts_with(shared));
}

TEST_CASE("the command line of the Kubernetes manifest makes a run, index by index")
{
    const RunPlace place;
    auto words = command();
    REQUIRE(words.front() == "hsgm");
    words.front() = hsgm_program();
    for (std::string& word : words) {
        word = word == after(words, "run") ? place / "run.yaml" : word;
        word = word == after(words, "-o") ? place.result() : word;
    }
    const int completions = manifest()["spec"]["completions"].as<int>();
    for (int index = 0; index < completions; ++index) {
        CHECK((!place.has_begun() || place.rasters().empty()));
        ::setenv("JOB_COMPLETION_INDEX", std::to_string(index).c_str(), 1);
        const Outcome outcome = run_program(words);
        INFO(outcome.err);
        CHECK(outcome.code == 0);
    }
    ::unsetenv("JOB_COMPLETION_INDEX");
    CHECK((place.rasters() == place.undisturbed()));
}
