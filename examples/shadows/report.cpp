// SPDX-License-Identifier: MIT
#include "report.hpp"

#include <cmath>
#include <iomanip>
#include <ostream>

#include "files.hpp"
#include "json_report.hpp"
#include "number_text.hpp"
#include "stopwatch.hpp"

namespace shadows {
namespace {

using nlohmann::ordered_json;
using support::counted;
using support::fixed;
using support::grouped;

constexpr int schema = 1;

std::string percent(std::uint64_t part, std::uint64_t whole) {
    return fixed(100.0 * static_cast<double>(part) /
                     static_cast<double>(std::max<std::uint64_t>(1, whole)),
                 1) +
           " %";
}

std::string decibels(double psnr_db) {
    return std::isfinite(psnr_db) ? fixed(psnr_db, 1) + " dB" : "equal";
}

double pass_ms(const FrameReport& report, const std::string& name) {
    for (const auto& [pass, ms] : report.passes_ms)
        if (pass == name) return ms;
    return 0;
}

void print_accuracy(std::ostream& out, const Accuracy& accuracy) {
    const auto line = [&](const char* name) -> std::ostream& {
        return out << std::left << std::setw(12) << name;
    };
    line("visibility") << grouped(accuracy.rays_different) << " of "
                       << counted(accuracy.rays, "ray") << " differ from " << accuracy.visibility;
    if (accuracy.rays_decided > 0)
        out << "; exact tests decided for the device in " << grouped(accuracy.rays_decided);
    out << '\n';
    const auto difference = [&](const char* name, const support::ImageDifference& d) {
        line(name) << decibels(d.psnr_db) << ", largest error " << fixed(255 * d.max_abs_error, 2)
                   << " / 255";
        if (accuracy.all_pixels) out << ", SSIM " << fixed(d.ssim, 5);
        out << '\n';
    };
    difference("image", accuracy.picture);
    difference("buffer A", accuracy.a);
    difference("buffer B", accuracy.b);
    line("") << "  (against double precision, with B at full resolution and from all emitters)\n";
    line("too bright") << grouped(accuracy.leaks) << " of " << counted(accuracy.pixels, "pixel")
                       << " (" << percent(accuracy.leaks, accuracy.pixels) << ") by over 8 / 255\n";
    line("too dark") << grouped(accuracy.over_dark) << " of " << counted(accuracy.pixels, "pixel")
                     << " (" << percent(accuracy.over_dark, accuracy.pixels)
                     << ") by over 8 / 255\n";
}

ordered_json json_of(const support::ImageDifference& difference, bool is_whole) {
    return {{"psnr_db", support::finite_or_null(difference.psnr_db)},
            {"ssim", is_whole ? ordered_json(difference.ssim) : ordered_json(nullptr)},
            {"max_abs_error", difference.max_abs_error}};
}

ordered_json json_of(const Accuracy& accuracy) {
    return {{"visibility", accuracy.visibility},
            {"rays", accuracy.rays},
            {"rays_decided", accuracy.rays_decided},
            {"rays_different", accuracy.rays_different},
            {"pixels", accuracy.pixels},
            {"picture", json_of(accuracy.picture, accuracy.all_pixels)},
            {"a", json_of(accuracy.a, accuracy.all_pixels)},
            {"b", json_of(accuracy.b, accuracy.all_pixels)},
            {"visible_error", Accuracy::visible},
            {"pixels_too_bright", accuracy.leaks},
            {"pixels_too_dark", accuracy.over_dark}};
}

}  // namespace

void print(std::ostream& out, const FrameReport& report) {
    const auto line = [&](const char* name) -> std::ostream& {
        return out << std::left << std::setw(12) << name;
    };
    const Options& options = report.options;
    const Settings& settings = options.settings;
    line("device") << report.device << " (driver " << report.driver << ")\n";
    line("scene") << support::text_of(options.scene) << ", " << settings.width << " x "
                  << settings.height << ", " << counted(report.scene_triangles, "triangle") << ", "
                  << grouped(report.blockers) << " of blockers\n";
    line("grid") << report.cells.extent[0] << " x " << report.cells.extent[1] << " x "
                 << report.cells.extent[2] << " cells, " << grouped(report.lengths.total)
                 << (report.lengths.total == 1 ? " entry" : " entries") << ", longest list "
                 << grouped(report.lengths.longest) << '\n';
    const double trace_ms = pass_ms(report, "trace");
    line("rays") << grouped(report.counts.rays) << ", " << grouped(report.counts.blocked)
                 << " blocked (" << percent(report.counts.blocked, report.counts.rays) << ")";
    if (trace_ms > 0)
        out << ", " << fixed(static_cast<double>(report.counts.rays) / trace_ms * 1e-3, 1)
            << " million a second";
    out << '\n';
    line("memory") << support::megabytes(report.device_bytes) << " MB on the device\n";
    for (const auto& [pass, ms] : report.passes_ms)
        line(("  " + pass).c_str()) << std::right << std::setw(9) << fixed(ms, 2) << " ms\n";
    const double ms = support::median(report.frames_ms);
    line("frame") << std::right << std::setw(9) << fixed(ms, 2) << " ms, " << fixed(1000 / ms, 1)
                  << " a second (median of " << counted(report.frames_ms.size(), "frame") << ")\n";
    if (report.most_passed)
        line("heat map") << grouped(*report.most_passed)
                         << " entries at most on a ray from the eye\n";
    if (report.accuracy) print_accuracy(out, *report.accuracy);
}

ordered_json scene_json(const Options& options, const std::string& device,
                        const std::string& driver) {
    ordered_json json = support::report_head(schema, "cellist-shadows", options.arguments);
    json["scene"] = support::text_of(options.scene);
    json["swarm_triangles"] =
        options.scene == "swarm" ? ordered_json(options.triangles) : ordered_json(nullptr);
    json["light"] = options.parallel_light ? "directional" : "spot";
    json["light_position"] = nullptr;
    if (const auto& at = options.light_position) json["light_position"] = {at->x, at->y, at->z};
    json["time_step_s"] = options.time_step;
    json["device"] = device;
    json["driver"] = driver;
    return json;
}

ordered_json settings_json(const Settings& settings) {
    return {{"width", settings.width},
            {"height", settings.height},
            {"rsm", settings.rsm},
            {"samples", settings.samples},
            {"reduce", settings.reduce},
            {"interleave", settings.interleave},
            {"grid", settings.grid > 0 ? ordered_json(settings.grid) : ordered_json("auto")},
            {"simplify",
             settings.simplify > 0 ? ordered_json(settings.simplify) : ordered_json(nullptr)},
            {"storage", name_of(settings.storage)}};
}

ordered_json to_json(const FrameReport& report) {
    const Options& options = report.options;
    ordered_json json = scene_json(options, report.device, report.driver);
    json.update(settings_json(options.settings));
    json["ms"] = support::median(report.frames_ms);
    json["frames_ms"] = report.frames_ms;
    json["passes_ms"] = ordered_json::object();
    for (const auto& [pass, ms] : report.passes_ms) json["passes_ms"][pass] = ms;
    json["rays"] = report.counts.rays;
    json["rays_blocked"] = report.counts.blocked;
    json["triangles"] = report.scene_triangles;
    json["blockers"] = report.blockers;
    json["cells"] = report.cells.extent;
    json["entries"] = report.lengths.total;
    json["cells_nonempty"] = report.lengths.nonempty_cells;
    json["longest_list"] = report.lengths.longest;
    json["device_bytes"] = report.device_bytes;
    json["most_entries_passed"] =
        report.most_passed ? ordered_json(*report.most_passed) : ordered_json(nullptr);
    json["reference"] = report.accuracy ? json_of(*report.accuracy) : ordered_json(nullptr);
    json["files"] = {{"out", support::file_or_null(options.out.path())},
                     {"out_unblocked", support::file_or_null(options.out_unblocked)},
                     {"out_a", support::file_or_null(options.out_a)},
                     {"out_b", support::file_or_null(options.out_b)},
                     {"heatmap", support::file_or_null(options.heatmap)},
                     {"out_error", support::file_or_null(options.out_error)},
                     {"json", support::file_or_null(options.json)}};
    return json;
}

}  // namespace shadows
