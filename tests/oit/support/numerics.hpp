// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <cellist/cellist.hpp>

#include "camera.hpp"
#include "methods/renderer.hpp"
#include "oit/support/node_errors.hpp"
#include "reference/comparison.hpp"
#include "reference/reference.hpp"
#include "scene/scenes.hpp"

// What docs/numerics.md promises, and what is measured of it: a test and the program that writes
// the tables of the document share this.
namespace cellist::test {

// ---- colours ------------------------------------------------------------------------------------

/// A scene at a limit of numbers.
struct Extreme {
    std::string_view name;
    std::string_view scene;
    float alpha = 0.35F;
    float brighter = 1;  ///< factor of all tints
};

inline constexpr std::array<Extreme, 9> extremes{{
    {"opacities 0, 1, 2^-24, 1 - 2^-24", "extreme-alphas"},
    {"10,000 layers in a pixel", "extreme-layers"},
    {"transmittance of 10^-100", "extreme-underflow"},
    {"colours of 10^4", "extreme-bright"},
    {"colours of 10^6", "extreme-bright", 0.35F, 100},
    {"layers in one plane", "extreme-coplanar"},
    {"slivers, sub-pixel and screen-filling triangles", "extreme-slivers"},
    {"vertices at 10^30", "extreme-far"},
    {"vertices that are NaN or infinite", "extreme-nan"},
}};

/// Errors are of linear colours, as parts of the brightest that a fragment of the frame can have.
struct ColourMetrics {
    std::uint64_t layers = 0;  ///< in a pixel, at most
    double bound = 0;
    double error = 0;  ///< largest, over the pixels in which the order of layers is decided
    std::uint64_t undecided = 0;  ///< the other pixels
    double undecided_error = 0;   ///< largest error of these
    double undecided_used = 0;    ///< and as a part of its bound
    std::uint64_t pixels_nan = 0;
    std::uint64_t other_counts = 0;  ///< pixels with another number of fragments
    bool repeats = false;            ///< a second frame has the same bits
};

/// Shading, blending n layers front to back, and what the format adds: see docs/numerics.md.
inline double colour_bound(const oit::Renderer& renderer, std::uint64_t layers) {
    constexpr double unit = 0x1p-24;
    const auto n = static_cast<double>(layers);
    const double shading = 512 * unit, blending = (3 * n + 2) * unit;
    return shading + blending +
           colour_error(renderer.layout(), renderer.features()) /
               static_cast<double>(renderer.features().colour_max) +
           n * alpha_error(renderer.layout());
}

/// What a pixel changes by, at most, if all layers whose order the format does not know change
/// places.
inline double swaps(const oit::Renderer& renderer, const oit::Reference& reference,
                    std::size_t pixel) {
    const auto& all = reference.fragments;
    double sum = 0;
    for (std::size_t i = reference.offsets[pixel]; i < reference.offsets[pixel + 1]; ++i)
        for (std::size_t j = i + 1; j < reference.offsets[pixel + 1]; ++j) {
            if (all[j].depth - all[i].depth >
                renderer.layout().depth_resolution(renderer.features()).at(all[j].depth))
                break;
            sum += oit::swap_error(all[i], all[j]);
        }
    return sum;
}

inline ColourMetrics measure(const Device& device, const Extreme& extreme, oit::NodeFormat format) {
    oit::Scene scene = oit::find_scene(extreme.scene)->make(extreme.alpha);
    for (oit::Material& material : scene.materials)
        for (int c = 0; c < 3; ++c) {
            material.front_tint[c] *= extreme.brighter;
            material.back_tint[c] *= extreme.brighter;
        }
    const oit::Frame frame{.scene = scene,
                           .views = {support::frame_unit_sphere({0, 0}, 96, 80)},
                           .quality = {.format = format}};
    oit::Renderer renderer(device, frame);
    renderer.draw();
    const std::vector<cl_float4> image = renderer.image();
    renderer.draw();
    const std::vector<cl_float4> again = renderer.image();
    const oit::Reference reference = oit::draw_reference(frame);

    ColourMetrics metrics;
    metrics.repeats =
        std::memcmp(image.data(), again.data(), image.size() * sizeof(cl_float4)) == 0;
    const oit::Comparison comparison = oit::compare(reference, image, renderer.method().depths());
    metrics.pixels_nan = comparison.pixels_nan;
    metrics.other_counts = comparison.pixels_with_other_count;
    for (std::size_t p = 0; p < image.size(); ++p)
        metrics.layers = std::max(metrics.layers, reference.offsets[p + 1] - reference.offsets[p]);
    metrics.bound = colour_bound(renderer, metrics.layers);
    const auto brightest = static_cast<double>(renderer.features().colour_max);
    for (std::size_t p = 0; p < image.size(); ++p) {
        double error = 0;
        for (int c = 0; c < 3; ++c)
            error = std::max(
                error,
                std::abs(static_cast<double>(image[p].s[c]) - reference.image[p][c]) / brightest);
        if (!reference.ambiguous[p]) {
            metrics.error = std::max(metrics.error, error);
            continue;
        }
        ++metrics.undecided;
        metrics.undecided_error = std::max(metrics.undecided_error, error);
        metrics.undecided_used =
            std::max(metrics.undecided_used,
                     error / (metrics.bound + swaps(renderer, reference, p) / brightest));
    }
    return metrics;
}

// ---- depths -------------------------------------------------------------------------------------

struct DepthCase {
    std::string_view name;
    oit::NodeFormat format;
    oit::DepthScale scale;
};

inline constexpr std::array<DepthCase, 6> depth_cases{{
    {"float", oit::NodeFormat::float32, oit::DepthScale::linear},
    {"float, reversed", oit::NodeFormat::float32, oit::DepthScale::reversed},
    {"24 bits, linear", oit::NodeFormat::rgba8_d24c8, oit::DepthScale::linear},
    {"24 bits, reversed", oit::NodeFormat::rgba8_d24c8, oit::DepthScale::reversed},
    {"16 bits, linear", oit::NodeFormat::rgb565_d16, oit::DepthScale::linear},
    {"16 bits, reversed", oit::NodeFormat::rgb565_d16, oit::DepthScale::reversed},
}};

/// Depths at which the document says what is resolved.
inline constexpr std::array<double, 5> shown_depths{1e-3, 1, 1e2, 1e4, 1e6};

struct DepthMetrics {
    std::array<double, shown_depths.size()> gaps{};  ///< depths that far apart have an order
    double used = 0;  ///< the largest error of a depth, as a part of its bound
    std::uint64_t fragments = 0;
};

/// A view along z from the origin that sees depths from 10^-4.
inline raster::View wide_view(int width, int height) {
    const auto focal = static_cast<float>(width);
    raster::View view{};
    view.row_x[0] = focal * RASTER_SUBPIXELS;
    view.row_y[1] = focal * RASTER_SUBPIXELS;
    view.row_w[2] = 1;
    view.ray_x[0] = 1 / focal;
    view.ray_y[1] = 1 / focal;
    view.ray_origin[0] = -0.5F * static_cast<float>(width - 1) / focal;
    view.ray_origin[1] = -0.5F * static_cast<float>(height - 1) / focal;
    view.ray_origin[2] = 1;
    view.near_depth = 1e-4F;
    view.width = width;
    view.height = height;
    return view;
}

/// Sheets beside one another, each ten times as far away as the one before it and a third farther
/// at its right side: from depth 1.01e-4 to 1.35e6.
inline oit::Scene sheets_of_all_depths() {
    constexpr int count = 11;
    support::Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const double depth = 1.01e-4 * std::pow(10, i);
        for (const double down : {-0.2, 0.2})
            for (const int across : {0, 1}) {
                const double z = depth * (1 + across / 3.0);
                const double x = (i + 0.9 * across - 0.5 * count) / count;
                mesh.positions.emplace_back(x * z, down * z, z);
                mesh.normals.emplace_back(0.0F, 0.0F, -1.0F);
            }
        mesh.triangles.push_back({first, first + 3, first + 1});
        mesh.triangles.push_back({first, first + 2, first + 3});
    }
    oit::Scene scene;
    scene.models.push_back({.mesh = std::move(mesh)});
    scene.materials.push_back(oit::glass(0.35F));
    scene.instances.push_back({});
    return scene;
}

