#include "report.hpp"

#include <cmath>
#include <fstream>
#include <iomanip>
#include <ostream>

#include <nlohmann/json.hpp>

#include "input_error.hpp"
#include "number_text.hpp"
#include "setting.hpp"

namespace oit {
namespace {

std::string dropped_text(const support::MeshDrops& drops) {
    std::string text;
    const auto add = [&](std::uint64_t count, const std::string& what) {
        if (count > 0) text += (text.empty() ? "" : ", ") + grouped(count) + " " + what;
    };
    add(drops.nonfinite_triangles, "with NaN or infinite vertices");
    add(drops.out_of_range_triangles, "with indices out of range");
    add(drops.degenerate_triangles, "degenerate");
    add(drops.points_and_lines, "points or lines");
    return text.empty() ? "" : " (dropped: " + text + ")";
}

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

std::string nearest_text(std::uint32_t layers) {
    return "the " + grouped(layers) + (layers == 1 ? " nearest layer" : " nearest layers");
}

// How far off the picture is; and where only the nearest layers were asked for, how far from what
// these make.
void print_comparison(const Report& report, std::ostream& out) {
    const auto line = [&out](const std::string& name) -> std::ostream& {
        return out << "  " << std::left << std::setw(18) << name << std::right;
    };
    const Comparison& c = *report.comparison;
    line("PSNR") << fixed(c.psnr_db, 1) << " dB against all layers in double precision\n";
    if (report.nearest_comparison)
        line("") << fixed(report.nearest_comparison->psnr_db, 1) << " dB against "
                 << nearest_text(*report.options.quality.layers) << " in double precision\n";
    line("SSIM") << fixed(c.ssim, 6) << '\n';
    line("largest error") << fixed(255 * c.max_abs_error, 4) << " / 255\n";
    line("over 1/255") << grouped(c.pixels_over) << " of " << grouped(c.pixels) << " pixels, "
                       << grouped(c.pixels_explained)
                       << " explained by depths closer than 2^-20 of each other\n";
    if (!c.has_depths) return;
    line("fragment counts") << (c.pixels_with_other_count == 0
                                    ? std::string("equal in every pixel")
                                    : "differ in " + grouped(c.pixels_with_other_count) +
                                          " pixels, reference has " + grouped(c.fragments) +
                                          " in all")
                            << '\n';
    line("depth error") << fixed(c.max_depth_error * (1 << 24), 2)
                        << " * 2^-24 at most (bound: 8)\n";
}

}  // namespace

void print(const Report& report, std::ostream& out) {
    const auto line = [&out](const std::string& name) -> std::ostream& {
        return out << "  " << std::left << std::setw(18) << name << std::right;
    };
    const Options& options = report.options;
    out << "cellist-oit " << std::filesystem::path(options.scene).filename().string() << ", "
        << options.width << 'x' << options.height << ", alpha " << options.alpha << ", "
        << (options.quality.layers ? nearest_text(*options.quality.layers) : "all layers")
        << (options.opaque_floor ? ", opaque floor" : "") << '\n';
    line("device") << report.device << " (driver " << report.driver << ")\n";
    line("method") << method_text({&method_named(options.method), options.quality}) << ", nodes of "
                   << report.node_bytes << " bytes, " << options.quality.samples
                   << (options.quality.samples == 1 ? " sample" : " samples") << " a pixel\n";
    if (options.quality.reduce > 1)
        line("reduced") << "transparent surfaces drawn with " << options.quality.reduce
                        << " times fewer pixels a side\n";
    line("triangles") << grouped(report.triangles) << dropped_text(report.drops) << '\n';
    if (report.lengths) {
        line("fragments") << grouped(report.lengths->total) << '\n';
        line("non-empty pixels") << grouped(report.lengths->nonempty_cells) << '\n';
        line("longest list") << grouped(report.lengths->longest) << '\n';
    }
    line("memory") << megabytes(report.method_bytes) << " MB of lists, "
                   << megabytes(report.device_bytes) << " MB in all\n";
    if (options.memory_bytes)
        line("slices") << report.slices << ", " << grouped(report.method_bytes) << " of "
                       << grouped(*options.memory_bytes) << " bytes used\n";
    line("transform") << fixed(report.passes.transform_ms, 2) << " ms\n";
    line("raster + insert") << fixed(report.passes.raster_insert_ms, 2) << " ms\n";
    line("sort + blend") << fixed(report.passes.sort_blend_ms, 2) << " ms\n";
    line("frame") << fixed(report.frame_ms, 2) << " ms (median of " << options.frames << ")\n";
    if (report.choice) print(*report.choice, *options.budget, report.kept, out);
    if (options.quality.epsilon > 0) line("early end") << early_end_text(report) << '\n';
    if (report.pixels_nan > 0)
        line("NaN") << grouped(report.pixels_nan) << " pixels, drawn black\n";
    if (report.comparison) print_comparison(report, out);
    if (report.mesh_ends_within_line)
        line("note") << "the mesh file ends within a line: it may have been cut off\n";
    line("picture") << std::filesystem::absolute(options.out).lexically_normal().string() << '\n';
}

void write_json(const Report& report, const std::filesystem::path& path) {
    const Options& options = report.options;
    nlohmann::ordered_json json;
    json["device"] = report.device;
    json["driver"] = report.driver;
    json["scene"] = std::filesystem::path(options.scene).filename().string();
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
                       {"points_and_lines", report.drops.points_and_lines}};
    json["fragments"] = nullptr;
    if (report.lengths) {
        json["fragments"] = report.lengths->total;
        json["cells_nonempty"] = report.lengths->nonempty_cells;
        json["longest_list"] = report.lengths->longest;
    }
    json["samples"] = options.quality.samples;
    json["node_bytes"] = report.node_bytes;
    json["pool_bytes"] = report.method_bytes;
    json["reduce"] = options.quality.reduce;
    json["memory_bytes"] = nullptr;
    if (options.memory_bytes) json["memory_bytes"] = *options.memory_bytes;
    json["slices"] = report.slices;
    json["pixels_nan"] = report.pixels_nan;
    json["device_bytes"] = report.device_bytes;
    json["frames"] = options.frames;
    if (report.choice) json["budget"] = json_of(*report.choice, *options.budget, report.kept);
    json["time_ms"] = {{"transform", report.passes.transform_ms},
                       {"raster_insert", report.passes.raster_insert_ms},
                       {"sort_blend", report.passes.sort_blend_ms},
                       {"frame", report.frame_ms}};
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
