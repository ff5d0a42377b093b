#include "report.hpp"

#include <cmath>
#include <fstream>
#include <functional>
#include <iomanip>
#include <ostream>

#include <nlohmann/json.hpp>

#include "input_error.hpp"
#include "number_text.hpp"
#include "setting.hpp"

namespace oit {
namespace {

nlohmann::ordered_json finite_or_null(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

// What a blend that ends early leaves out, at most: each channel, linear. What is added on top of
// what passes is not bounded by it.
std::string early_end_text(const Report& report) {
    const double bound = static_cast<double>(report.options.quality.epsilon) *
                         static_cast<double>(report.colour_max);
    return "linear colours off by " + fixed(255 * bound, 4) + " / 255 at most";
}

std::string nearest_text(std::uint32_t layers) { return "the " + counted(layers, "nearest layer"); }

using Line = std::function<std::ostream&(const std::string& name)>;

// How far off the picture is; and where only the nearest layers were asked for, how far from what
// these make.
void print_comparison(const Report& report, const Line& line) {
    const Comparison& c = *report.comparison;
    line("PSNR") << fixed(c.psnr_db, 1) << " dB against all layers in double precision\n";
    if (report.nearest_comparison)
        line("") << fixed(report.nearest_comparison->psnr_db, 1) << " dB against "
                 << nearest_text(*report.options.quality.layers) << " in double precision\n";
    line("SSIM") << fixed(c.ssim, 6) << '\n';
    line("largest error") << fixed(255 * c.max_abs_error, 4) << " / 255\n";
    line("over 1/255") << grouped(c.pixels_over) << " of " << counted(c.pixels, "pixel") << ", "
                       << grouped(c.pixels_explained)
                       << " explained by depths closer than 2^-20 of each other\n";
    if (!c.has_depths) {
        line("counts, depths") << "not compared: "
                               << (report.blends_slices ? "lists are there a slice at a time"
                                                        : "the method does not keep all fragments")
                               << '\n';
        return;
    }
    line("fragment counts") << (c.pixels_with_other_count == 0
                                    ? std::string("equal in every pixel")
                                    : "differ in " + counted(c.pixels_with_other_count, "pixel") +
                                          ", reference has " + grouped(c.fragments) + " in all")
                            << '\n';
    line("depth error") << fixed(c.max_depth_error * (1 << 24), 2) << " * 2^-24 at most"
                        << (has_float_depth(report.options.quality.format) ? " (bound: 8)" : "")
                        << '\n';
}

void print_method(const Report& report, const Line& line) {
    const Options& options = report.options;
    line("method") << method_text({&method_named(options.method), options.quality}) << ", "
                   << (report.node_bytes
                           ? "nodes of " + std::to_string(*report.node_bytes) + " bytes, "
                           : "")
                   << counted(static_cast<std::uint64_t>(options.quality.samples), "sample")
                   << " a pixel\n";
    if (options.quality.reduce > 1)
        line("reduced") << "transparent surfaces drawn with " << options.quality.reduce
                        << " times fewer pixels a side\n";
}

void print_fragments(const Report& report, const Line& line) {
    line("triangles") << grouped(report.triangles) << support::dropped_text(report.drops) << '\n';
    std::uint64_t textures = 0;
    for (const SceneMesh& mesh : report.meshes) textures += mesh.ignored_textures;
    if (textures > 0) line("ignored") << counted(textures, "texture") << '\n';
    if (!report.lengths) {
        // A choice says how many there are.
        if (!report.choice)
            line("fragments") << "not counted: the method does not keep all of them\n";
        return;
    }
    line("fragments") << grouped(report.lengths->total) << '\n';
    line("non-empty pixels") << grouped(report.lengths->nonempty_cells) << '\n';
    line("longest list") << grouped(report.lengths->longest) << '\n';
}

void print_memory(const Report& report, const Line& line) {
    line("memory") << megabytes(report.method_bytes) << " MB of the method, "
                   << megabytes(report.device_bytes) << " MB in all\n";
    if (report.options.memory_bytes)
        line("slices") << report.slices << ", " << grouped(report.method_bytes) << " of "
                       << grouped(*report.options.memory_bytes) << " bytes used\n";
}

void print_times(const Report& report, const Line& line) {
    const PassTimes& passes = report.passes;
    line("transform") << fixed(passes.transform_ms, 2) << " ms\n";
    if (report.blends_slices) {
        line("insert to blend") << fixed(passes.raster_insert_ms, 2) << " ms, slice by slice\n";
    } else {
        line("raster + insert") << fixed(passes.raster_insert_ms, 2) << " ms\n";
        line("sort + blend") << fixed(passes.sort_blend_ms, 2) << " ms\n";
    }
    line("frame") << fixed(report.frame_ms, 2) << " ms (median of " << report.options.frames
                  << ")\n";
}

nlohmann::ordered_json meshes_json(const Report& report) {
    auto meshes = nlohmann::ordered_json::array();
    for (const SceneMesh& mesh : report.meshes) {
        meshes.push_back({{"file", std::filesystem::path(mesh.file).filename().string()},
                          {"alpha", nullptr},
                          {"triangles", mesh.triangles},
                          {"ignored_textures", mesh.ignored_textures}});
        if (mesh.alpha) meshes.back()["alpha"] = *mesh.alpha;
    }
    return meshes;
}

nlohmann::ordered_json times_json(const Report& report) {
    const PassTimes& passes = report.passes;
    nlohmann::ordered_json json{{"transform", passes.transform_ms},
                                {"raster_insert", nullptr},
                                {"sort_blend", nullptr},
                                {"slices", nullptr},
                                {"frame", report.frame_ms}};
    if (report.blends_slices) {
        json["slices"] = passes.raster_insert_ms;
    } else {
        json["raster_insert"] = passes.raster_insert_ms;
        json["sort_blend"] = passes.sort_blend_ms;
    }
    return json;
}

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
    print_method(report, line);
    print_fragments(report, line);
    print_memory(report, line);
    print_times(report, line);
    // A choice has a narrower bound of what the early end leaves out.
    if (report.choice)
        print(*report.choice, *options.budget, report.kept, out);
    else if (options.quality.epsilon > 0)
        line("early end") << early_end_text(report) << '\n';
    if (report.pixels_nan > 0)
        line("NaN") << counted(report.pixels_nan, "pixel") << ", drawn black\n";
    if (report.comparison) print_comparison(report, line);
    for (const SceneMesh& mesh : report.meshes) {
        for (const std::string& note : mesh.notes) line("note") << note << '\n';
        if (mesh.ends_within_line)
            line("note") << "the mesh file "
                         << (report.meshes.size() > 1 ? "'" + mesh.file + "' " : "")
                         << "ends within a line: it may have been cut off\n";
    }
    line("picture") << std::filesystem::absolute(options.out).lexically_normal().string() << '\n';
}

void write_json(const Report& report, const std::filesystem::path& path) {
    const Options& options = report.options;
    nlohmann::ordered_json json;
    json["device"] = report.device;
    json["driver"] = report.driver;
    json["scene"] = title_of(options);
    json["method"] = method_text({&method_named(options.method), options.quality});
    json["width"] = options.width;
    json["height"] = options.height;
    json["alpha"] = options.alpha;
    if (options.quality.layers)
        json["layers"] = *options.quality.layers;
    else
        json["layers"] = "all";
    json["view"] = {options.orbit.azimuth_degrees, options.orbit.elevation_degrees};
    json["opaque_floor"] = options.opaque_floor;
    json["triangles"] = report.triangles;
    json["dropped"] = {{"nonfinite_vertices", report.drops.nonfinite_vertices},
                       {"nonfinite_triangles", report.drops.nonfinite_triangles},
                       {"out_of_range_triangles", report.drops.out_of_range_triangles},
                       {"degenerate_triangles", report.drops.degenerate_triangles},
                       {"unsplit_polygons", report.drops.unsplit_polygons},
                       {"points_and_lines", report.drops.points_and_lines},
                       {"bytes_after_end", report.drops.bytes_after_end}};
    json["meshes"] = meshes_json(report);
    json["fragments"] = nullptr;
    if (report.lengths) {
        json["fragments"] = report.lengths->total;
        json["cells_nonempty"] = report.lengths->nonempty_cells;
        json["longest_list"] = report.lengths->longest;
    }
    json["samples"] = options.quality.samples;
    json["node_bytes"] = nullptr;
    if (report.node_bytes) json["node_bytes"] = *report.node_bytes;
    json["pool_bytes"] = report.method_bytes;
    json["reduce"] = options.quality.reduce;
    json["memory_bytes"] = nullptr;
    if (options.memory_bytes) json["memory_bytes"] = *options.memory_bytes;
    json["slices"] = report.slices;
    json["pixels_nan"] = report.pixels_nan;
    json["device_bytes"] = report.device_bytes;
    json["frames"] = options.frames;
    if (report.choice) json["budget"] = json_of(*report.choice, *options.budget, report.kept);
    json["time_ms"] = times_json(report);
    json["psnr_db"] = nullptr;
    json["ssim"] = nullptr;
    json["max_abs_error"] = nullptr;
    if (report.comparison) {
        const Comparison& c = *report.comparison;
        json["psnr_db"] = finite_or_null(c.psnr_db);
        json["ssim"] = c.ssim;
        json["max_abs_error"] = c.max_abs_error;
        json["reference"] = {{"pixels_over_1_255", c.pixels_over},
                             {"pixels_explained", c.pixels_explained},
                             {"pixels_ambiguous", c.pixels_ambiguous},
                             {"pixels_with_other_count", c.pixels_with_other_count},
                             {"fragments", c.fragments},
                             {"max_depth_error", c.max_depth_error}};
    }
    json["nearest_layers"] = nullptr;
    if (report.nearest_comparison) {
        const Comparison& c = *report.nearest_comparison;
        json["nearest_layers"] = {{"psnr_db", finite_or_null(c.psnr_db)},
                                  {"ssim", c.ssim},
                                  {"max_abs_error", c.max_abs_error},
                                  {"pixels_over_1_255", c.pixels_over},
                                  {"pixels_explained", c.pixels_explained}};
    }
    std::ofstream file(path);
    file << json.dump(2) << '\n';
    file.close();
    if (!file) throw support::InputError("cannot write '" + path.string() + "'");
}

}  // namespace oit
