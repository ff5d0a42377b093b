// SPDX-License-Identifier: MIT
// What the program writes: JSON with a documented key for each figure, and pictures.
#include "report.hpp"

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "json_report.hpp"
#include "oit/support/json_keys.hpp"
#include "oit/support/program.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/skip.hpp"

namespace cellist::test {
namespace {

using nlohmann::ordered_json;

TEST_CASE("a run writes its pictures and a report whose keys the document has") {
    const Program program(CELLIST_SHADOWS_PROGRAM);
    const ProgramResult result = program.run(
        "swarm --triangles 2000 --width 64 --height 48 --frames 2 --out frame-%02d.png "
        "--out-unblocked u.exr --out-a a.pfm --out-b b.jpg --heatmap h.png --out-error e.png "
        "--json r.json");
    INFO(result.error);
    CHECK(result.exit_code == 0);
    CHECK(contains(result.out, " 0 of "));
    for (const char* name :
         {"frame-01.png", "frame-02.png", "u.exr", "a.pfm", "b.jpg", "h.png", "e.png"}) {
        INFO(name);
        CHECK(std::filesystem::file_size(program.folder() / name) > 100);
    }
    const ordered_json frame = json_in(program, "r.json");
    CHECK(frame["reference"]["rays_different"] == 0);
    CHECK(frame["frames_ms"].size() == 2);
    CHECK(frame["rays"] > frame["rays_blocked"]);
    CHECK(frame["blockers"] == 2 * 784);

    const ProgramResult trade = program.run(
        "room --trade --width 32 --height 24 --frames 1 "
        "--json t.json");
    INFO(trade.error);
    CHECK(trade.exit_code == 0);
    const ordered_json settings = json_in(program, "t.json");
    REQUIRE(settings["settings"].size() > 8);
    for (const ordered_json& setting : settings["settings"]) CHECK(setting["ms"] > 0);

    std::set<std::string> keys;
    add_keys(frame, keys);
    add_keys(settings, keys);
    const std::string text = read_file(CELLIST_SHADOWS_DOCUMENT);
    for (const std::string& key : keys) {
        INFO(key);
        CHECK(contains(text, "`" + key + "`"));
    }
}

TEST_CASE("options that cannot be used are refused in one line") {
    const Program program(CELLIST_SHADOWS_PROGRAM);
    const std::pair<const char*, const char*> table[] = {
        {"rom", "did you mean 'room'"},
        {"nosuch.obj", "nosuch.obj"},
        {"--width 0", "--width 0"},
        {"--height 1048576", "1 to 16384"},
        {"--width -5", "-5"},
        {"--rsm 0", "--rsm 0"},
        {"--samples 0", "--samples 0"},
        {"--samples 3", "--samples 3 does not divide --rsm 512"},
        {"--interleave 3", "--interleave 3 does not divide --samples 8"},
        {"--reduce 0", "--reduce 0"},
        {"--grid 0", "--grid 0"},
        {"--grid 1048576", "1 to 1024"},
        {"--grid many", "many"},
        {"--simplify 0", "--simplify 0"},
        {"swarm --triangles 0", "--triangles 0"},
        {"--triangles 1000", "swarm"},
        {"--time-step 1", "swarm"},
        {"--light sun", "spot or directional"},
        {"--light-position 1,2", "X,Y,Z"},
        {"--light-position 1,2,nan", "X,Y,Z"},
        {"--light-position 1,2,3,4", "X,Y,Z"},
        {"--light-position 1.5,-0.25,-0.1", "move it"},
        {"--frames 0", "--frames 0"},
        {"--out a.gif", "a.gif"},
        {"--out missing/a.png", "missing"},
        {"--out a.png --out-b a.png", "the same file"},
        {"knot.obj --out-a knot.obj", "the same file"},
        {"--trade --reference", "--trade"},
        {"--trade --out-a a.png", "--trade"},
        {"--storage none", "none"},
    };
    for (const auto& [arguments, named] : table) program.require_refused(arguments, named);
}

TEST_CASE("any mesh stands in the room") {
    const Program program(CELLIST_SHADOWS_PROGRAM);
    const ProgramResult result =
        program.run("knot.obj --width 64 --height 48 --frames 1 --simplify 8 --reference");
    INFO(result.error);
    CHECK(result.exit_code == 0);
    CHECK(std::filesystem::exists(program.folder() / "shadows.png"));
}

TEST_CASE("a picture that exceeds the memory of the device is refused in one line") {
    // It takes more than 64 GB. This case comes last: a device may serve one process only, and this
    // one opens it.
    if (device().info().global_memory_bytes > 64'000'000'000)
        CELLIST_SKIP("the device can hold it");
    Program(CELLIST_SHADOWS_PROGRAM).require_refused("--width 16384 --height 16384", "limit");
}

}  // namespace
}  // namespace cellist::test
