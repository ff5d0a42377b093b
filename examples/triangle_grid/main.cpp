// SPDX-License-Identifier: MIT
// Triangles in the cells of a 3D grid, and segments that ask whether anything is in their way;
// checked against every triangle, or against Embree.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <cellist/cellist.hpp>

#include "command_line.hpp"
#include "embree.hpp"
#include "files.hpp"
#include "grid/embree.hpp"
#include "grid/exact.hpp"
#include "grid/rays.hpp"
#include "grid/triangle_grid.hpp"
#include "image.hpp"
#include "input_error.hpp"
#include "mesh.hpp"
#include "picture.hpp"
#include "scene.hpp"
#include "segments.hpp"
#include "stopwatch.hpp"

namespace {

struct Options {
    std::filesystem::path mesh;
    std::filesystem::path out;
    int grid = 0;
    cellist::Storage storage = cellist::Storage::counted;
    std::size_t segments = 1'000'000;
    std::size_t check = 3000;
    bool embree = false;
    std::uint32_t seed = 1;
    std::string device;
    std::string help;
};

Options parse_options(int count, const char* const* arguments) {
    Options options;
    support::CommandLine line("triangle_grid",
                              "Puts the triangles of a mesh into a 3D grid, and finds the segments "
                              "that meet a triangle.");
    line.add_text("mesh", options.mesh,
                  "mesh file (PLY, OBJ, glTF, STL, OFF, ...); the default is a knot", "MESH");
    line.add_number("--grid", options.grid, 0, GRID_EXTENT_MAX,
                    "cells along the longest side of the mesh; 0 = automatic");
    line.add_storage(options.storage);
    line.add_number("--segments", options.segments, 0, 100'000'000, "number of segments");
    line.add(
        "--check", std::to_string(options.check),
        "greatest number of segments to check on the CPU; embree = compare random segments with "
        "Embree",
        "N|all|embree", [&](const std::string& text) {
            options.embree = text == "embree";
            if (options.embree && !grid::has_embree())
                throw support::InputError(
                    "--check embree: this build has no Embree; install libembree-dev and build "
                    "again");
            if (text == "all")
                options.check = options.segments;
            else if (!options.embree)
                options.check = support::read_number("--check", text, 0, 0xFFFFFFFF);
        });
    line.add("--out", "",
             "draw the mesh with shadows and write the picture here: .png, .jpg, .pfm or .exr",
             "FILE", [&](const std::string& text) {
                 support::check_output_path(text);
                 (void)support::image_format(text);
                 options.out = text;
             });
    line.add_seed(options.seed);
    line.add_device(options.device);
    options.help = line.parse(count, arguments).value_or("");
    options.check = std::min(options.check, options.segments);
    return options;
}

// Compares evenly spread segments with the reference, prints the result, and returns whether all
// are equal.
bool check(const std::vector<triangle_grid::Segment>& segments, const std::vector<cl_uint>& hits,
           const std::vector<grid::GridTriangle>& triangles, std::size_t sample,
           std::FILE* screen) {
    using triangle_grid::kinds;
    std::array<std::size_t, kinds.size()> asked{}, blocked{}, different{};
    // One more than a multiple of the kinds, so that every kind has its turn.
    const std::size_t rounds = sample > 0 ? (segments.size() / sample - 1) / kinds.size() : 0;
    const std::size_t step = rounds * kinds.size() + 1;
    for (std::size_t n = 0; n < sample; ++n) {
        const std::size_t i = n * step;
        const bool expected = grid::meets_any(segments[i].from, segments[i].to, triangles);
        const std::size_t kind = i % kinds.size();
        ++asked[kind];
        if (expected) ++blocked[kind];
        if (expected != (hits[i] != 0)) ++different[kind];
    }
    bool equal = true;
    for (std::size_t kind = 0; kind < kinds.size() && sample > 0; ++kind) {
        std::fprintf(screen, "check       %-29s %5zu of %5zu meet a triangle, %zu differ\n",
                     std::string(kinds[kind]).c_str(), blocked[kind], asked[kind], different[kind]);
        equal = equal && different[kind] == 0;
    }
    return equal;
}

// Compares all segments with Embree, prints the result and both times, and returns whether all
// answers are right. An exact test of every triangle decides where answers differ.
bool check_with_embree(const std::vector<triangle_grid::Segment>& segments,
                       const std::vector<cl_uint>& hits,
                       const std::vector<grid::GridTriangle>& triangles, double ms,
                       std::FILE* screen) {
    const triangle_grid::EmbreeAnswers embree = triangle_grid::ask_embree(triangles, segments);
    std::size_t different = 0, wrong = 0;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const bool is_hit = hits[i] != 0;
        if (is_hit == (embree.hits[i] != 0)) continue;
        ++different;
        if (is_hit != grid::meets_any(segments[i].from, segments[i].to, triangles)) ++wrong;
    }
    const double embree_ms = embree.build_ms + embree.trace_ms;
    std::fprintf(screen,
                 "embree      build %.1f ms, segments %.1f ms (%.2f million/s); the grid is %.2f "
                 "times as fast in all\n",
                 embree.build_ms, embree.trace_ms,
                 static_cast<double>(segments.size()) / embree.trace_ms * 1e-3, embree_ms / ms);
    std::fprintf(screen,
                 "check       %zu of %zu differ from Embree: %zu answers of Embree are wrong, %zu "
                 "of the grid\n",
                 different, segments.size(), different - wrong, wrong);
    return wrong == 0;
}

