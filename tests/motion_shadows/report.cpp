// SPDX-License-Identifier: MIT
// What the program writes: JSON with a documented key for each figure, pictures, CSV and a page.
#include "report.hpp"

#include <filesystem>
#include <set>

#include "oit/support/json_keys.hpp"
#include "oit/support/program.hpp"
#include "support/catch.hpp"

namespace cellist::test {
namespace {

using nlohmann::ordered_json;

const std::string small = "--width 48 --height 36 --shadow-map 128 --frames 1 ";

TEST_CASE("a run writes its pictures and a report whose keys the document has") {
    const Program program(CELLIST_MOTION_SHADOWS_PROGRAM);
    const ProgramResult result = program.run(
        "blinds --method all --compress on --times 400 --samples 8 --out a.png --out-shadow s.pfm "
        "--out-difference d.png --out-reference r.exr --json r.json --csv r.csv --html r.html " +
        small);
    INFO(result.error);
    CHECK(result.exit_code == 0);
    CHECK(contains(result.out, "against accumulate, 400 moments"));
    for (const char* name : {"a-accumulate.png", "a-exact.png", "a-ranges.png", "a-tsm.png",
                             "a-static.png", "s-exact.pfm", "d-tsm.png", "r.exr"}) {
        INFO(name);
        CHECK(std::filesystem::file_size(program.folder() / name) > 100);
    }
    const ordered_json report = json_in(program, "r.json");
    const ordered_json& rows = report["methods"];
    REQUIRE(rows.size() == motion::methods.size());
    CHECK(rows[0]["method"] == "accumulate");
    CHECK(rows[0]["samples"] == 400);
    CHECK(rows[0]["psnr_db"].is_null());
    for (std::size_t i = 1; i < rows.size(); ++i) {
        CHECK(rows[i]["samples"] == 8);
        CHECK(rows[i]["ms"] > 0);
        CHECK(rows[i]["bytes"] > 0);
        CHECK(rows[i]["psnr_db"] > 15);
        CHECK(rows[i]["pixels_lit"] > 0);
        CHECK(rows[i]["shadow_map_ms"] > 0);
    }
    CHECK(report["whole_ranges"] > rows[1]["ranges"]);
    CHECK(rows[1]["ranges"] > rows[1]["pieces"]);
    const std::uint64_t ranges = report["whole_ranges"], fragments = report["whole_fragments"];
    CHECK(report["equation_2_bytes"] == 16 * fragments + 24 * ranges + 8 * 128 * 128);
    CHECK(rows[1]["tsm_bytes"] == 4 * 8 * 128 * 128);

    const std::string csv = read_file(program.folder() / "r.csv");
    CHECK(count_of(csv, "\n") == 1 + rows.size());
    const std::string page = read_file(program.folder() / "r.html");
    CHECK(contains(page, "cellist-motion-shadows: blinds"));
    CHECK_FALSE(contains(page, "{{"));

    std::set<std::string> keys;
    add_keys(report, keys);
    const std::string text = read_file(CELLIST_MOTION_SHADOWS_DOCUMENT);
    for (const std::string& key : keys) {
        INFO(key);
        CHECK(contains(text, "`" + key + "`"));
    }
}

TEST_CASE("--trade compares the methods with several numbers of samples") {
    const Program program(CELLIST_MOTION_SHADOWS_PROGRAM);
    const ProgramResult result = program.run("--trade --times 10 --json t.json " + small);
    INFO(result.error);
    CHECK(result.exit_code == 0);
    std::set<std::pair<std::string, int>> drawn;
    const ordered_json report = json_in(program, "t.json");
    for (const ordered_json& method : report["methods"])
        drawn.emplace(method["method"], method["samples"]);
    CHECK(drawn.size() == 1 + 5 * (motion::methods.size() - 1));
    for (const int samples : {8, 16, 20, 32, 64}) CHECK(drawn.contains({"exact", samples}));
    CHECK_FALSE(std::filesystem::exists(program.folder() / "motion-shadows.png"));
}

TEST_CASE("any mesh moves, with any light, exposure, storage and budget") {
    const Program program(CELLIST_MOTION_SHADOWS_PROGRAM);
    for (const char* arguments :
         {"knot.obj --move 0,0.3,-0.2 --spin -40 --light directional --exposure 2",
          "knot.obj --spin 30 --exposure 0 --samples 1",
          "knot.obj --memory 160KiB --storage counted --prepass off --bias 2.5 --compress on "
          "--tolerance 1",
          "walker --triangles 12000 --samples 40 --method tsm", "fan --samples 0",
          "--method accumulate --times 3"}) {
        INFO(arguments);
        const ProgramResult result = program.run(small + arguments + " --json r.json");
        INFO(result.error);
        CHECK(result.exit_code == 0);
        CHECK(std::filesystem::exists(program.folder() / "motion-shadows.png"));
        const ordered_json report = json_in(program, "r.json");
        CHECK((report["methods"][0]["slices"] > 1) == !report["memory"].is_null());
    }
}

TEST_CASE("without motion the methods agree") {
    const Program program(CELLIST_MOTION_SHADOWS_PROGRAM);
    const ProgramResult result =
        program.run(small + "blinds --exposure 0 --method all --out-shadow s.pfm");
    INFO(result.error);
    REQUIRE(result.exit_code == 0);
    const std::string still = read_file(program.folder() / "s-static.pfm");
    CHECK(read_file(program.folder() / "s-exact.pfm") == still);
    CHECK(read_file(program.folder() / "s-tsm.pfm") == still);
}

TEST_CASE("with no samples the picture is black") {
    const Program program(CELLIST_MOTION_SHADOWS_PROGRAM);
    const ProgramResult result = program.run(small + "--samples 0 --method all --out a.pfm");
    INFO(result.error);
    REQUIRE(result.exit_code == 0);
    for (const char* name : {"a-exact.pfm", "a-ranges.pfm", "a-tsm.pfm", "a-static.pfm"}) {
        const std::string file = read_file(program.folder() / name);
        const std::size_t bytes = std::size_t{48} * 36 * 12;
        REQUIRE(file.size() > bytes);
        CHECK(file.substr(file.size() - bytes) == std::string(bytes, '\0'));
    }
}

TEST_CASE("options that cannot be used are refused in one line") {
    const Program program(CELLIST_MOTION_SHADOWS_PROGRAM);
    const std::pair<const char*, const char*> table[] = {
        {"cube", "did you mean 'cubes'"},
        {"nosuch.obj", "nosuch.obj"},
        {"--method tms", "did you mean 'tsm'"},
        {"--samples 10001", "0 to 10000"},
        {"--samples -1", "-1"},
        {"--times 0", "--times 0"},
        {"--times 5", "--reference"},
        {"--width 0", "--width 0"},
        {"--height 1048576", "1 to 16384"},
        {"--shadow-map 0", "--shadow-map 0"},
        {"--light sun", "spot or directional"},
        {"--exposure -1", "0 to 4"},
        {"--exposure nan", "0 to 4"},
        {"knot.obj --move 0,4,0 --exposure 4", "past its light"},
        {"--move 1,0,0", "mesh file"},
        {"fan --spin 10", "mesh file"},
        {"knot.obj --move 1,2", "X,Y,Z"},
        {"knot.obj --move 1,2,3,4", "X,Y,Z"},
        {"knot.obj --move 1,nan,0", "-10 to 10"},
        {"knot.obj --spin 361", "-360 to 360"},
        {"--triangles 20000", "walker"},
        {"walker --triangles 11999", "12000 to 1000000"},
        {"--compress maybe", "on or off"},
        {"--prepass 1", "on or off"},
        {"--method tsm --compress off", "--method exact"},
        {"--tolerance 1", "--compress on"},
        {"--tolerance -1", "0 to 100"},
        {"--bias many", "0 to 100"},
        {"--memory 0", "64MiB"},
        {"--memory 3PiB", "64MiB"},
        {"--method static --memory 1GiB", "--method exact"},
        {"--storage none", "none"},
        {"--frames 0", "--frames 0"},
        {"--out a.gif", "a.gif"},
        {"--out missing/a.png", "missing"},
        {"--out a.png --out-shadow a.png", "the same file"},
        {"knot.obj --csv knot.obj", "the same file"},
        {"--trade --samples 3", "--trade"},
        {"--trade --method tsm", "--trade"},
        {"--trade --out a.png", "--trade"},
        {"--method accumulate --html a.html", "another --method"},
        {"--width 16384 --height 16384", "limit"},
    };
    for (const auto& [arguments, named] : table) program.require_refused(arguments, named);
}

}  // namespace
}  // namespace cellist::test
