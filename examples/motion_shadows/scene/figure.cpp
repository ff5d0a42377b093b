// SPDX-License-Identifier: MIT
#include "figure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include "surface_nets.hpp"

namespace motion {
namespace {

// Joints of the left side in the rest pose.
const glm::dvec3 waist(0, 1.07, -0.01), neck(0, 1.5, -0.02);
const glm::dvec3 shoulder(0.175, 1.43, -0.02), elbow(0.365, 1.205, -0.03), wrist(0.53, 1.01, -0.01);
const glm::dvec3 hip(0.095, 0.93, 0), knee(0.115, 0.505, 0.01), ankle(0.13, 0.085, -0.025);

glm::dvec3 on_side(const glm::dvec3& left, std::size_t side) {
    return {side == 0 ? left.x : -left.x, left.y, left.z};
}

// A cone with round ends. An ellipsoid is a cone of no length in stretched space.
struct Part {
    Bone bone;
    glm::dvec3 a, b;
    double radius_a, radius_b;
    double blend;           // into the parts before it, where the distances differ by less
    glm::dvec3 stretch{1};  // of the space around `a`
};

// The parts of the middle and of the left side.
const Part middle_parts[] = {
    {pelvis, {-0.07, 0.975, -0.005}, {0.07, 0.975, -0.005}, 0.1, 0.1, 0.05},
    {pelvis, {-0.055, 1.08, 0.0}, {0.055, 1.08, 0.0}, 0.09, 0.09, 0.08},
    {chest, {-0.06, 1.2, 0.0}, {0.06, 1.2, 0.0}, 0.098, 0.098, 0.08},
    {chest, {-0.08, 1.33, -0.005}, {0.08, 1.33, -0.005}, 0.108, 0.108, 0.08},
    {chest, {-0.125, 1.425, -0.025}, {0.125, 1.425, -0.025}, 0.062, 0.062, 0.06},
    {chest, {0, 1.43, -0.025}, {0, 1.5, -0.015}, 0.072, 0.056, 0.06},
    {head, {0, 1.5, -0.015}, {0, 1.58, 0.005}, 0.054, 0.052, 0.03},
    {head, {0, 1.685, 0.0}, {0, 1.685, 0.0}, 0.1, 0.1, 0.03, {0.8, 1.08, 1.0}},
    {head, {0, 1.61, 0.045}, {0, 1.61, 0.045}, 0.058, 0.058, 0.05, {0.9, 1.05, 1}},
    {head, {0, 1.665, 0.092}, {0, 1.637, 0.108}, 0.008, 0.014, 0.015},
};
const Part left_parts[] = {
    {chest, {0.075, 1.335, 0.055}, {0.075, 1.335, 0.055}, 0.065, 0.065, 0.06},
    {pelvis, {0.075, 0.935, -0.055}, {0.075, 0.935, -0.055}, 0.082, 0.082, 0.05},
    {head, {0.08, 1.665, -0.005}, {0.08, 1.645, -0.008}, 0.016, 0.012, 0.01, {0.6, 1.2, 1}},
    {upper_arm, shoulder, elbow, 0.056, 0.041, 0.04},
    {forearm, elbow, wrist, 0.041, 0.028, 0.01},
    {forearm, {0.39, 1.175, -0.028}, {0.48, 1.07, -0.018}, 0.038, 0.032, 0.04},
    {forearm, wrist, {0.578, 0.95, 0.005}, 0.029, 0.033, 0.03, {1, 1, 1.15}},
    {forearm, {0.585, 0.94, 0.01}, {0.625, 0.875, 0.02}, 0.026, 0.016, 0.02, {1, 1, 1.4}},
    {forearm, {0.555, 0.975, 0.03}, {0.575, 0.92, 0.065}, 0.014, 0.011, 0.015},
    {thigh, hip, knee, 0.088, 0.056, 0.04},
    {thigh, {0.097, 0.9, 0.015}, {0.113, 0.56, 0.022}, 0.076, 0.052, 0.04},
    {shin, knee, {0.129, 0.105, -0.023}, 0.052, 0.036, 0.015},
    {shin, {0.117, 0.46, -0.01}, {0.125, 0.24, -0.022}, 0.046, 0.036, 0.04},
    {foot, ankle, {0.13, 0.05, -0.035}, 0.037, 0.042, 0.02},
    {foot, {0.13, 0.06, -0.01}, {0.142, 0.03, 0.11}, 0.042, 0.036, 0.03},
    {foot, {0.128, 0.03, 0.11}, {0.138, 0.024, 0.165}, 0.034, 0.026, 0.03},
    {foot, {0.158, 0.03, 0.1}, {0.166, 0.022, 0.14}, 0.03, 0.022, 0.03},
};

double distance_to(const Part& part, const glm::dvec3& point) {
    const glm::dvec3 p = (point - part.a) / part.stretch, axis = (part.b - part.a) / part.stretch;
    const double square = glm::dot(axis, axis);
    const double along = square > 0 ? glm::clamp(glm::dot(p, axis) / square, 0.0, 1.0) : 0.0;
    const double thinnest = std::min({part.stretch.x, part.stretch.y, part.stretch.z});
    return (glm::length(p - along * axis) - glm::mix(part.radius_a, part.radius_b, along)) *
           thinnest;
}

// The smaller of two distances, blended where they differ by less than `blend`.
double smooth_min(double a, double b, double blend) {
    const double near = std::max(blend - std::abs(a - b), 0.0) / blend;
    return std::min(a, b) - 0.25 * blend * near * near;
}

// The parts of the middle and of both sides, each with a sphere that holds it.
class Body {
public:
    Body() {
        const auto add = [&](const Part& part) {
            parts_.push_back(part);
            const double stretch = std::max({part.stretch.x, part.stretch.y, part.stretch.z});
            spheres_.emplace_back(0.5 * (part.a + part.b),
                                  0.5 * glm::distance(part.a, part.b) +
                                      stretch * std::max(part.radius_a, part.radius_b));
        };
        for (const Part& part : middle_parts) add(part);
        for (std::size_t side = 0; side < 2; ++side)
            for (Part part : left_parts) {
                if (part.bone >= upper_arm) part.bone = static_cast<Bone>(part.bone + side);
                part.a = on_side(part.a, side);
                part.b = on_side(part.b, side);
                add(part);
            }
    }

