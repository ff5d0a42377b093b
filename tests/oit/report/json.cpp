// SPDX-License-Identifier: MIT
// The reports say what was drawn: each option has its key, and docs/json.md has all keys.
#include <regex>
#include <set>
#include <sstream>

#include "json_report.hpp"
#include "oit/support/json_keys.hpp"
#include "oit/support/program.hpp"
#include "options.hpp"
#include "report/report.hpp"
#include "tradeoff/metrics.hpp"
#include "tradeoff/tradeoff_options.hpp"

namespace cellist::test {
namespace {

using nlohmann::ordered_json;

// What an option is called in the report.
struct Row {
    std::string option;
    std::string arguments;
    std::string key;  ///< a JSON pointer
    ordered_json value;
};

// Of both programs.
const std::vector<Row> frame_rows{
    {"--size", "--size 40x30", "/width", 40},
    {"--size", "--size 40x30", "/height", 30},
    {"--alpha", "--alpha 0.35", "/alpha", 0.35},
    {"--up", "--up z", "/up", "z"},
    {"--blend", "--blend additive", "/blend", "additive"},
    {"--samples", "--samples 4", "/samples", 4},
    {"--lens", "--lens 0.1,inf", "/lens/radius", 0.1},
    {"--samples", "--samples exact", "/coverage", "exact"},
    {"--resolve", "--samples 4 --resolve sample", "/resolve", "sample"},
    {"--depth-range", "--samples 4 --depth-range", "/depth_range", true},
    {"--depth-scale", "--depth-scale reversed", "/depth_scale", "reversed"},
    {"--view", "--view 10,20.5", "/view", {10.0, 20.5}},
    {"--zoom", "--zoom 2.5", "/zoom", 2.5},
    {"--stereo", "--stereo 0.1", "/stereo", 0.1},
    {"--time", "--time 1.5", "/time_s", 1.5},
    {"--opaque-floor", "--opaque-floor", "/opaque_floor", true},
    {"--device", "--device D", "/device", "the device"},  // its name
};

const std::vector<Row> oit_rows{
    {"--method", "--method adaptive:16", "/method", "adaptive"},
    {"--method", "--method adaptive:16", "/size", 16},
    {"--layers", "--layers 8", "/layers", 8},
    {"--epsilon", "--epsilon 0.01", "/epsilon", 0.01},
    {"--format", "--format rgba8", "/format", "rgba8"},
    {"--reduce", "--reduce 2", "/reduce", 2},
    {"--lens-rays", "--lens 0.1,4 --lens-rays 8", "/lens_rays", 8},
    {"--memory", "--memory 64MiB", "/memory_bytes", 64 << 20},
    {"--budget", "--budget 40dB", "/budget/budget", "40dB"},
    {"--check-every", "--budget 40dB --until 2 --check-every 3", "/check_every", 3},
    {"--search-seconds", "--budget 40dB --search-seconds 2.5", "/search_seconds", 2.5},
    {"--strict", "--budget 40dB --strict", "/budget/strict", true},
    {"--until", "--until 2.5", "/until_s", 2.5},
    {"--turn", "--turn -90", "/turn_degrees", -90.0},
    {"--reference", "--reference", "/reference/fragments", 0},
    {"--write-reference", "--write-reference a.exr", "/files/write_reference", "a.exr"},
    {"--write-difference", "--write-difference a.pfm", "/files/write_difference", "a.pfm"},
    {"--heatmap", "--heatmap a.png", "/files/heatmap", "a.png"},
    {"--out", "--out caf\xE9.jpg", "/files/out", "caf\\xE9.jpg"},
    {"--json", "--json a.json", "/files/json", "a.json"},
    {"--frames", "--frames 7", "/frames", 7},
    {"--mpi", "--mpi", "/ranks", 1},  // before MPI says how many
};

const std::vector<Row> tradeoff_rows{
    {"--methods", "--methods weighted,linked", "/methods", {"linked", "weighted"}},
    {"--frames", "--frames 7", "/frames", 7},
    {"--heatmap", "--heatmap a.png", "/files/heatmap", "a.png"},
    {"--json", "--json a.json", "/files/json", "a.json"},
    {"--csv", "--csv a.csv", "/files/csv", "a.csv"},
    {"--html", "--html a.html", "/files/html", "a.html"},
};

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream in(text);
    std::vector<std::string> words{"program"};
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

// Calls parse(count, arguments).
auto parsed(const std::string& arguments, const auto& parse) {
    const std::vector<std::string> words = words_of(arguments);
    std::vector<const char*> pointers;
    for (const std::string& word : words) pointers.push_back(word.c_str());
    return parse(static_cast<int>(pointers.size()), pointers.data());
}

// The report of a run that has drawn nothing.
ordered_json oit_json(const std::string& arguments) {
    oit::Report report;
    report.options = parsed(arguments, oit::parse_options);
    report.device = "the device";
    report.times.add(std::vector<double>(report.options.frames, 1.0));
    if (report.options.reference) report.comparison.emplace();
    if (report.options.budget)
        report.choice = oit::Choice{.setting = oit::exact_setting(report.options.quality)};
    return ordered_json::parse(support::dump(to_json(report), 2));
}

ordered_json tradeoff_json(const std::string& arguments) {
    oit::Sweep sweep;
    sweep.options = parsed(arguments, oit::parse_tradeoff_options);
    sweep.device = "the device";
    sweep.frames = sweep.options.frames;
    sweep.measurements.push_back({.setting = oit::exact_setting({})});
    sweep.measurements.back().add({1});
    sweep.left_out.push_back({"method", "reason"});
    return ordered_json::parse(support::dump(to_json(sweep), 2));
}

std::set<std::string> options_in(const std::string& help) {
    std::set<std::string> options;
    const std::regex line("\n +(?:-[a-z],)?(--[a-z][a-z-]*)");
    for (std::sregex_iterator at(help.begin(), help.end(), line), end; at != end; ++at)
        options.insert((*at)[1]);
    options.erase("--help");
    options.erase("--version");
    return options;
}

void require_all_options(const std::string& help, std::vector<Row> rows, const auto& report_of) {
    rows.insert(rows.end(), frame_rows.begin(), frame_rows.end());
    std::set<std::string> known;
    for (const Row& row : rows) {
        INFO(row.arguments << ": " << row.key);
        known.insert(row.option);
        // --up is for files; options are read before their contents.
        const bool of_file = row.option == "--up";
        const ordered_json report =
            report_of((of_file ? CELLIST_FOG_PATH " " : "gearworks ") + row.arguments);
        CHECK(report["scene"] == (of_file ? "fog.cl" : "gearworks"));
        const ordered_json::json_pointer key(row.key);
        REQUIRE(report.contains(key));
        CHECK(report[key] == row.value);
        CHECK(report_of("gearworks").contains(ordered_json::json_pointer(row.key)) ==
              (!row.key.starts_with("/budget/") && !row.key.starts_with("/lens/") &&
               row.option != "--reference"));
    }
    // An option that is new has a row here, and so a key.
    CHECK(options_in(help) == known);
}

TEST_CASE("each option of cellist-oit has its key") {
    require_all_options(parsed("--help", oit::parse_options).help_text, oit_rows, oit_json);
}

TEST_CASE("each option of cellist-tradeoff has its key") {
    require_all_options(parsed("--help", oit::parse_tradeoff_options).help_text, tradeoff_rows,
                        tradeoff_json);
}

TEST_CASE("both programs have the same head") {
    const ordered_json a = oit_json("gearworks --view 1,2"),
                       b = tradeoff_json("gearworks --view 1,2");
    for (const char* key : {"schema", "version", "arguments", "scene", "width", "view", "alpha",
                            "device", "driver", "triangles", "fragments"}) {
        INFO(key);
        REQUIRE(a.contains(key));
        CHECK(b.contains(key));
    }
    CHECK(a["alpha"] == 0.35);
    CHECK(a["alpha"] == b["alpha"]);
    CHECK(a["arguments"] == ordered_json{"gearworks", "--view", "1,2"});
    const ordered_json& setting = b["settings"][0];
    for (const char* key :
         {"options", "method", "size", "layers", "epsilon", "format", "ms", "fastest_ms", "frames",
          "bytes", "psnr_db", "ssim", "max_abs_error", "pixels_over_1_255", "pixels_nan"}) {
        INFO(key);
        CHECK(a.contains(key));
        CHECK(setting.contains(key));
    }
}

TEST_CASE("the document has all keys") {
    std::set<std::string> keys;
    add_keys(oit_json("gearworks --budget 40dB --reference"), keys);
    add_keys(tradeoff_json("gearworks"), keys);
    CHECK(keys.size() > 60);
    const std::string text = read_file(CELLIST_JSON_DOCUMENT);
    for (const std::string& key : keys) {
        INFO(key);
        CHECK(contains(text, "`" + key + "`"));
    }
}

}  // namespace
}  // namespace cellist::test
