#include "tests/structure/source_tree.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>

namespace hsgm::structure {

namespace fs = std::filesystem;

namespace {

// What ./dev, CMake and the program make; .gitignore names the same.
bool is_generated_or_hidden(const std::string& top_name)
{
    return top_name.starts_with("build") || top_name.starts_with("demo-out") ||
           top_name.starts_with(".");
}

bool is_source(const fs::path& path)
{
    static const std::set<std::string> kExtensions{".cpp", ".h", ".cu", ".cuh", ".sh"};
    return kExtensions.contains(path.extension().string());
}

std::string read_text(const fs::path& path)
{
    std::ifstream in(path, std::ios::binary);
    if (!in) {
        throw std::runtime_error("cannot read " + path.string());
    }
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

std::vector<std::string> folders_on_disk(const std::string& root)
{
    std::vector<std::string> folders;
    for (const auto& entry : fs::directory_iterator(root)) {
        const std::string name = entry.path().filename().string();
        if (entry.is_directory() && !is_generated_or_hidden(name)) {
            folders.push_back(name);
        }
    }
    std::sort(folders.begin(), folders.end());
    return folders;
}

// Output of a shell command; empty where it fails.
std::string output_of(const std::string& command)
{
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"),
                                                               pclose);
    std::string output;
    std::array<char, 4096> buffer{};
    while (pipe) {
        const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), pipe.get());
        if (got == 0) {
            break;
        }
        output.append(buffer.data(), got);
    }
    return output;
}

} // namespace

std::vector<std::string> split_lines(std::string_view text)
{
    std::vector<std::string> lines;
    std::istringstream in{std::string(text)};
    for (std::string line; std::getline(in, line);) {
        lines.push_back(line);
    }
    return lines;
}

std::vector<SourceFile> read_sources(const std::string& root)
{
    std::vector<SourceFile> files;
    for (const std::string& folder : folders_on_disk(root)) {
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(root) / folder)) {
            if (entry.is_regular_file() && is_source(entry.path())) {
                files.push_back({fs::relative(entry.path(), root).generic_string(),
                                 split_lines(read_text(entry.path()))});
            }
        }
    }
    std::sort(files.begin(), files.end(),
              [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
    return files;
}

std::vector<std::string> top_folders(const std::string& root)
{
    // A checkout may hold folders of its user's; only tracked ones are ours. Git may refuse
    // a checkout that somebody else owns, hence the safe.directory.
    const std::string tracked =
        fs::exists(fs::path(root) / ".git")
            ? output_of("git -c safe.directory='*' -C '" + root + "' ls-files 2>/dev/null")
            : "";
    std::set<std::string> folders;
    for (const std::string& path : split_lines(tracked)) {
        const auto slash = path.find('/');
        if (slash != std::string::npos && path[0] != '.') {
            folders.insert(path.substr(0, slash));
        }
    }
    return folders.empty() ? folders_on_disk(root)
                           : std::vector<std::string>(folders.begin(), folders.end());
}

} // namespace hsgm::structure
