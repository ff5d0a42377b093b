#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include <sys/wait.h>

#include "oit/support/files.hpp"
#include "oit/support/procedural.hpp"
#include "support/catch.hpp"
#include "support/errors.hpp"

namespace cellist::test {

struct Outcome {
    int exit_code;
    std::string out;
    std::string error;
};

/// A program, in a new folder with the mesh knot.obj.
class Program {
public:
    explicit Program(std::string path)
        : path_(std::move(path)),
          mesh_(folder_.write("knot.obj", obj_text(torus_knot(2, 3, 80, 8)))) {}

    /// `environment` stands before the program, `arguments` after it.
    [[nodiscard]] Outcome run(const std::string& arguments,
                              const std::string& environment = {}) const {
        const std::string out = (folder_ / "stdout").string(),
                          error = (folder_ / "stderr").string();
        const std::string command = "cd '" + (folder_ / ".").string() + "' && " + environment +
                                    " '" + path_ + "' " + arguments + " >'" + out + "' 2>'" +
                                    error + "'";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(error)};
    }

    /// Requires that these arguments are refused in one line, which has `named` in it.
    void require_refused(const std::string& arguments, const std::string& named,
                         const std::string& environment = {}) const {
        const Outcome outcome = run(arguments, environment);
        INFO(arguments << ": " << outcome.error);
        CHECK(outcome.exit_code == 1);
        CHECK(outcome.error.starts_with(std::filesystem::path(path_).filename().string() + ": "));
        CHECK(count_of(outcome.error, "\n") == 1);
        CHECK(contains(outcome.error, named));
        CHECK(outcome.out.empty());
    }

    [[nodiscard]] const Folder& folder() const { return folder_; }

private:
    std::string path_;
    Folder folder_;
    std::filesystem::path mesh_;
};

}  // namespace cellist::test
