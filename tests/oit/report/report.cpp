// SPDX-License-Identifier: MIT
// What the program says of a picture, on the screen and as JSON, is what it drew.
#include <utility>

#include <nlohmann/json.hpp>

#include "oit/support/program.hpp"

namespace cellist::test {
namespace {

TEST_CASE("the picture, the screen and the JSON agree, and pictures are equal in every run") {
    const Program program(CELLIST_OIT_PROGRAM);
    const std::string arguments =
        "knot.obj --size 160x90 --opaque-floor --reference --frames 1 --json a.json --out ";
    const ProgramResult result = program.run(arguments + "a.png");
    INFO(result.error);
    REQUIRE(result.exit_code == 0);
    CHECK(result.error.empty());
    const std::string json = read_file(program.folder() / "a.json");
    for (const std::string key :
         {"scene", "method", "device", "driver", "width", "height", "triangles", "fragments",
          "cells_nonempty", "longest_list", "bytes", "passes_ms", "transform", "raster_insert",
          "sort_blend", "ms", "frames_ms", "psnr_db", "max_abs_error"}) {
        INFO(key);
        CHECK(contains(json, "\"" + key + "\""));
    }
    CHECK(contains(result.out, "1,280"));
    CHECK(contains(json, "\"triangles\": 1280"));
    CHECK(contains(result.out, "a.png"));
    REQUIRE(program.run(arguments + "b.png").exit_code == 0);
    const std::string first = read_file(program.folder() / "a.png");
    CHECK(first.starts_with("\x89PNG"));
    CHECK(first == read_file(program.folder() / "b.png"));
}

TEST_CASE("fewer layers are compared with all, and with as many") {
    const Program program(CELLIST_OIT_PROGRAM);
    const auto metrics = [&](const std::string& arguments) {
        const ProgramResult result = program.run(
            "knot.obj --size 160x90 --frames 1 --reference --out a.png --json a.json " + arguments);
        INFO(result.error);
        REQUIRE(result.exit_code == 0);
        CHECK(contains(result.out, "dB against all layers"));
        return std::pair(result.out, nlohmann::json::parse(read_file(program.folder() / "a.json")));
    };
    const auto [text, one] = metrics("--layers 1");
    CHECK(contains(text, "dB against the 1 nearest layer in double precision"));
    CHECK(one["psnr_db"] < 40);
    CHECK(one["nearest_layers"]["psnr_db"] > 100);
    for (const std::string arguments : {"", "--layers all", "--method kbuffer:1"}) {
        INFO(arguments);
        const auto [other_text, other] = metrics(arguments);
        CHECK_FALSE(contains(other_text, "nearest layer in double precision"));
        CHECK(other["nearest_layers"].is_null());
        CHECK((other["psnr_db"] > 100) == (arguments != "--method kbuffer:1"));
    }
    const auto [exact_text, exact] = metrics("--layers 1000");
    CHECK(exact["psnr_db"] == exact["nearest_layers"]["psnr_db"]);
}

TEST_CASE("the screen tells only what the method has") {
    const Program program(CELLIST_OIT_PROGRAM);
    const std::string run = "knot.obj --size 64x48 --frames 1 --reference --json a.json ";
    const std::string lists = program.run(run).out;
    CHECK(contains(lists, "nodes of 16 bytes"));
    CHECK(contains(lists, "sort + blend"));
    CHECK(contains(lists, "depth error"));
    const std::string weighted = program.run(run + "--method weighted").out;
    CHECK_FALSE(contains(weighted, "nodes"));
    CHECK(contains(weighted, "not counted"));
    CHECK(contains(weighted, "not compared"));
    CHECK(contains(read_file(program.folder() / "a.json"), "\"node_bytes\": null"));
    const std::string sliced = program.run(run + "--memory 1MiB").out;
    CHECK_FALSE(contains(sliced, "sort + blend"));
    CHECK(contains(sliced, "longest list"));
    CHECK(contains(sliced, "not compared"));
    CHECK(contains(read_file(program.folder() / "a.json"), "\"sort_blend\": null"));
}

TEST_CASE("without a reference, its metrics are null") {
    const Program program(CELLIST_OIT_PROGRAM);
    REQUIRE(program.run("knot.obj --size 32x32 --frames 1 --json a.json --out a.png").exit_code ==
            0);
    const std::string json = read_file(program.folder() / "a.json");
    CHECK(contains(json, "\"psnr_db\": null"));
    CHECK(contains(json, "\"max_abs_error\": null"));
}

}  // namespace
}  // namespace cellist::test
