// SPDX-License-Identifier: MIT
// What a program writes is whole, or it says why not: files, stdout, and pictures of all frames.
#include <nlohmann/json.hpp>

#include "oit/support/program.hpp"

namespace cellist::test {
namespace {

constexpr const char* small = "knot.obj --size 40x30 --frames 1 ";

void require_full(const Program& program, const std::string& arguments, const std::string& what) {
    const ProgramResult result = program.run(arguments);
    INFO(arguments << ": " << result.error);
    CHECK(result.exit_code == 1);
    CHECK(contains(result.error, "cannot write " + what + ": No space left on device\n"));
}

TEST_CASE("a full disk is an error for every file of cellist-oit") {
    const Program program(CELLIST_OIT_PROGRAM);
    (void)program.folder().write("oit.png", "as it was");
    for (const std::string options :
         {"--out", "--out x.png --write-reference", "--out x.png --write-difference",
          "--out x.png --heatmap", "--out x.png --json"})
        require_full(program, small + options + " /dev/full", "'/dev/full'");
    // What follows the # are the redirections of Program::run().
    require_full(program, small + std::string("--out x.png 2>stderr >/dev/full #"), "to stdout");
    require_full(program, small + std::string("--out - 2>stderr >/dev/full #"), "to stdout");
    require_full(program, "--help 2>stderr >/dev/full #", "to stdout");
    CHECK(read_file(program.folder() / "oit.png") == "as it was");
}

TEST_CASE("a full disk is an error for every file of cellist-tradeoff") {
    const Program program(CELLIST_TRADEOFF_PROGRAM);
    const std::string small_sweep = "knot.obj --size 16x12 --frames 1 --methods weighted ";
    for (const std::string option : {"--html", "--csv", "--json", "--heatmap"})
        require_full(program, small_sweep + option + " /dev/full", "'/dev/full'");
    require_full(program, small_sweep + "2>stderr >/dev/full #", "to stdout");
}

TEST_CASE("a closed pipe is quiet") {
    const Program program(CELLIST_OIT_PROGRAM);
    // The reader has gone before anything is written.
    for (const std::string trap : {"", "trap '' PIPE; "}) {
        const ProgramResult result =
            program.run("--help 2>&3 | true; } 3>error #", trap + "{ sleep 0; ");
        INFO(result.error);
        CHECK(read_file(program.folder() / "error").empty());
    }
}

TEST_CASE("a picture on stdout leaves the report to stderr") {
    const Program program(CELLIST_OIT_PROGRAM);
    const ProgramResult file = program.run(small + std::string("--out a.png"));
    REQUIRE(file.exit_code == 0);
    const ProgramResult screen = program.run(small + std::string("--out - --json a.json"));
    REQUIRE(screen.exit_code == 0);
    CHECK(screen.out == read_file(program.folder() / "a.png"));
    CHECK(contains(screen.error, "cellist-oit knot.obj"));
    CHECK_FALSE(std::filesystem::exists(program.folder() / "-"));
    const ProgramResult metrics =
        program.run(small + std::string("--out a.png --json /dev/stdout"));
    REQUIRE(metrics.exit_code == 0);
    CHECK(nlohmann::json::parse(metrics.out)["scene"] == "knot.obj");
    program.require_refused(small + std::string("--out - --json /dev/stdout"), "same file");
}

TEST_CASE("every frame is written where the name has a number") {
    const Program program(CELLIST_OIT_PROGRAM);
    const ProgramResult result = program.run(
        "knot.obj --size 40x30 --frames 3 --turn 90 --out f-%03d.png --write-reference r.jpg "
        "--write-difference d.exr --json caf\xE9.json");
    INFO(result.error);
    REQUIRE(result.exit_code == 0);
    std::string pictures[3];
    for (int i = 0; i < 3; ++i)
        pictures[i] = read_file(program.folder() / ("f-00" + std::to_string(i + 1) + ".png"));
    CHECK(pictures[0].starts_with("\x89PNG"));
    CHECK(pictures[0] != pictures[1]);
    CHECK(pictures[1] != pictures[2]);
    CHECK_FALSE(std::filesystem::exists(program.folder() / "f-004.png"));
    CHECK(read_file(program.folder() / "r.jpg").starts_with("\xFF\xD8"));
    CHECK(read_file(program.folder() / "d.exr").starts_with("v/1\x01"));
    const auto metrics = nlohmann::json::parse(read_file(program.folder() / "caf\xE9.json"));
    CHECK(metrics["files"]["json"] == "caf\\xE9.json");
    CHECK(metrics["frames_ms"].size() == 3);
    CHECK(metrics["psnr_db"] > 100);
    // The last frame is what a single picture shows.
    REQUIRE(program.run("knot.obj --size 40x30 --frames 3 --turn 90 --out a.png").exit_code == 0);
    CHECK(read_file(program.folder() / "a.png") == pictures[2]);
}

}  // namespace
}  // namespace cellist::test
