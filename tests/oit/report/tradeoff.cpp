// SPDX-License-Identifier: MIT
// cellist-tradeoff finds the front, and writes what it measured so that it can be read again.
#include <cmath>
#include <limits>
#include <sstream>

#include "camera.hpp"
#include "json_report.hpp"
#include "oit/support/program.hpp"
#include "tradeoff/metrics.hpp"
#include "tradeoff/page.hpp"

namespace cellist::test {
namespace {

oit::Measurement measured(const oit::Quality& quality, double ms, double psnr_db,
                          std::string_view method = "linked") {
    oit::Measurement measurement{.setting = {&oit::method_named(method), quality}};
    measurement.add({ms});
    measurement.bytes = 1000;
    measurement.comparison.psnr_db = psnr_db;
    measurement.comparison.ssim = 0.5;
    return measurement;
}

// Of a file whose name is as awkward as can be.
oit::Sweep sweep() {
    oit::Sweep result;
    result.options.scene = "folder/<script><b>\"&',.obj";
    result.options.width = result.options.height = 1;
    result.device = "device";
    result.driver = "1.0";
    result.most_layers = 64;
    result.frames = 1;
    result.measurements = {
        measured({.layers = 8}, 2, 13.5),
        measured({}, 3, std::numeric_limits<double>::infinity()),
        measured({}, 9, 120, "peeling"),
        {.setting = {&oit::method_named("fixed"), {}}, .failure = "too large, \"by far\""}};
    result.left_out = {{"dual_peeling", "it cannot"}};
    return result;
}

TEST_CASE("the front is what nothing beats in both time and error") {
    oit::Measurement failed = measured({}, 0, 200);
    failed.failure = "none";
    CHECK(oit::pareto_front(std::vector{
              measured({}, 1, 20),   // the fastest
              measured({}, 1, 19),   // as fast, less accurate
              measured({}, 2, 40),   //
              measured({}, 3, 30),   // slower, less accurate
              measured({}, 4, 97),   // accurate enough
              measured({}, 5, 1e9),  // no more than enough
              measured({}, 4, 120),  // as fast and as accurate as another
              failed,
          }) == std::vector{true, false, true, false, true, false, true, false});
    CHECK(oit::pareto_front({}).empty());
}

TEST_CASE("times within three in a hundred count as equal") {
    CHECK(oit::pareto_front(std::vector{
              measured({}, 100, 20),                         // the fastest, hardly
              measured({}, 102, 21),                         // as fast, more accurate
              measured({}, 106, 99), measured({}, 109, 98),  // as fast and as accurate
              measured({}, 110, 98),                         // slower
          }) == std::vector{false, true, true, true, false});
}

TEST_CASE("a front is not of settings that were fastest by chance") {
    oit::Measurement plain = measured({}, 20, 99), lucky = measured({}, 12, 60),
                     faster = measured({}, 5, 40);
    plain.add({18, 25, 30});
    lucky.add({26, 28, 31});
    faster.add({5, 6, 6});
    CHECK(oit::pareto_front(std::vector{plain, lucky, faster}) == std::vector{true, false, true});
}

TEST_CASE("times whose spreads overlap are not distinct") {
    oit::Sweep noisy = sweep();
    noisy.measurements[1].add({2, 4});
    noisy.measurements[2] = measured({}, 2, 120, "counted");
    noisy.measurements[2].add({1, 5});
    const auto exact = oit::exact_methods(noisy);
    REQUIRE(exact.size() == 2);
    CHECK(exact[1].factor < 0.7);
    CHECK(exact[1].least < exact[1].factor);
    CHECK(exact[1].most > 1);
    CHECK_FALSE(exact[1].is_distinct);
    std::ostringstream out;
    print(noisy, out);
    CHECK(contains(out.str(), "counted  not significant"));
    const nlohmann::json metrics = nlohmann::json::parse(support::dump(to_json(noisy), 2));
    CHECK(metrics["exact_methods"][1]["distinct"] == false);
    CHECK(oit::exact_methods(sweep())[1].is_distinct);
}

TEST_CASE("pixels are counted by layers: none, 1, 2 to 3, 4 to 7 and so on") {
    oit::Reference reference;
    reference.offsets = {0, 0, 1, 3, 6, 10, 18};
    CHECK(oit::pixels_by_layers(cellist::Lengths(reference.layers())) ==
          std::vector<std::uint64_t>{1, 1, 2, 1, 1});
}

TEST_CASE("half of the times are within the spread") {
    oit::Measurement measurement;
    measurement.add({5, 1, 9});
    CHECK(measurement.milliseconds == 5);
    CHECK(measurement.fastest == 1);
    measurement.add({4, 6});
    CHECK(measurement.times.size() == 5);
    CHECK(measurement.milliseconds == 5);
    CHECK(measurement.lower_quartile == 4);
    CHECK(measurement.upper_quartile == 6);
    CHECK(measurement.spread() == 0.2);
    CHECK(measured({}, 7, 20).spread() == 0);
    const std::vector several{measurement, measured({}, 7, 20), measurement,
                              oit::Measurement{.setting = {}, .failure = "none"}};
    CHECK(oit::typical_spread(several) == 0.2);
    CHECK(oit::typical_spread({}) == 0);
}

TEST_CASE("fewer layers and exact methods are related to all layers in lists") {
    const oit::Sweep all = sweep();
    const auto layers = oit::fewer_layers(all);
    REQUIRE(layers.size() == 1);
    CHECK(layers[0].factor == 1.5);
    const auto exact = oit::exact_methods(all);
    REQUIRE(exact.size() == 2);
    CHECK(exact[0].factor == 1);
    CHECK(exact[1].factor == 3);
    oit::Sweep without = all;
    without.measurements.erase(without.measurements.begin() + 1);
    CHECK(oit::fewer_layers(without).empty());
    CHECK(oit::exact_methods(without).empty());
}

TEST_CASE("base64 is that of RFC 4648") {
    for (const auto& [bytes, text] : {std::pair{"", ""},
                                      {"f", "Zg=="},
                                      {"fo", "Zm8="},
                                      {"foo", "Zm9v"},
                                      {"foob", "Zm9vYg=="},
                                      {"fooba", "Zm9vYmE="},
                                      {"foobar", "Zm9vYmFy"},
                                      {"\xFF\xFE\xFD", "//79"}})
        CHECK(support::base64(bytes) == text);
}

TEST_CASE("metrics are read from JSON as they were") {
    const nlohmann::json metrics = nlohmann::json::parse(support::dump(to_json(sweep()), 2));
    CHECK(metrics["scene"] == "<script><b>\"&',.obj");
    CHECK(metrics["alpha"] == 0.35);
    CHECK(metrics["settings"].size() == 4);
    CHECK(metrics["settings"][0]["layers"] == 8);
    CHECK(metrics["settings"][0]["psnr_db"] == 13.5);
    CHECK(metrics["settings"][0]["pareto"] == true);
    CHECK(metrics["settings"][1]["pareto"] == true);
    CHECK(metrics["settings"][2]["pareto"] == false);
    CHECK(metrics["settings"][1]["psnr_db"].is_null());
    CHECK(metrics["settings"][3]["failure"] == "too large, \"by far\"");
    CHECK(metrics["fewer_layers"][0]["speed_up"] == 1.5);
    CHECK(metrics["exact_methods"][1]["times_linked"] == 3);
    CHECK(metrics["left_out"][0]["reason"] == "it cannot");
}

TEST_CASE("lines of CSV have a field for each name") {
    std::istringstream csv(to_csv(sweep()));
    std::vector<std::string> lines;
    for (std::string line; std::getline(csv, line);) lines.push_back(line);
    REQUIRE(lines.size() == 5);
    CHECK(lines[0].starts_with("options,method,size,layers,"));
    CHECK(lines[1].starts_with(
        "--method linked --layers 8,linked,,8,0.0,32,float,1,samples,2.0,2.0,2.0,2.0,1000,13.5,"));
    CHECK(lines[4].ends_with(",\"too large, \"\"by far\"\"\""));
    const std::size_t commas = count_of(lines[0], ",");
    for (std::size_t i = 1; i < 4; ++i) CHECK(count_of(lines[i], ",") == commas);
    CHECK(count_of(lines[4], ",") == commas + 1);  // that of the text
}

// The page of a sweep, and the JSON that is in it.
nlohmann::json metrics_of(const std::string& page) {
    const std::string begin = "id=\"metrics\">";
    const std::size_t from = page.find(begin) + begin.size();
    return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

// Nothing is loaded, and nothing that is not the page's own is markup.
void require_self_contained(const std::string& page) {
    for (const char* part : {"http:", "https:", "src=", "href=", "url(", "@import", "{{"})
        CHECK_FALSE(contains(page, part));
    CHECK(count_of(page, "<script") == 3);
    CHECK(count_of(page, "</script>") == 3);
    CHECK(contains(page, "default-src 'none'"));
}

TEST_CASE("a page needs no other file, and shows names as text") {
    const oit::Sweep all = sweep();
    const oit::Scene scene;
    const oit::Frame frame{.scene = scene, .views = {support::frame_unit_sphere({}, 1, 1)}};
    oit::Reference reference;
    reference.image = {{0.5, 0.5, 0.5}};
    oit::Pictures pictures(reference, frame);
    for (const oit::Measurement& measurement : all.measurements)
        if (measurement.drawn()) pictures.add(measurement.setting, {{{0.5F, 0.5F, 0.5F, 1}}});
    CHECK(pictures.all().uris().size() == 2);  // the reference, which all are, and no difference
    const std::string page = to_html(all, pictures);
    require_self_contained(page);
    CHECK(contains(page, "&lt;script&gt;&lt;b&gt;&quot;&amp;',.obj"));
    CHECK_FALSE(contains(page, "<b>"));
    const nlohmann::json metrics = metrics_of(page);
    CHECK(metrics["scene"] == all.scene_name());
    CHECK(metrics["settings"][2]["picture"] == 0);
    CHECK(metrics["settings"][2]["difference"] == 1);
}

// Measurements with the times and the error that a report has.
std::vector<oit::Measurement> measurements_of(const nlohmann::json& settings) {
    std::vector<oit::Measurement> measurements;
    for (const nlohmann::json& setting : settings) {
        oit::Measurement measurement = measured({}, 0, setting["psnr_db"]);
        measurement.milliseconds = setting["ms"];
        measurement.fastest = setting["fastest_ms"];
        measurement.lower_quartile = setting["lower_quartile_ms"];
        measurement.upper_quartile = setting["upper_quartile_ms"];
        measurements.push_back(measurement);
    }
    return measurements;
}

TEST_CASE("a run writes table, JSON, CSV and page") {
    const Program program(CELLIST_TRADEOFF_PROGRAM);
    const ProgramResult result = program.run(
        "knot.obj --size 40x30 --methods weighted,moments --frames 4 --json a.json --csv a.csv "
        "--html a.html --stereo 0.1");
    INFO(result.error);
    REQUIRE(result.exit_code == 0);
    CHECK(count_of(result.error, "\n") == 2);
    CHECK(contains(result.out, "--method moments"));
    const nlohmann::json metrics = nlohmann::json::parse(read_file(program.folder() / "a.json"));
    CHECK(metrics["scene"] == "knot.obj");
    CHECK(metrics["eyes"] == 2);
    REQUIRE(metrics["settings"].size() == 2);
    for (const nlohmann::json& setting : metrics["settings"]) {
        CHECK(setting["ms"] > 0);
        CHECK(setting["frames"] == 4);
        CHECK(setting["lower_quartile_ms"] <= setting["ms"]);
        CHECK(setting["upper_quartile_ms"] >= setting["ms"]);
        CHECK(setting["psnr_db"] > 20);
        CHECK(setting["ssim"] > 0.5);
    }
    // Times differ from run to run, but these times make this front.
    const std::vector<oit::Measurement> reported = measurements_of(metrics["settings"]);
    const std::vector<bool> front = oit::pareto_front(reported);
    for (std::size_t i = 0; i < front.size(); ++i)
        CHECK(metrics["settings"][i]["pareto"] == front[i]);
    CHECK(count_of(read_file(program.folder() / "a.csv"), "\n") == 3);
    const std::string page = read_file(program.folder() / "a.html");
    require_self_contained(page);
    CHECK(metrics_of(page)["pictures"].size() == 5);
}

TEST_CASE("what cannot be compared is refused in a line") {
    const Program program(CELLIST_TRADEOFF_PROGRAM);
    for (const auto& [arguments, named] :
         {std::pair{"", "mesh"},
          {"nosuch", "nosuch"},
          {"extreme-nothing --size 8x8", "transparent"},
          {"extreme-opaque --size 8x8", "transparent"},
          {"knot.obj --methods nosuch", "weighted"},
          {"knot.obj --methods ,", "''"},
          {"knot.obj --methods weighted --blend additive", "only surfaces"},
          {"knot.obj --frames 0", "1 to"},
          {"knot.obj --size 0x1", "0x1"},
          {"knot.obj --html missing/a.html", "missing"},
          {"knot.obj --json missing/a.json", "missing"},
          {"knot.obj --csv .", "folder"},
          {"knot.obj --csv knot.obj", "the mesh"},
          {"knot.obj --json a --html ./a", "same file"},
          {"knot.obj --layers 8", "--layers"}})
        program.require_refused(arguments, named);
    CHECK(contains(program.run("--help").out, "--methods"));
}

}  // namespace
}  // namespace cellist::test
