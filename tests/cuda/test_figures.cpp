#include "tests/catch.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>

// What ptxas said of every kernel for every processor, when the build compiled them.
namespace {

struct Figures {
    int registers = 0;
    int spilled_bytes = 0;
    int stack_bytes = 0;
    int static_shared_bytes = 0;
};

// Of each kernel on each processor, by "sm_75 name".
std::map<std::string, Figures> figures()
{
    static const std::regex kKernel(R"(Compiling entry function '(\S+)' for '(sm_\d+)')");
    static const std::regex kStack(
        R"((\d+) bytes stack frame, (\d+) bytes spill stores, (\d+) bytes spill loads)");
    static const std::regex kUsed(R"(Used (\d+) registers)");
    static const std::regex kShared(R"((\d+) bytes smem)");
    std::map<std::string, Figures> found;
    for (const auto& entry : std::filesystem::directory_iterator(HSGM_FIGURES_DIR)) {
        if (entry.path().extension() != ".figures") {
            continue;
        }
        std::ifstream file(entry.path());
        std::string kernel;
        std::smatch match;
        for (std::string line; std::getline(file, line);) {
            if (std::regex_search(line, match, kKernel)) {
                kernel = match[2].str() + " " + match[1].str();
            } else if (std::regex_search(line, match, kStack)) {
                found[kernel].stack_bytes = std::stoi(match[1]);
                found[kernel].spilled_bytes = std::stoi(match[2]) + std::stoi(match[3]);
            } else if (std::regex_search(line, match, kUsed)) {
                found[kernel].registers = std::stoi(match[1]);
                if (std::regex_search(line, match, kShared)) {
                    found[kernel].static_shared_bytes = std::stoi(match[1]);
                }
            }
        }
    }
    return found;
}

} // namespace

TEST_CASE("kernels keep within the registers of every processor and spill nothing")
{
    // 384 threads share 65536 registers, in steps of 8.
    constexpr int kMostRegisters = 168;
    const auto all = figures();
    std::map<std::string, int> kernels_of;
    for (const auto& [name, f] : all) {
        INFO(name);
        CHECK(f.registers > 0);
        CHECK(f.registers <= kMostRegisters);
        CHECK(f.spilled_bytes == 0);
        CHECK(f.stack_bytes == 0);
        CHECK(f.static_shared_bytes == 0);
        ++kernels_of[name.substr(0, name.find(' '))];
    }
    REQUIRE(kernels_of.size() == 5);
    for (const std::string processor : {"sm_75", "sm_80", "sm_86", "sm_89", "sm_90"}) {
        INFO(processor);
        CHECK(kernels_of[processor] == 21);
    }
}