    [[nodiscard]] double distance(const glm::dvec3& p) const {
        double nearest = std::numeric_limits<double>::max();
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            // Most parts are too far away to change the distance.
            const double reach = nearest + most_blend + spheres_[i].w;
            const glm::dvec3 from_centre = p - glm::dvec3(spheres_[i]);
            if (reach < 0 || glm::dot(from_centre, from_centre) > reach * reach) continue;
            nearest = smooth_min(nearest, distance_to(parts_[i], p), parts_[i].blend);
        }
        // Flat soles.
        return std::max(nearest, sole - p.y);
    }

    // The distance to the parts of each bone.
    [[nodiscard]] std::array<double, bone_count> bone_distances(const glm::dvec3& p) const {
        std::array<double, bone_count> distances;
        distances.fill(std::numeric_limits<double>::max());
        for (const Part& part : parts_)
            distances[part.bone] = std::min(distances[part.bone], distance_to(part, p));
        return distances;
    }

    static constexpr double most_blend = 0.08;
    static constexpr double sole = 0.004;

private:
    std::vector<Part> parts_;
    std::vector<glm::dvec4> spheres_;
};

std::array<float, bone_count> weights_of(const std::array<double, bone_count>& distances) {
    // Bones share a vertex where their parts are about as near.
    const double nearest = *std::min_element(distances.begin(), distances.end());
    std::array<double, bone_count> weights{};
    double sum = 0;
    for (std::size_t bone = 0; bone < bone_count; ++bone) {
        const double reach = bone == pelvis || bone == chest ? 0.08 : 0.05;
        const double share = std::max(0.0, 1 - (distances[bone] - nearest) / reach);
        weights[bone] = share * share;
        sum += weights[bone];
    }
    std::array<float, bone_count> normalised{};
    for (std::size_t bone = 0; bone < bone_count; ++bone)
        normalised[bone] = static_cast<float>(weights[bone] / sum);
    return normalised;
}

// What a point of the rest pose wears.
glm::u8vec4 colour_at(const glm::dvec3& p) {
    constexpr glm::u8vec4 skin(224, 172, 140, 255), hair(70, 48, 36, 255), shirt(178, 58, 50, 255),
        trousers(58, 76, 112, 255), shoes(60, 54, 52, 255), sole(225, 225, 220, 255);
    if (p.y > 1.525) {
        const bool is_eye =
            p.z > 0 && glm::distance(glm::abs(p), glm::dvec3(0.032, 1.672, 0.088)) < 0.012;
        const bool is_hair = p.y > 1.745 - 0.6 * std::abs(p.x) ||
                             (p.z < 0.01 && p.y > 1.6 && std::abs(p.x) < 0.085) ||
                             (p.z < -0.02 && p.y > 1.57);
        return is_hair || is_eye ? hair : skin;
    }
    const glm::dvec3 along_arm = glm::normalize(elbow - shoulder);
    const double down_arm = glm::dot(on_side(p, p.x < 0 ? 1 : 0) - shoulder, along_arm);
    if (std::abs(p.x) > 0.25 && down_arm > 0.2) return skin;
    if (p.y > 1.01) return shirt;
    if (p.y > 0.1) return trousers;
    return p.y < 0.016 ? sole : shoes;
}

glm::dmat4 turn_at(const glm::dvec3& joint, const glm::dmat4& turn) {
    return glm::translate(glm::dmat4(1), joint) * turn * glm::translate(glm::dmat4(1), -joint);
}

glm::dmat4 turn_x(double degrees) {
    return glm::rotate(glm::dmat4(1), glm::radians(degrees), {1, 0, 0});
}
glm::dmat4 turn_y(double degrees) {
    return glm::rotate(glm::dmat4(1), glm::radians(degrees), {0, 1, 0});
}
glm::dmat4 turn_z(double degrees) {
    return glm::rotate(glm::dmat4(1), glm::radians(degrees), {0, 0, 1});
}

// Takes a bone from its rest ends to these ends, on the shortest way.
glm::dmat4 span(const glm::dvec3& rest_a, const glm::dvec3& rest_b, const glm::dvec3& a,
                const glm::dvec3& b) {
    const glm::dvec3 from = glm::normalize(rest_b - rest_a), to = glm::normalize(b - a);
    const glm::dquat turn =
        glm::normalize(glm::dquat(1 + glm::dot(from, to), glm::cross(from, to)));
    return glm::translate(glm::dmat4(1), a) * glm::mat4_cast(turn) *
           glm::translate(glm::dmat4(1), -rest_a);
}

}  // namespace

