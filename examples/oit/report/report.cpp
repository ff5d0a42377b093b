// SPDX-License-Identifier: MIT
#include "report/report.hpp"

#include <functional>
#include <iomanip>
#include <ostream>

#include <nlohmann/json.hpp>

#include "budget/setting.hpp"
#include "files.hpp"
#include "json_report.hpp"
#include "number_text.hpp"
#include "report/frame_json.hpp"

namespace oit {
namespace {

// What a blend that ends early leaves out, at most: each channel, linear. What is added on top of
// what passes is not bounded by it.
std::string early_end_text(const Report& report) {
    const double bound = static_cast<double>(report.options.quality.epsilon) *
                         static_cast<double>(report.colour_max);
    return "linear colours off by " + support::fixed(255 * bound, 4) + " / 255 at most";
}

std::string nearest_text(std::uint32_t layers) {
    return "the " + support::counted(layers, "nearest layer");
}

using Line = std::function<std::ostream&(const std::string& name)>;

// How far off the picture is; and where only the nearest layers were asked for, how far from what
// these make.
void print_comparison(const Report& report, const Line& line) {
    const Comparison& c = *report.comparison;
    line("PSNR") << support::fixed(c.psnr_db, 1) << " dB against "
                 << (report.reference_views > 0
                         ? "the mean of " + support::grouped(report.reference_views) + " pictures"
                         : "all layers in double precision")
                 << '\n';
    if (report.nearest_comparison)
        line("") << support::fixed(report.nearest_comparison->psnr_db, 1) << " dB against "
                 << nearest_text(*report.options.quality.layers) << " in double precision\n";
    line("SSIM") << support::fixed(c.ssim, 6) << '\n';
    line("largest error") << support::fixed(255 * c.max_abs_error, 4) << " / 255\n";
    line("over 1/255") << support::grouped(c.pixels_over) << " of "
                       << support::counted(c.pixels, "pixel") << ", "
                       << support::grouped(c.pixels_explained)
                       << " explained by depths closer than 2^-20 of each other\n";
    if (report.reference_views > 0) return;
    if (!c.has_depths) {
        line("counts, depths") << "not compared: "
                               << (report.blends_slices ? "lists exist one slice at a time"
                                                        : "the method does not keep all fragments")
                               << '\n';
        return;
    }
    line("fragment counts") << (c.pixels_with_other_count == 0
                                    ? std::string("equal in every pixel")
                                    : "differ in " +
                                          support::counted(c.pixels_with_other_count, "pixel") +
                                          ", reference has " + support::grouped(c.fragments) +
                                          " in all")
                            << '\n';
    line("depth error") << support::fixed(c.max_depth_error * (1 << 24), 2) << " * 2^-24 at most"
                        << (has_float_depth(report.options.quality.format) ? " (bound: 8)" : "")
                        << '\n';
}

void print_method(const Report& report, const Line& line) {
    const Options& options = report.options;
    line("method")
        << method_text({&method_named(options.method), options.quality}) << ", "
        << (report.node_bytes ? "nodes of " + std::to_string(*report.node_bytes) + " bytes, " : "")
        << (options.quality.coverage == Coverage::exact
                ? "exact coverage"
                : support::counted(static_cast<std::uint64_t>(options.quality.samples), "sample") +
                      " a pixel")
        << '\n';
    if (options.lens)
        line("lens") << "radius " << support::shortest(options.lens->radius) << ", focus "
                     << support::shortest(options.lens->focus) << '\n';
    if (options.quality.reduce > 1)
        line("reduced") << "transparent surfaces drawn with " << options.quality.reduce
                        << " times fewer pixels a side\n";
}

void print_fragments(const Report& report, const Line& line) {
    line("triangles") << support::grouped(report.triangles) << support::dropped_text(report.drops)
                      << '\n';
    std::uint64_t textures = 0;
    for (const SceneMesh& mesh : report.meshes) textures += mesh.ignored_textures;
    if (textures > 0) line("ignored") << support::counted(textures, "texture") << '\n';
    if (!report.lengths) {
        // A choice says how many there are.
        if (!report.choice)
            line("fragments") << "not counted: the method does not keep all of them\n";
        return;
    }
    line("fragments") << support::grouped(report.lengths->total) << '\n';
    line("non-empty pixels") << support::grouped(report.lengths->nonempty_cells) << '\n';
    line("longest list") << support::grouped(report.lengths->longest) << '\n';
}

void print_memory(const Report& report, const Line& line) {
    line("memory") << support::megabytes(report.method_bytes) << " MB of the method, "
                   << support::megabytes(report.device_bytes) << " MB in all\n";
    if (report.options.memory_bytes)
        line("slices") << report.slices << ", " << support::grouped(report.method_bytes) << " of "
                       << support::grouped(*report.options.memory_bytes) << " bytes used\n";
}

void print_times(const Report& report, const Line& line) {
    const PassTimes& passes = report.passes;
    line("transform") << support::fixed(passes.transform_ms, 2) << " ms\n";
    if (report.blends_slices) {
        line("insert to blend") << support::fixed(passes.raster_insert_ms, 2)
                                << " ms, slice by slice\n";
    } else {
        line("raster + insert") << support::fixed(passes.raster_insert_ms, 2) << " ms\n";
        line("sort + blend") << support::fixed(passes.sort_blend_ms, 2) << " ms\n";
    }
    line("frame") << support::fixed(report.times.milliseconds, 2) << " ms (median of "
                  << report.options.frames << ")\n";
}

nlohmann::ordered_json meshes_json(const Report& report) {
    auto meshes = nlohmann::ordered_json::array();
    for (const SceneMesh& mesh : report.meshes) {
        meshes.push_back({{"file", support::text_of(std::filesystem::path(mesh.file).filename())},
                          {"alpha", nullptr},
                          {"triangles", mesh.triangles},
                          {"ignored_textures", mesh.ignored_textures}});
        if (mesh.alpha) meshes.back()["alpha"] = *mesh.alpha;
    }
    return meshes;
}

// Where the pictures are, as on the command line.
void print_files(const Options& options, const Line& line) {
    const auto file = [&](const std::string& name, const std::filesystem::path& path) {
        if (path.empty()) return;
        line(name) << (support::is_standard_output(path) ? "on stdout" : support::text_of(path))
                   << '\n';
    };
    file(options.out.has_number() ? "pictures" : "picture",
         options.out.has_number() ? options.out.path() : options.out.of(1));
    file("reference", options.write_reference);
    file("difference", options.write_difference);
    file("heat map", options.heatmap);
}

nlohmann::ordered_json passes_json(const Report& report) {
    const PassTimes& passes = report.passes;
    nlohmann::ordered_json json{{"transform", passes.transform_ms},
                                {"raster_insert", nullptr},
                                {"sort_blend", nullptr},
                                {"slices", nullptr}};
    if (report.blends_slices) {
        json["slices"] = passes.raster_insert_ms;
    } else {
        json["raster_insert"] = passes.raster_insert_ms;
        json["sort_blend"] = passes.sort_blend_ms;
    }
    return json;
}

nlohmann::ordered_json dropped_json(const support::MeshDrops& drops) {
    return {{"nonfinite_vertices", drops.nonfinite_vertices},
            {"nonfinite_triangles", drops.nonfinite_triangles},
            {"out_of_range_triangles", drops.out_of_range_triangles},
            {"degenerate_triangles", drops.degenerate_triangles},
            {"unsplit_polygons", drops.unsplit_polygons},
            {"points_and_lines", drops.points_and_lines},
            {"bytes_after_end", drops.bytes_after_end}};
}

nlohmann::ordered_json reference_json(const Comparison& comparison, std::size_t views) {
    return {{"views", views},
            {"fragments", comparison.fragments},
            {"pixels_ambiguous", comparison.pixels_ambiguous},
            {"pixels_with_other_count", comparison.pixels_with_other_count},
            {"max_depth_error", comparison.max_depth_error}};
}

nlohmann::ordered_json files_json(const Options& options) {
    return {{"out", support::file_or_null(options.out.path())},
            {"write_reference", support::file_or_null(options.write_reference)},
            {"write_difference", support::file_or_null(options.write_difference)},
            {"heatmap", support::file_or_null(options.heatmap)},
            {"json", support::file_or_null(options.json)}};
}

// Of what is not there, for whoever reads the file as a table.
constexpr const char* compared[] = {"psnr_db", "ssim", "max_abs_error", "pixels_over_1_255",
                                    "pixels_explained"};

}  // namespace

void print(const Report& report, std::ostream& out) {
    const Line line = [&out](const std::string& name) -> std::ostream& {
        return out << "  " << std::left << std::setw(18) << name << std::right;
    };
    const Options& options = report.options;
    out << "cellist-oit " << title_of(options) << ", " << options.width << 'x' << options.height
        << ", alpha " << options.alpha << ", "
        << (options.quality.layers ? nearest_text(*options.quality.layers) : "all layers")
        << (options.opaque_floor ? ", opaque floor" : "") << '\n';
    line("device") << report.device << " (driver " << report.driver << ")\n";
    if (options.mpi) line("ranks") << options.share.count << '\n';
    print_method(report, line);
    print_fragments(report, line);
    print_memory(report, line);
    print_times(report, line);
    // A choice has a narrower bound of what the early end leaves out.
    if (report.choice)
        print(*report.choice, *options.budget, report.record, out);
    else if (options.quality.epsilon > 0)
        line("early end") << early_end_text(report) << '\n';
    if (report.pixels_nan > 0)
        line("NaN") << support::counted(report.pixels_nan, "pixel") << ", drawn black\n";
    if (report.comparison) print_comparison(report, line);
    for (const SceneMesh& mesh : report.meshes) {
        for (const std::string& note : mesh.notes) line("note") << note << '\n';
        if (mesh.ends_within_line)
            line("note") << "the mesh file "
                         << (report.meshes.size() > 1 ? "'" + mesh.file + "' " : "")
                         << "ends within a line: it may have been cut off\n";
    }
    print_files(options, line);
}

nlohmann::ordered_json to_json(const Report& report) {
    const Options& options = report.options;
    nlohmann::ordered_json json = json_of(options, "cellist-oit");
    json["device"] = report.device;
    json["driver"] = report.driver;
    json["until_s"] = nullptr;
    if (options.until) json["until_s"] = *options.until;
    json["turn_degrees"] = options.turn_degrees;
    json["files"] = files_json(options);
    json.update(json_of(Setting{&method_named(options.method), options.quality}));
    json["reduce"] = options.quality.reduce;
    json["memory_bytes"] = nullptr;
    if (options.memory_bytes) json["memory_bytes"] = *options.memory_bytes;
    json["ranks"] = nullptr;
    if (options.mpi) json["ranks"] = options.share.count;
    json["triangles"] = report.triangles;
    json["dropped"] = dropped_json(report.drops);
    json["meshes"] = meshes_json(report);
    for (const char* of_lists : {"fragments", "cells_nonempty", "longest_list", "node_bytes"})
        json[of_lists] = nullptr;
    if (report.lengths) {
        json["fragments"] = report.lengths->total;
        json["cells_nonempty"] = report.lengths->nonempty_cells;
        json["longest_list"] = report.lengths->longest;
    }
    if (report.node_bytes) json["node_bytes"] = *report.node_bytes;
    json["bytes"] = report.method_bytes;
    json["device_bytes"] = report.device_bytes;
    json["peak_bytes"] = report.peak_bytes;
    json["slices"] = report.slices;
    json.update(times_json(report.times));
    json["frames_ms"] = report.times.times;
    json["passes_ms"] = passes_json(report);
    json["check_every"] = nullptr;
    json["search_seconds"] = nullptr;
    json["budget"] = nullptr;
    if (report.choice) {
        json["check_every"] = options.check_every;
        json["search_seconds"] = options.search_seconds;
        json["budget"] = json_of(*report.choice, *options.budget, report.record);
    }
    for (const char* name : compared) json[name] = nullptr;
    json["reference"] = nullptr;
    if (report.comparison) {
        json.update(json_of(*report.comparison));
        json["reference"] = reference_json(*report.comparison, report.reference_views);
    }
    json["pixels_nan"] = report.pixels_nan;
    json["nearest_layers"] = nullptr;
    if (report.nearest_comparison) json["nearest_layers"] = json_of(*report.nearest_comparison);
    return json;
}

}  // namespace oit
