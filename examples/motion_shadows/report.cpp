// SPDX-License-Identifier: MIT
#include "report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <ostream>

#include "files.hpp"
#include "json_report.hpp"
#include "number_text.hpp"
#include "stopwatch.hpp"

namespace motion {
namespace {

using nlohmann::ordered_json;
using support::counted;
using support::fixed;
using support::grouped;

constexpr int schema = 1;

std::uint64_t tsm_bytes(const Report& report, const Measurement& m) {
    return 4 * std::uint64_t{m.samples} * report.texels();
}

bool has_ranges(const Measurement& m) { return m.size.ranges > 0; }

// The passes that make the shadow map: all but those that every method has.
double shadow_map_ms(const Measurement& m) {
    constexpr std::array<std::string_view, 4> others{"project", "visible", "test", "shade"};
    double sum = 0;
    for (const auto& [pass, ms] : m.passes_ms)
        if (std::ranges::find(others, pass) == others.end()) sum += ms;
    return sum;
}

double pass_ms(const Measurement& m, std::string_view name) {
    for (const auto& [pass, ms] : m.passes_ms)
        if (pass == name) return ms;
    return 0;
}

std::string decibels(double psnr_db) {
    return std::isfinite(psnr_db) ? fixed(psnr_db, 1) : "equal";
}

std::string method_text(const Measurement& m) {
    return std::string(m.method) + ", " +
           counted(m.samples, m.method == reference_name ? "moment" : "sample") +
           (m.method == reference_name ? "" : " a pixel");
}

// ---- one method

void print_one(std::ostream& out, const Report& report, const Measurement& m) {
    const auto line = [&](const std::string& name) -> std::ostream& {
        return out << "  " << std::left << std::setw(12) << name << std::right;
    };
    out << method_text(m) << '\n';
    for (const auto& [pass, ms] : m.passes_ms)
        line(pass) << std::setw(9) << fixed(ms, 2) << " ms\n";
    const double ms = support::median(m.frames_ms);
    line("frame") << std::setw(9) << fixed(ms, 2) << " ms, " << fixed(1000 / ms, 1)
                  << " a second (median of " << counted(m.frames_ms.size(), "frame") << ")\n";
    if (m.method == reference_name) return;
    if (has_ranges(m)) {
        line("ranges") << grouped(m.size.ranges);
        if (m.size.fragments > 0)
            out << " of " << counted(m.size.fragments, "fragment") << ", "
                << grouped(m.size.unpaired) << " without a partner";
        if (m.size.pieces > 0) out << "; " << grouped(m.size.pieces) << " after compression";
        if (m.size.slices > 0) out << "; in " << counted(m.size.slices, "slice");
        out << "; " << name_of(m.storage) << " lists\n";
    }
    if (m.size.refused > 0)
        line("left out") << counted(m.size.refused, "triangle") << " with NaN or infinity\n";
    line("memory") << support::megabytes(m.size.bytes) << " MB; the paper's Equation 2: "
                   << support::megabytes(report.paper.bytes(report.texels()))
                   << " MB; a time-dependent shadow map: "
                   << support::megabytes(tsm_bytes(report, m)) << " MB\n";
    if (!m.comparison) return;
    line("error") << decibels(m.comparison->picture.psnr_db) << " dB, SSIM "
                  << fixed(m.comparison->picture.ssim, 4) << '\n';
    line("acne") << grouped(m.comparison->self_shadowing.self_shadowed) << " of "
                 << counted(m.comparison->self_shadowing.lit, "lit pixel")
                 << " darker than chance allows\n";
}

// ---- several methods

struct Column {
    const char* name;
    int width;
    std::string (*text)(const Measurement&);
};

std::string ms_text(double ms) { return fixed(ms, 2); }

constexpr Column columns[] = {
    {"method", -11, [](const Measurement& m) { return std::string(m.method); }},
    {"samples", 8, [](const Measurement& m) { return grouped(m.samples); }},
    {"ms a frame", 12, [](const Measurement& m) { return ms_text(support::median(m.frames_ms)); }},
    {"visible", 10,
     [](const Measurement& m) { return ms_text(pass_ms(m, "project") + pass_ms(m, "visible")); }},
    {"map", 10, [](const Measurement& m) { return ms_text(shadow_map_ms(m)); }},
    {"test", 10, [](const Measurement& m) { return ms_text(pass_ms(m, "test")); }},
    {"shade", 9, [](const Measurement& m) { return ms_text(pass_ms(m, "shade")); }},
    {"MB", 9, [](const Measurement& m) { return support::megabytes(m.size.bytes); }},
    {"dB", 7,
     [](const Measurement& m) {
         return m.comparison ? decibels(m.comparison->picture.psnr_db) : std::string("-");
     }},
    {"SSIM", 8,
     [](const Measurement& m) {
         return m.comparison ? fixed(m.comparison->picture.ssim, 4) : std::string("-");
     }},
    {"acne", 9,
     [](const Measurement& m) {
         return m.comparison ? grouped(m.comparison->self_shadowing.self_shadowed)
                             : std::string("-");
     }},
};

void print_table(std::ostream& out, const Report& report) {
    const auto cell = [&](const Column& column, const std::string& text) {
        out << (column.width < 0 ? std::left : std::right) << std::setw(std::abs(column.width))
            << text;
    };
    for (const Column& column : columns) cell(column, column.name);
    out << '\n';
    for (const Measurement& m : report.measurements) {
        for (const Column& column : columns) cell(column, column.text(m));
        out << '\n';
    }
    out << "Equation 2 of the paper: " << support::megabytes(report.paper.bytes(report.texels()))
        << " MB. ";
    if (const Measurement* reference = report.reference())
        out << "dB, SSIM: against " << method_text(*reference) << ".\n";
    else
        out << "--reference compares the pictures.\n";
    const auto compared = std::ranges::find_if(
        report.measurements, [](const Measurement& m) { return m.comparison.has_value(); });
    if (compared != report.measurements.end())
        out << "acne: pixels darker than chance allows, of "
            << grouped(compared->comparison->self_shadowing.lit) << " that should be lit.\n";
}

// ---- JSON

ordered_json json_of(const Report& report, const Measurement& m) {
    ordered_json json{{"method", m.method},
                      {"samples", m.samples},
                      {"ms", support::median(m.frames_ms)},
                      {"frames_ms", m.frames_ms},
                      {"passes_ms", ordered_json::object()}};
    for (const auto& [pass, ms] : m.passes_ms) json["passes_ms"][pass] = ms;
    json["shadow_map_ms"] = shadow_map_ms(m);
    json["storage"] = has_ranges(m) ? ordered_json(name_of(m.storage)) : ordered_json(nullptr);
    json["fragments"] = m.size.fragments;
    json["fragments_unpaired"] = m.size.unpaired;
    json["ranges"] = m.size.ranges;
    json["pieces"] = m.size.pieces;
    json["slices"] = m.size.slices;
    json["triangles_refused"] = m.size.refused;
    json["bytes"] = m.size.bytes;
    json["tsm_bytes"] =
        m.method == reference_name ? ordered_json(nullptr) : ordered_json(tsm_bytes(report, m));
    const auto& c = m.comparison;
    json["psnr_db"] = c ? support::finite_or_null(c->picture.psnr_db) : ordered_json(nullptr);
    json["ssim"] = c ? ordered_json(c->picture.ssim) : ordered_json(nullptr);
    json["max_abs_error"] = c ? ordered_json(c->picture.max_abs_error) : ordered_json(nullptr);
    json["pixels_lit"] = c ? ordered_json(c->self_shadowing.lit) : ordered_json(nullptr);
    json["pixels_self_shadowed"] =
        c ? ordered_json(c->self_shadowing.self_shadowed) : ordered_json(nullptr);
    return json;
}

}  // namespace

std::uint64_t Report::texels() const {
    const auto side = static_cast<std::uint64_t>(options.settings.shadow_map);
    return side * side;
}

const Measurement* Report::reference() const {
    const bool is_first = !measurements.empty() && measurements[0].method == reference_name;
    return is_first ? measurements.data() : nullptr;
}

void print(std::ostream& out, const Report& report) {
    const Options& options = report.options;
    const Settings& settings = options.settings;
    out << support::text_of(options.scene) << ": " << counted(report.triangles, "triangle") << ", "
        << settings.width << " x " << settings.height << ", shadow map of " << settings.shadow_map
        << " x " << settings.shadow_map << ", " << report.device << " (driver " << report.driver
        << ")\n";
    if (options.method == "all")
        print_table(out, report);
    else
        for (const Measurement& m : report.measurements) print_one(out, report, m);
}

ordered_json to_json(const Report& report) {
    const Options& options = report.options;
    const Settings& settings = options.settings;
    ordered_json json = support::report_head(schema, "cellist-motion-shadows", options.arguments);
    json["scene"] = support::text_of(options.scene);
    json["triangles"] = report.triangles;
    const glm::dvec3& move = options.motion.move;
    json["move"] = {move.x, move.y, move.z};
    json["spin_degrees"] = options.motion.spin_degrees;
    json["exposure"] = options.exposure;
    json["light"] = options.parallel_light ? "directional" : "spot";
    json["device"] = report.device;
    json["driver"] = report.driver;
    json["width"] = settings.width;
    json["height"] = settings.height;
    json["shadow_map"] = settings.shadow_map;
    json["bias"] = settings.bias;
    json["prepass"] = settings.prepass;
    json["insides"] = settings.insides;
    json["compress"] = settings.compress;
    json["tolerance"] = settings.tolerance;
    json["memory"] = settings.budget_bytes == no_budget ? ordered_json(nullptr)
                                                        : ordered_json(settings.budget_bytes);
    json["whole_ranges"] = report.paper.ranges;
    json["whole_fragments"] = report.paper.fragments;
    json["equation_2_bytes"] = report.paper.bytes(report.texels());
    json["methods"] = ordered_json::array();
    for (const Measurement& m : report.measurements) json["methods"].push_back(json_of(report, m));
    json["files"] = {{"out", support::file_or_null(options.trade ? "" : options.out)},
                     {"out_shadow", support::file_or_null(options.out_shadow)},
                     {"out_difference", support::file_or_null(options.out_difference)},
                     {"out_reference", support::file_or_null(options.out_reference)},
                     {"json", support::file_or_null(options.json)},
                     {"csv", support::file_or_null(options.csv)},
                     {"html", support::file_or_null(options.html)}};
    return json;
}

std::string to_csv(const Report& report) {
    constexpr const char* names[] = {"method",        "samples",    "ms",
                                     "shadow_map_ms", "fragments",  "ranges",
                                     "pieces",        "slices",     "bytes",
                                     "tsm_bytes",     "psnr_db",    "ssim",
                                     "max_abs_error", "pixels_lit", "pixels_self_shadowed"};
    return support::csv(names, to_json(report)["methods"]);
}

}  // namespace motion