BonePlaces place_bones(const Pose& pose) {
    BonePlaces places;
    places[pelvis] = glm::translate(glm::dmat4(1), pose.pelvis_move) *
                     turn_at({0, hip.y, 0}, turn_y(pose.pelvis_turn));
    places[chest] = glm::translate(glm::dmat4(1), pose.pelvis_move) *
                    turn_at(waist, turn_x(pose.lean) * turn_y(pose.chest_turn));
    // The head looks ahead.
    places[head] = places[chest] * turn_at(neck, turn_y(-pose.chest_turn) * turn_x(-pose.lean));
    for (std::size_t side = 0; side < 2; ++side) {
        // The arms hang almost straight down, then swing.
        const glm::dmat4 down = turn_z(side == 0 ? -33 : 33);
        const glm::dmat4 up = turn_z(side == 0 ? 33 : -33);
        places[upper_arm + side] = places[chest] * turn_at(on_side(shoulder, side),
                                                           turn_x(-pose.arm_forward[side]) * down);
        places[forearm + side] =
            places[upper_arm + side] *
            turn_at(on_side(elbow, side), up * turn_x(-pose.elbow[side]) * down);

        const FootPose& stand = pose.feet[side];
        const glm::dvec3 rest_hip = on_side(hip, side), rest_knee = on_side(knee, side),
                         rest_ankle = on_side(ankle, side);
        places[foot + side] = glm::translate(glm::dmat4(1), stand.move) *
                              turn_at(rest_ankle, turn_x(stand.pitch_degrees));
        const glm::dvec3 top(places[pelvis] * glm::dvec4(rest_hip, 1));
        const glm::dvec3 bottom = rest_ankle + stand.move;
        const double upper = glm::distance(hip, knee), lower = glm::distance(knee, ankle);
        const double reach = std::min(glm::distance(top, bottom), upper + lower);
        const glm::dvec3 along = glm::normalize(bottom - top);
        const double to_middle = (upper * upper - lower * lower + reach * reach) / (2 * reach);
        const double forward = std::sqrt(std::max(0.0, upper * upper - to_middle * to_middle));
        const glm::dvec3 ahead = glm::normalize(glm::dvec3(0, 0, 1) - along.z * along);
        const glm::dvec3 bent = top + to_middle * along + forward * ahead;
        places[thigh + side] = span(rest_hip, rest_knee, top, bent);
        places[shin + side] = span(rest_knee, rest_ankle, bent, bottom);
    }
    return places;
}

Figure make_figure(std::size_t triangles) {
    const Body body;
    const Solid solid{.distance = [&](const glm::dvec3& p) { return body.distance(p); },
                      .low = {-0.7, 0, -0.2},
                      .high = {0.7, 1.82, 0.22}};
    Figure figure;
    // The number of triangles is almost inverse to the square of the cell's side. Small steps find
    // the numbers of coarse figures, which vary more.
    double cell = 0.01;
    for (int round = 0; round < 20; ++round) {
        figure.skin = make_surface(solid, cell);
        const double ratio =
            static_cast<double>(figure.skin.triangles.size()) / static_cast<double>(triangles);
        if (std::abs(ratio - 1) < 0.005) break;
        cell *= std::pow(ratio, round < 2 ? 0.5 : 0.2);
    }
    for (const glm::dvec3& p : figure.skin.positions)
        figure.weights.push_back(weights_of(body.bone_distances(p)));
    for (const glm::uvec3& t : figure.skin.triangles)
        figure.colours.push_back(colour_at(
            (figure.skin.positions[t.x] + figure.skin.positions[t.y] + figure.skin.positions[t.z]) /
            3.0));
    return figure;
}

std::vector<glm::vec3> skin_positions(const Figure& figure, const BonePlaces& places) {
    std::vector<glm::vec3> positions;
    for (std::size_t i = 0; i < figure.skin.positions.size(); ++i) {
        const glm::dvec4 rest(figure.skin.positions[i], 1);
        glm::dvec3 sum(0);
        for (std::size_t bone = 0; bone < bone_count; ++bone)
            if (const float weight = figure.weights[i][bone]; weight > 0)
                sum += static_cast<double>(weight) * glm::dvec3(places[bone] * rest);
        positions.emplace_back(sum);
    }
    return positions;
}

}  // namespace motion