bool run(const Options& options) {
    std::FILE* const screen = support::is_standard_output(options.out) ? stderr : stdout;
    const cellist::Device device = options.device.empty() ? cellist::Device::choose()
                                                          : cellist::Device::choose(options.device);
    support::Mesh mesh =
        options.mesh.empty() ? triangle_grid::make_knot() : support::load_mesh(options.mesh);
    support::fit_to_unit_sphere(mesh);
    std::vector<grid::GridTriangle> triangles = triangle_grid::triangles_of(mesh);
    const grid::GridCells cells = grid::cells_around(triangles, options.grid);
    const std::vector<triangle_grid::Segment> segments =
        options.embree
            ? triangle_grid::make_random_segments(options.segments, cells, options.seed)
            : triangle_grid::make_segments(options.segments, cells, triangles, options.seed);
    triangle_grid::add_flat_triangles(triangles);

    grid::TriangleGrid grid(device, triangles, cells, options.storage);
    grid::Rays rays(device, grid);
    const cellist::Buffer<grid::GridSegment> asked(device, triangle_grid::to_device(segments));
    cellist::Buffer<cl_uint> any(device, segments.size());
    grid.build();  // lets the pool grow
    rays.any_hits(asked, asked.size(), any);
    cellist::BuildReport report;
    std::vector<double> builds_ms;
    for (int run = 0; run < 5; ++run)
        builds_ms.push_back(support::measure_ms(device, [&] { report = grid.build(); }));
    const double build_ms = support::median(builds_ms);
    const double ask_ms =
        support::measure_ms(device, [&] { rays.any_hits(asked, asked.size(), any); });
    const std::vector<cl_uint> hits = any.download();

    std::fprintf(screen, "device      %s\n", device.info().name.c_str());
    std::fprintf(screen, "triangles   %zu, in %s cells, %s: %llu entries, %.1f MB\n",
                 triangles.size(), grid.entries().shape().to_string().c_str(),
                 name_of(options.storage), static_cast<unsigned long long>(report.stored),
                 static_cast<double>(grid.entries().pool_bytes()) * 1e-6);
    if (!options.mesh.empty())
        std::fprintf(screen, "mesh        triangles: %zu%s\n", mesh.triangles.size(),
                     support::dropped_text(mesh.drops).c_str());
    for (const std::string& note : mesh.notes)
        std::fprintf(screen, "note        %s\n", note.c_str());
    if (mesh.ends_within_line)
        std::fprintf(screen,
                     "note        the mesh file ends within a line: it may have been cut off\n");
    std::fprintf(screen, "segments    %zu, %lld meet a triangle\n", segments.size(),
                 static_cast<long long>(std::count(hits.begin(), hits.end(), cl_uint{1})));
    std::fprintf(screen, "time        build %.1f ms, segments %.1f ms (%.2f million/s)\n", build_ms,
                 ask_ms, static_cast<double>(segments.size()) / ask_ms * 1e-3);
    if (!options.out.empty()) {
        const double ms = triangle_grid::draw_picture(device, grid, mesh, {.out = options.out});
        std::fprintf(screen, "picture     %s, %.0f ms\n", support::text_of(options.out).c_str(),
                     ms);
    }
    const bool accounted =
        report.dropped == 0 && report.rejected == 0 && report.stored >= triangles.size();
    if (!accounted) std::fprintf(screen, "check       entries are MISSING\n");
    const bool is_right =
        options.embree ? check_with_embree(segments, hits, triangles, build_ms + ask_ms, screen)
                       : check(segments, hits, triangles, options.check, screen);
    return is_right && accounted;
}

}  // namespace

int main(int count, char** arguments) {
    return support::run_program("triangle_grid", [&] {
        const Options options = parse_options(count, arguments);
        if (options.help.empty()) return run(options);
        std::cout << options.help;
        return true;
    });
}
