// SPDX-License-Identifier: MIT
// The command lines of the programs. Input: lines. The first is the name of a program, the others
// are its arguments; a backslash at the end of a line continues the argument on the next. The
// program runs in this process, without any OpenCL platform, so that it ends where it would choose
// a device. Where the first line starts with "run ", the program is started on a device instead, in
// a folder of its own: numbers are cut to two digits then, and slashes become underscores.
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "input.hpp"

#define CELLIST_FUZZ_PROGRAM(name) int name##_main(int, char**);
CELLIST_FUZZ_PROGRAMS
#undef CELLIST_FUZZ_PROGRAM

namespace cellist::fuzz {
namespace {

struct Program {
    std::string name;
    int (*main)(int, char**);
    const char* path;
};

const std::vector<Program>& programs() {
    static const std::vector<Program> all{
#define CELLIST_FUZZ_PROGRAM(name) {#name, name##_main, CELLIST_FUZZ_PATH_OF_##name},
        CELLIST_FUZZ_PROGRAMS
#undef CELLIST_FUZZ_PROGRAM
    };
    return all;
}

struct Outcome {
    int status;  ///< -1 where a signal ended the program, -2 where it did not end
    std::string out;
    std::string error;
};

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines(1);
    for (const char c : text) {
        if (c != '\n')
            lines.back() += c;
        else if (lines.back().ends_with('\\'))
            lines.back().back() = '\n';
        else
            lines.emplace_back();
    }
    // Arguments of programs end at a zero.
    for (std::string& line : lines) line.resize(std::min(line.find('\0'), line.size()));
    return lines;
}

std::vector<char*> pointers_to(std::vector<std::string>& arguments) {
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    return pointers;
}

/// Replaces the environment variable that names the folder of OpenCL drivers, as long as it lives.
class WithoutDrivers {
public:
    WithoutDrivers() {
        if (const char* vendors = std::getenv("OCL_ICD_VENDORS")) vendors_ = vendors;
        setenv("OCL_ICD_VENDORS", "/nonexistent", 1);
    }
    ~WithoutDrivers() {
        if (vendors_.empty())
            unsetenv("OCL_ICD_VENDORS");
        else
            setenv("OCL_ICD_VENDORS", vendors_.c_str(), 1);
    }
    WithoutDrivers(const WithoutDrivers&) = delete;
    WithoutDrivers& operator=(const WithoutDrivers&) = delete;

private:
    std::string vendors_;
};

Outcome call(const Program& program, std::vector<std::string> arguments) {
    const WithoutDrivers without_drivers;
    std::ostringstream out, error;
    std::streambuf* const cout = std::cout.rdbuf(out.rdbuf());
    std::streambuf* const cerr = std::cerr.rdbuf(error.rdbuf());
    std::vector<char*> pointers = pointers_to(arguments);
    const int status = program.main(static_cast<int>(arguments.size()), pointers.data());
    std::cout.rdbuf(cout);
    std::cerr.rdbuf(cerr);
    return {status, out.str(), error.str()};
}

/// A folder that holds a mesh of four triangles, and is removed at the end.
class Folder {
public:
    Folder() {
        std::string name =
            (std::filesystem::temp_directory_path() / "cellist-fuzz-XXXXXX").string();
        CELLIST_FUZZ_REQUIRE(mkdtemp(name.data()) != nullptr);
        path_ = name;
        std::ofstream(path_ / "mesh.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                             "f 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\n";
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] std::string read(const std::string& name) const {
        std::ifstream file(path_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

private:
    std::filesystem::path path_;
};

int status_of(pid_t child) {
    for (int tenths = 0; tenths < 1200; ++tenths) {
        int status = 0;
        const pid_t ended = waitpid(child, &status, WNOHANG);
        if (ended == child) return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        usleep(100'000);
    }
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    return -2;
}

Outcome start(const Program& program, std::vector<std::string> arguments) {
    const Folder folder;
    const std::string out = (folder.path() / "stdout").string();
    const std::string error = (folder.path() / "stderr").string();
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addopen(&actions, 2, error.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0600);
    posix_spawn_file_actions_addchdir_np(&actions, folder.path().c_str());
    std::vector<char*> pointers = pointers_to(arguments);
    pid_t child = 0;
    const int code = posix_spawn(&child, program.path, &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    CELLIST_FUZZ_REQUIRE(code == 0);
    const int status = status_of(child);
    return {status, folder.read("stdout"), folder.read("stderr")};
}

/// Keeps a program small and inside its folder.
void tame(std::vector<std::string>& arguments) {
    for (std::string& argument : arguments) {
        std::string tamed;
        std::size_t digits = 0;
        for (const char c : argument) {
            digits = c >= '0' && c <= '9' ? digits + 1 : 0;
            if (digits <= 2) tamed += c == '/' ? '_' : c;
        }
        argument = tamed;
    }
    for (const auto& [program, option] : {std::pair{"particles", "--points"},
                                          {"bucket_sort", "--keys"},
                                          {"triangle_grid", "--segments"}})
        if (arguments[0] == program &&
            std::find(arguments.begin(), arguments.end(), option) == arguments.end())
            arguments.insert(arguments.begin() + 1, {option, "50"});
}

void require(bool good, const char* what, const Outcome& outcome) {
    if (good) return;
    std::fprintf(stderr, "%s: status %d, stdout '%s', stderr '%s'\n", what, outcome.status,
                 outcome.out.c_str(), outcome.error.c_str());
    std::abort();
}

void run(const std::string& text) {
    std::vector<std::string> arguments = lines_of(text);
    const bool starts = arguments[0].starts_with("run ");
    if (starts) arguments[0].erase(0, 4);
    const auto program =
        std::find_if(programs().begin(), programs().end(),
                     [&](const Program& known) { return known.name == arguments[0]; });
    if (program == programs().end()) return;
    if (starts) tame(arguments);
    const Outcome outcome = starts ? start(*program, arguments) : call(*program, arguments);

    // 0 all is well, 1 it cannot be done, 2 (the command `cellist`) wrong usage.
    require(outcome.status >= 0 && outcome.status <= (program->name == "cellist" ? 2 : 1),
            "another status", outcome);
    if (outcome.status == 0) {
        require(!outcome.out.empty(), "success without a word", outcome);
        return;
    }
    const std::string begin = (program->name == "oit" ? "cellist-oit" : program->name) + ": ";
    require(outcome.error.starts_with(begin), "no reason given", outcome);
    if (program->name != "cellist")
        require(outcome.error.find('\n') == outcome.error.size() - 1, "more than one line",
                outcome);
}

}  // namespace
}  // namespace cellist::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    cellist::fuzz::run({reinterpret_cast<const char*>(data), size});
    return 0;
}
