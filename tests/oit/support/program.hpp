// SPDX-License-Identifier: MIT
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

struct ProgramResult {
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
    [[nodiscard]] ProgramResult run(const std::string& arguments,
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
        const ProgramResult result = run(arguments, environment);
        INFO(arguments << ": " << result.error);
        CHECK(result.exit_code == 1);
        CHECK(result.error.starts_with(std::filesystem::path(path_).filename().string() + ": "));
        CHECK(count_of(result.error, "\n") == 1);
        CHECK(contains(result.error, named));
        CHECK(result.out.empty());
    }

    [[nodiscard]] const Folder& folder() const { return folder_; }

private:
    std::string path_;
    Folder folder_;
    std::filesystem::path mesh_;
};

}  // namespace cellist::test
