// SPDX-License-Identifier: MIT
#include "tradeoff/metrics.hpp"

#include <cmath>
#include <iomanip>
#include <ostream>
#include <string>

#include "json_report.hpp"
#include "number_text.hpp"
#include "report/frame_json.hpp"

namespace oit {
namespace {

using nlohmann::ordered_json;

std::string decibels(double psnr_db) {
    return std::isfinite(psnr_db) ? support::fixed(psnr_db, 1) : "equal";
}

void print_settings(const Sweep& sweep, std::ostream& out) {
    const std::vector<bool> front = pareto_front(sweep.measurements);
    out << "\n   " << std::setw(9) << "ms" << std::setw(6) << "+-%" << std::setw(9) << "MB"
        << std::setw(9) << "PSNR dB" << std::setw(9) << "SSIM" << std::setw(11) << "error/255"
        << "  setting\n";
    for (std::size_t i = 0; i < sweep.measurements.size(); ++i) {
        const Measurement& m = sweep.measurements[i];
        out << (front[i] ? " * " : "   ");
        if (m.drawn())
            out << std::setw(9) << support::fixed(m.milliseconds, 2) << std::setw(6)
                << support::fixed(100 * m.spread(), 1) << std::setw(9)
                << support::megabytes(m.bytes) << std::setw(9) << decibels(m.comparison.psnr_db)
                << std::setw(9) << support::fixed(m.comparison.ssim, 5) << std::setw(11)
                << support::fixed(255 * m.comparison.max_abs_error, 3) << "  " << text(m.setting)
                << '\n';
        else
            out << std::setw(9) << "-" << std::setw(46) << ""
                << "  " << text(m.setting) << ": " << m.failure << '\n';
    }
    const double equal = equally_fast - 1, spread = typical_spread(sweep.measurements);
    out << " * no other setting is both as fast (within " << support::fixed(100 * equal, 0)
        << " % or with overlapping spreads) and as accurate\n"
           "   error: the largest of any channel\n"
           " +-%: half of the frames differ from the median by no more\n";
    if (spread > equal)
        out << " The times are uncertain: half of the settings have a spread of "
            << support::fixed(100 * spread, 0) << " % or more. Ignore smaller differences.\n";
}

std::string quartiles(const Relation& relation) {
    return support::fixed(relation.least, 2) + " to " + support::fixed(relation.most, 2);
}

// What a factor is worth.
std::string unresolved(const Relation& relation) {
    return relation.is_distinct ? "" : "  not significant: the spreads overlap";
}

void print_fewer_layers(const Sweep& sweep, std::ostream& out) {
    const std::vector<Relation> relations = fewer_layers(sweep);
    if (relations.empty()) return;
    out << "\nNearest layers against all " << sweep.most_layers
        << "\n     layers  speed-up      by quartiles  PSNR dB\n";
    for (const Relation& relation : relations)
        out << std::setw(11) << *relation.measurement->setting.quality.layers << std::setw(10)
            << support::fixed(relation.factor, 2) << std::setw(18) << quartiles(relation)
            << std::setw(9) << decibels(relation.measurement->comparison.psnr_db)
            << unresolved(relation) << '\n';
}

void print_exact_methods(const Sweep& sweep, std::ostream& out) {
    const std::vector<Relation> relations = exact_methods(sweep);
    if (relations.size() < 2) return;
    out << "\nExact methods against linked, nodes of floats\n"
           "         ms  times as long      by quartiles\n";
    for (const Relation& relation : relations) {
        const Measurement& m = *relation.measurement;
        out << std::setw(11) << support::fixed(m.milliseconds, 2) << std::setw(15)
            << support::fixed(relation.factor, 2) << std::setw(18) << quartiles(relation) << "  "
            << m.setting.method->name
            << (m.setting.method->name == "linked" ? "" : unresolved(relation)) << '\n';
    }
}

ordered_json to_json(const Measurement& m, bool on_front) {
    ordered_json json = json_of(m.setting);
    if (!m.drawn()) {
        json["failure"] = m.failure;
        return json;
    }
    json.update(times_json(m));
    json["bytes"] = m.bytes;
    json.update(json_of(m.comparison));
    json["pareto"] = on_front;
    return json;
}

}  // namespace

void print(const Sweep& sweep, std::ostream& out) {
    const FrameOptions& options = sweep.options;
    out << "cellist-tradeoff " << sweep.scene_name() << ", " << options.width << 'x'
        << options.height << (options.eye_separation ? ", two eyes" : "") << ", "
        << support::grouped(sweep.triangles) << " triangles, " << support::grouped(sweep.fragments)
        << " fragments, up to " << sweep.most_layers << " in a pixel\n"
        << "  " << sweep.device << " (driver " << sweep.driver << "), median of " << sweep.frames
        << " frames\n";
    print_settings(sweep, out);
    print_fewer_layers(sweep, out);
    print_exact_methods(sweep, out);
    if (!sweep.left_out.empty()) out << "\nLeft out\n";
    for (const auto& [method, reason] : sweep.left_out)
        out << "  " << method << ": " << reason << '\n';
}

ordered_json to_json(const Sweep& sweep) {
    const TradeoffOptions& options = sweep.options;
    ordered_json json = json_of(options, "cellist-tradeoff");
    json["device"] = sweep.device;
    json["driver"] = sweep.driver;
    json["methods"] = options.methods;
    json["files"] = {{"heatmap", support::file_or_null(options.heatmap)},
                     {"json", support::file_or_null(options.json)},
                     {"csv", support::file_or_null(options.csv)},
                     {"html", support::file_or_null(options.html)}};
    json["reference_views"] = sweep.reference_views;
    json["lens_rays"] = options.quality.lens_rays;
    json["triangles"] = sweep.triangles;
    json["fragments"] = sweep.fragments;
    json["most_layers"] = sweep.most_layers;
    json["pixels_by_layers"] = sweep.pixels_by_layers;
    json["frames"] = sweep.frames;
    json["equally_fast"] = equally_fast;
    json["typical_spread"] = typical_spread(sweep.measurements);
    const std::vector<bool> front = pareto_front(sweep.measurements);
    json["settings"] = ordered_json::array();
    for (std::size_t i = 0; i < sweep.measurements.size(); ++i)
        json["settings"].push_back(to_json(sweep.measurements[i], front[i]));
    json["fewer_layers"] = ordered_json::array();
    for (const auto& [m, factor, least, most, is_distinct] : fewer_layers(sweep))
        json["fewer_layers"].push_back({{"layers", *m->setting.quality.layers},
                                        {"ms", m->milliseconds},
                                        {"speed_up", factor},
                                        {"speed_up_least", least},
                                        {"speed_up_most", most},
                                        {"distinct", is_distinct},
                                        {"psnr_db", support::finite_or_null(m->comparison.psnr_db)},
                                        {"ssim", m->comparison.ssim}});
    json["exact_methods"] = ordered_json::array();
    for (const auto& [m, factor, least, most, is_distinct] : exact_methods(sweep))
        json["exact_methods"].push_back({{"method", m->setting.method->name},
                                         {"ms", m->milliseconds},
                                         {"times_linked", factor},
                                         {"times_linked_least", least},
                                         {"times_linked_most", most},
                                         {"distinct", is_distinct},
                                         {"bytes", m->bytes}});
    json["left_out"] = ordered_json::array();
    for (const auto& [method, reason] : sweep.left_out)
        json["left_out"].push_back({{"method", method}, {"reason", reason}});
    return json;
}

std::string to_csv(const Sweep& sweep) {
    constexpr const char* names[] = {"options",
                                     "method",
                                     "size",
                                     "layers",
                                     "epsilon",
                                     "lens_rays",
                                     "format",
                                     "samples",
                                     "coverage",
                                     "ms",
                                     "fastest_ms",
                                     "lower_quartile_ms",
                                     "upper_quartile_ms",
                                     "bytes",
                                     "psnr_db",
                                     "ssim",
                                     "max_abs_error",
                                     "pixels_over_1_255",
                                     "pareto",
                                     "failure"};
    return support::csv(names, to_json(sweep)["settings"]);
}

}  // namespace oit
