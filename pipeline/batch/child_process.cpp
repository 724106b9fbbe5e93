#include "pipeline/batch/child_process.h"

#include "io/error.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace hsgm::pipeline {

namespace {

// Between fork and exec: system calls alone, because other threads may hold any lock.
[[noreturn]] void become(char* const* arguments, int log, pid_t parent)
{
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) {
        ::_exit(127); // it died in between
    }
    ::dup2(log, STDOUT_FILENO);
    ::dup2(log, STDERR_FILENO);
    ::signal(SIGINT, SIG_DFL);
    ::signal(SIGTERM, SIG_DFL);
    ::execv(arguments[0], arguments);
    ::_exit(127);
}

} // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command,
                           const std::filesystem::path& log)
{
    const int fd = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0) {
        throw io::StorageError("Cannot write " + log.string() + ": " +
                               std::generic_category().message(errno) + ".");
    }
    std::vector<char*> arguments;
    for (const std::string& word : command) {
        arguments.push_back(const_cast<char*>(word.c_str()));
    }
    arguments.push_back(nullptr);
    const pid_t parent = ::getpid();
    pid_ = ::fork();
    if (pid_ == 0) {
        become(arguments.data(), fd, parent);
    }
    ::close(fd);
    if (pid_ < 0) {
        throw std::runtime_error("no process can be started: " +
                                 std::generic_category().message(errno));
    }
}

ChildProcess::~ChildProcess()
{
    if (pid_ > 0) {
        ::kill(pid_, SIGTERM);
        ::waitpid(pid_, nullptr, 0);
    }
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), exit_code_(other.exit_code_)
{
}

void ChildProcess::stop() const
{
    if (pid_ > 0) {
        ::kill(pid_, SIGTERM);
    }
}

bool ChildProcess::has_ended()
{
    if (pid_ < 0) {
        return true;
    }
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) != pid_) {
        return false;
    }
    pid_ = -1;
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return true;
}

std::string this_program()
{
    return std::filesystem::read_symlink("/proc/self/exe").string();
}

} // namespace hsgm::pipeline
