// SPDX-License-Identifier: MIT
#include "scene/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

namespace oit {
namespace {

using glm::dvec2;
using glm::dvec3;
using support::Mesh;

dvec3 around(double angle, const dvec2& radius_and_z) {
    return {radius_and_z.x * std::cos(angle), radius_and_z.x * std::sin(angle), radius_and_z.y};
}

std::uint32_t add_vertex(Mesh& mesh, const dvec3& position, const dvec3& normal) {
    mesh.positions.emplace_back(position);
    mesh.normals.emplace_back(glm::normalize(normal));
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

void add_quad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
}

void append(Mesh& mesh, const Mesh& other) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
    for (const auto& t : other.triangles)
        mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

// The right side of a direction in the plane of radius and z.
dvec2 right_of(const dvec2& direction) { return {direction.y, -direction.x}; }

// The normal of a profile's point: of one of its neighbours' parts, or between both.
dvec2 profile_normal(std::span<const dvec2> profile, std::size_t point) {
    const std::size_t last = profile.size() - 1;
    const bool closed = profile.front() == profile.back();
    const dvec2 before = point > 0 ? profile[point - 1] : closed ? profile[last - 1] : profile[0];
    const dvec2 after = point < last ? profile[point + 1] : closed ? profile[1] : profile[last];
    return right_of(after - before);
}

// How far the outline of a gear is from its root, in tooth heights; the part of a tooth runs from 0
// to 1, its middle is at 0.
double tooth_profile(double part) {
    const double from_middle = std::min(part, 1 - part);
    return std::clamp((0.29 - from_middle) / 0.18, 0.0, 1.0);
}

// A face of a gear between two outlines, as seen from above or below.
void add_cap(Mesh& mesh, std::span<const dvec2> outer, std::span<const dvec2> inner, double z) {
    const dvec3 normal(0, 0, z > 0 ? 1 : -1);
    const std::size_t count = outer.size();
    std::vector<std::uint32_t> out, in;
    for (std::size_t i = 0; i < count; ++i) {
        out.push_back(add_vertex(mesh, dvec3(outer[i], z), normal));
        in.push_back(add_vertex(mesh, dvec3(inner[i], z), normal));
    }
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t j = (i + 1) % count;
        if (z > 0)
            add_quad(mesh, in[i], out[i], out[j], in[j]);
        else
            add_quad(mesh, in[i], in[j], out[j], out[i]);
    }
}

// The wall along an outline; it faces to the right of its direction.
void add_wall(Mesh& mesh, std::span<const dvec2> outline, double half_height) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const dvec2 a = outline[i], b = outline[(i + 1) % outline.size()];
        const dvec3 normal(right_of(b - a), 0);
        const auto corner = [&](const dvec2& p, double z) {
            return add_vertex(mesh, dvec3(p, z), normal);
        };
        add_quad(mesh, corner(a, -half_height), corner(b, -half_height), corner(b, half_height),
                 corner(a, half_height));
    }
}

}  // namespace

std::vector<dvec2> arc(const dvec2& centre, double radius, double begin, double end, int parts) {
    std::vector<dvec2> points;
    for (int i = 0; i <= parts; ++i) {
        const double angle = begin + (end - begin) * i / parts;
        points.push_back(centre + radius * dvec2(std::cos(angle), std::sin(angle)));
    }
    return points;
}

std::vector<dvec2> divided(std::span<const dvec2> profile, double longest) {
    std::vector<dvec2> points{profile.front()};
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        const dvec2 way = profile[i + 1] - profile[i];
        const int parts = std::max(1, static_cast<int>(std::ceil(glm::length(way) / longest)));
        for (int k = 1; k < parts; ++k)
            points.push_back(profile[i] + static_cast<double>(k) / parts * way);
        points.push_back(profile[i + 1]);
    }
    return points;
}

Mesh lathe(std::span<const dvec2> profile, int segments, Corners corners) {
    Mesh mesh;
    const auto add_circle = [&](const dvec2& point, const dvec2& normal) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int i = 0; i < segments; ++i)
            add_vertex(mesh, around(full_turn * i / segments, point),
                       around(full_turn * i / segments, normal));
        return first;
    };
    for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
        const dvec2 a = profile[k], b = profile[k + 1];
        const dvec2 flat = right_of(b - a);
        const bool round = corners == Corners::round;
        const std::uint32_t low = add_circle(a, round ? profile_normal(profile, k) : flat);
        const std::uint32_t high = add_circle(b, round ? profile_normal(profile, k + 1) : flat);
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(segments); ++i) {
            const std::uint32_t j = (i + 1) % static_cast<std::uint32_t>(segments);
            if (a.x > 0) mesh.triangles.push_back({low + i, low + j, high + j});
            if (b.x > 0) mesh.triangles.push_back({low + i, high + j, high + i});
        }
    }
    return mesh;
}

