// SPDX-License-Identifier: MIT
#include "child_process.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "input_error.hpp"

namespace support {
namespace {

using Clock = std::chrono::steady_clock;

// The first byte of what a child writes; the last is `complete`.
constexpr char has_result = 'R', has_error = 'E', complete = '.';

std::string in_mib(std::uint64_t bytes) { return std::to_string(bytes >> 20) + " MiB"; }

void set_limit(decltype(RLIMIT_CPU) resource, std::uint64_t value) {
    const rlimit limit{value, value};
    (void)setrlimit(resource, &limit);
}

// The address space of this process, which the child inherits.
std::uint64_t mapped_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::uint64_t pages = 0;
    statm >> pages;
    return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void confine_child(const ChildLimits& limits) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (const int number :
         {SIGABRT, SIGBUS, SIGFPE, SIGHUP, SIGILL, SIGINT, SIGPIPE, SIGSEGV, SIGTERM, SIGXCPU})
        (void)std::signal(number, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    (void)sigprocmask(SIG_SETMASK, &none, nullptr);
    // Loaders and runtimes print when they crash; the parent reports the crash in one line instead.
    const int nothing = open("/dev/null", O_RDWR);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        (void)dup2(nothing, stream);
    set_limit(RLIMIT_CORE, 0);
    set_limit(RLIMIT_CPU, limits.processor_s);
    if (const std::uint64_t mapped = mapped_bytes(); mapped > 0)
        set_limit(RLIMIT_AS, mapped + limits.memory_bytes);
}

[[noreturn]] void run_child(const std::function<std::string()>& work, const ChildLimits& limits,
                            int output) {
    confine_child(limits);
    std::string reply(1, has_error);
    try {
        const std::string result = work();
        reply.reserve(result.size() + 2);
        reply[0] = has_result;
        reply += result;
    } catch (const std::bad_alloc&) {
        reply = has_error + ("it needs more than " + in_mib(limits.memory_bytes));
    } catch (const std::exception& error) {
        reply = has_error + std::string(error.what());
    } catch (...) {
        reply = has_error + std::string("an unknown exception");
    }
    reply += complete;
    for (std::size_t at = 0; at < reply.size();) {
        const ssize_t written = write(output, reply.data() + at, reply.size() - at);
        if (written < 0 && errno != EINTR) _exit(1);
        if (written > 0) at += static_cast<std::size_t>(written);
    }
    _exit(0);
}

// A child process, which the destructor ends if it still runs.
class Child {
public:
    Child(const std::function<std::string()>& work, const ChildLimits& limits) {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0)
            throw std::system_error(errno, std::generic_category(), "pipe");
        pid_ = fork();
        if (pid_ == 0) {
            close(ends[0]);
            run_child(work, limits, ends[1]);
        }
        const int error = errno;
        close(ends[1]);
        input_ = ends[0];
        if (pid_ < 0) {
            close(input_);
            throw std::system_error(error, std::generic_category(), "fork");
        }
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() {
        close(input_);
        if (pid_ > 0) {
            kill(pid_, SIGKILL);
            (void)wait();
        }
    }

    // Appends what the child writes; false at the end. Throws where the child takes too long.
    bool read_some(std::string& reply, Clock::time_point deadline, unsigned limit_s) {
        pollfd ready{input_, POLLIN, 0};
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
        const int timeout_ms = static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 1000));
        if (poll(&ready, 1, timeout_ms) <= 0) {
            if (left.count() <= 0)
                throw InputError("it took more than " + std::to_string(limit_s) + " s");
            return true;
        }
        char bytes[1 << 16];
        const ssize_t got = read(input_, bytes, sizeof bytes);
        if (got < 0) return errno == EINTR;
        reply.append(bytes, static_cast<std::size_t>(got));
        return got > 0;
    }

    // How the child ended; 0 if unknown.
    int wait() {
        int status = 0;
        while (waitpid(pid_, &status, 0) < 0)
            if (errno != EINTR) break;
        pid_ = -1;
        return status;
    }

private:
    pid_t pid_ = -1;
    int input_ = -1;
};

std::string end_of(int status, const ChildLimits& limits) {
    if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
        return "it took more than " + std::to_string(limits.processor_s) +
               " s of processor time or was killed";
    if (WIFSIGNALED(status)) return std::string("it crashed (") + strsignal(WTERMSIG(status)) + ")";
    return "it ended without a result";
}

}  // namespace

std::string run_in_child(const std::function<std::string()>& work, const ChildLimits& limits) {
    const unsigned limit_s = 4 * limits.processor_s;
    const Clock::time_point deadline = Clock::now() + std::chrono::seconds(limit_s);
    Child child(work, limits);
    std::string reply;
    while (child.read_some(reply, deadline, limit_s))
        if (reply.size() > limits.result_bytes)
            throw InputError("it makes more than " + in_mib(limits.result_bytes));
    const int status = child.wait();
    if (reply.size() < 2 || reply.back() != complete) throw InputError(end_of(status, limits));
    reply.pop_back();
    const bool is_error = reply[0] == has_error;
    reply.erase(0, 1);
    if (is_error) throw InputError(reply);
    return reply;
}

}  // namespace support
