#include "tests/end_to_end/program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace hsgm::tests {

namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary);
    std::stringstream bytes;
    bytes << file.rdbuf();
    return bytes.str();
}

pid_t spawn(const std::vector<std::string>& command, const std::string& folder)
{
    std::vector<char*> arguments;
    for (const std::string& word : command) {
        arguments.push_back(const_cast<char*>(word.c_str()));
    }
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    const int flags = O_WRONLY | O_CREAT | O_TRUNC;
    const std::string out = folder + "/out";
    const std::string err = folder + "/err";
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), flags, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), flags, 0600);
    pid_t child = -1;
    const int code =
        ::posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (code != 0) {
        throw std::runtime_error("cannot start " + command.front());
    }
    return child;
}

} // namespace

RunningProgram::RunningProgram(const std::vector<std::string>& command)
{
    std::string name = (fs::temp_directory_path() / "hsgm-program-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
        throw std::runtime_error("cannot make " + name);
    }
    folder_ = name;
    child_ = spawn(command, folder_);
}

RunningProgram::~RunningProgram()
{
    if (child_ > 0) {
        ::kill(child_, SIGKILL);
        ::waitpid(child_, nullptr, 0);
    }
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

std::string RunningProgram::err() const
{
    return bytes_of(folder_ + "/err");
}

void RunningProgram::signal(int number) const
{
    ::kill(child_, number);
}

bool RunningProgram::has_ended() const
{
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT) ==
               0 &&
           info.si_pid != 0;
}

Outcome RunningProgram::wait()
{
    int status = 0;
    rusage usage{};
    ::wait4(child_, &status, 0, &usage);
    child_ = -1;
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    return {code, bytes_of(folder_ + "/out"), err(), std::int64_t{usage.ru_maxrss} * 1024};
}

Outcome run_program(const std::vector<std::string>& command)
{
    return RunningProgram(command).wait();
}

std::string hsgm_program()
{
    return HSGM_PROGRAM;
}

Outcome run_hsgm(const std::vector<std::string>& arguments)
{
    std::vector<std::string> command{hsgm_program()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return run_program(command);
}

Snapshot snapshot(const std::string& folder)
{
    Snapshot files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string name = fs::relative(entry.path(), folder).string();
        if (entry.is_directory()) {
            files[name + "/"] = "";
        } else {
            files[name] = bytes_of(entry.path());
        }
    }
    return files;
}

Snapshot rasters_in(const std::string& folder)
{
    Snapshot files = snapshot(folder);
    std::erase_if(files, [](const auto& file) { return !file.first.ends_with(".tif"); });
    return files;
}

std::vector<std::string> names_in(const Snapshot& files)
{
    std::vector<std::string> names;
    for (const auto& [name, bytes] : files) {
        names.push_back(name);
    }
    return names;
}

} // namespace hsgm::tests