Mesh ball(double radius, int segments) {
    std::vector<dvec2> profile =
        arc({0, 0}, radius, -std::numbers::pi / 2, std::numbers::pi / 2, segments / 2);
    profile.front().x = profile.back().x = 0;
    return lathe(profile, segments, Corners::round);
}

Mesh ring(double radius, double wire_radius, int segments, int wire_segments) {
    std::vector<dvec2> profile = arc({radius, 0}, wire_radius, 0, full_turn, wire_segments);
    profile.back() = profile.front();
    return lathe(profile, segments, Corners::round);
}

Mesh sleeve(double inner, double outer, double low, double high, int segments, double longest) {
    const dvec2 profile[] = {
        {outer, low}, {outer, high}, {inner, high}, {inner, low}, {outer, low}};
    return lathe(divided(profile, longest), segments, Corners::sharp);
}

Mesh gear(const Gear& shape) {
    const int points = shape.teeth * shape.tooth_points;
    std::vector<dvec2> outer, inner;
    for (int i = 0; i < points; ++i) {
        const double angle = full_turn * i / points;
        const double part = static_cast<double>(i % shape.tooth_points) / shape.tooth_points;
        const double radius = shape.pitch_radius + (tooth_profile(part) - 0.5) * shape.tooth_height;
        outer.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
        inner.emplace_back(shape.rim_radius * std::cos(angle), shape.rim_radius * std::sin(angle));
    }
    Mesh mesh;
    add_cap(mesh, outer, inner, shape.thickness / 2);
    add_cap(mesh, outer, inner, -shape.thickness / 2);
    add_wall(mesh, outer, shape.thickness / 2);
    std::reverse(inner.begin(), inner.end());
    add_wall(mesh, inner, shape.thickness / 2);

    // The web ends inside of the rim.
    const double outside = shape.rim_radius + 0.25 * shape.tooth_height;
    const double top = shape.thickness / 6;
    const dvec2 web[] = {
        {outside, top}, {shape.bore_radius, top}, {shape.bore_radius, -top}, {outside, -top}};
    append(mesh, lathe(divided(web, 0.07), shape.web_segments, Corners::sharp));
    return mesh;
}

Mesh spring(const Spring& shape, std::size_t triangles) {
    if (triangles < 60 || triangles > 10'000'000)
        throw std::invalid_argument("a spring of " + std::to_string(triangles) + " triangles");
    constexpr std::size_t wire = 12;
    // What whole rings of the wire leave over goes to the ends.
    const std::size_t rings = (triangles - 6) / (2 * wire);
    const std::size_t ends = triangles - 2 * wire * rings;
    struct Section {
        dvec3 centre, outwards, up;
        [[nodiscard]] dvec3 direction(double part) const {
            return std::cos(full_turn * part) * outwards + std::sin(full_turn * part) * up;
        }
    };
    const auto section = [&](std::size_t i) {
        const double part = static_cast<double>(i) / static_cast<double>(rings);
        const double angle = full_turn * shape.turns * part;
        const double rise = (shape.high - shape.low) / (full_turn * shape.turns);
        const dvec3 forward = glm::normalize(
            dvec3(-shape.radius * std::sin(angle), shape.radius * std::cos(angle), rise));
        const dvec3 outwards(std::cos(angle), std::sin(angle), 0);
        return Section{
            shape.radius * outwards + dvec3(0, 0, shape.low + (shape.high - shape.low) * part),
            outwards, glm::cross(outwards, forward)};
    };
    Mesh mesh;
    for (std::size_t i = 0; i <= rings; ++i) {
        const Section s = section(i);
        for (std::size_t j = 0; j < wire; ++j) {
            const dvec3 direction = s.direction(static_cast<double>(j) / wire);
            add_vertex(mesh, s.centre + shape.wire_radius * direction, direction);
        }
    }
    const auto at = [](std::size_t i, std::size_t j) {
        return static_cast<std::uint32_t>(i * wire + j % wire);
    };
    for (std::size_t i = 0; i < rings; ++i)
        for (std::size_t j = 0; j < wire; ++j)
            add_quad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    const auto add_end = [&](const Section& s, std::size_t count, bool front) {
        const dvec3 forward = glm::cross(s.up, s.outwards);
        const dvec3 normal = front ? forward : -forward;
        const std::uint32_t centre = add_vertex(mesh, s.centre, normal);
        for (std::size_t j = 0; j < count; ++j)
            add_vertex(mesh,
                       s.centre + shape.wire_radius * s.direction(static_cast<double>(j) /
                                                                  static_cast<double>(count)),
                       normal);
        for (std::uint32_t j = 0; j < count; ++j) {
            const std::uint32_t a = centre + 1 + j,
                                b = centre + 1 + (j + 1) % static_cast<std::uint32_t>(count);
            if (front)
                mesh.triangles.push_back({centre, b, a});
            else
                mesh.triangles.push_back({centre, a, b});
        }
    };
    add_end(section(0), ends / 2, false);
    add_end(section(rings), ends - ends / 2, true);
    return mesh;
}

}  // namespace oit