inline DepthMetrics measure(const Device& device, const DepthCase& depth_case) {
    const oit::Scene scene = sheets_of_all_depths();
    const oit::Frame frame{
        .scene = scene,
        .views = {wide_view(200, 100)},
        .quality = {.format = depth_case.format, .depth_scale = depth_case.scale}};
    oit::Renderer renderer(device, frame);
    renderer.draw();
    const oit::Reference reference = oit::draw_reference(frame);
    const std::optional<oit::StoredDepths> stored = renderer.method().depths();

    DepthMetrics metrics;
    const auto resolution = [&](double depth) {
        return renderer.layout().depth_resolution(renderer.features()).at(depth);
    };
    for (std::size_t i = 0; i < shown_depths.size(); ++i)
        metrics.gaps[i] = resolution(shown_depths[i]);
    for (std::size_t p = 0; p < reference.image.size(); ++p) {
        const std::uint64_t at = reference.offsets[p];
        if (reference.offsets[p + 1] != at + 1 || stored->offsets[p + 1] != stored->offsets[p] + 1)
            continue;
        ++metrics.fragments;
        const double depth = reference.fragments[at].depth,
                     found = stored->depths[stored->offsets[p]];
        // What is resolved is twice the error of one. Inverse depths have even steps if reversed.
        const bool reversed = depth_case.scale == oit::DepthScale::reversed;
        const double error = reversed ? std::abs(1 / found - 1 / depth) : std::abs(found - depth);
        const double bound = resolution(depth) / 2 / (reversed ? depth * depth : 1);
        metrics.used = std::max(metrics.used, error / bound);
    }
    return metrics;
}

// ---- the tables ---------------------------------------------------------------------------------

inline std::string short_number(double value) {
    if (value == 0) return "0";
    std::ostringstream text;
    text.precision(1);
    text << std::scientific << value;
    return text.str();
}

/// The first cells of a line of the table of colours: what does not depend on the device.
inline std::string colour_line(const Extreme& extreme, std::string_view format,
                               const ColourMetrics& metrics) {
    return "| " + std::string(extreme.name) + " | " + std::to_string(metrics.layers) + " | `" +
           std::string(format) + "` | " + short_number(metrics.bound) + " | ";
}

/// The same of the table of depths.
inline std::string depth_line(const DepthCase& depth_case, const DepthMetrics& metrics) {
    std::string line = "| " + std::string(depth_case.name) + " | ";
    for (std::size_t i = 0; i < shown_depths.size(); ++i)
        line += (metrics.gaps[i] < shown_depths[i] ? short_number(metrics.gaps[i]) : "all") + " | ";
    return line;
}

}  // namespace cellist::test
