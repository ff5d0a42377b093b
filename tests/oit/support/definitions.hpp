// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "reference/reference.hpp"

// The approximations as their papers define them, in double precision.
namespace cellist::test::defined {

using oit::ReferenceFragment;
/// Of a pixel, nearest first.
using Layers = std::span<const ReferenceFragment>;

struct Light {
    glm::dvec3 colour{0};
    double transmittance = 1;
};

inline double transmittance_of(Layers layers) {
    double passes = 1;
    for (const ReferenceFragment& layer : layers) passes *= 1 - layer.alpha;
    return passes;
}

/// A mean of all colours, by the natural logarithms of weights: no weight underflows.
inline Light weighted_mean(Layers layers, const std::vector<double>& logarithms) {
    const double greatest = *std::ranges::max_element(logarithms);
    Light light{.transmittance = transmittance_of(layers)};
    if (!std::isfinite(greatest)) return light;
    double sum = 0;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const double weight = std::exp(logarithms[i] - greatest);
        light.colour += weight * layers[i].colour;
        sum += weight;
    }
    light.colour *= (1 - light.transmittance) / sum;
    return light;
}

/// Depths of the transparent surfaces of a frame.
struct DepthBounds {
    double least, greatest;
};

/// McGuire, Bavoil 2013, equations 7 and 10.
inline Light weighted(Layers layers, const DepthBounds& bounds) {
    std::vector<double> logarithms;
    for (const ReferenceFragment& layer : layers) {
        const double near = 1 - (layer.depth - bounds.least) / (bounds.greatest - bounds.least);
        logarithms.push_back(std::log(layer.alpha) +
                             std::log(std::clamp(3e3 * near * near * near, 1e-2, 3e3)));
    }
    return weighted_mean(layers, logarithms);
}

/// Enderton et al. 2010 with more trials than can be drawn: a layer is seen where no nearer one
/// hides it. Layers of one depth do not hide each other.
inline Light stochastic(Layers layers) {
    std::vector<double> logarithms;
    for (const ReferenceFragment& layer : layers) {
        double logarithm = std::log(layer.alpha);
        for (const ReferenceFragment& other : layers)
            if (other.depth < layer.depth) logarithm += std::log1p(-other.alpha);
        logarithms.push_back(logarithm);
    }
    return weighted_mean(layers, logarithms);
}

/// The part of a distribution with these moments that lies in front of z (Muenstermann et al. 2018,
/// section 3.2): of the distribution at z and two other depths that has the moments, what is at
/// these if they are in front of z, and a quarter of what is at z.
inline double part_in_front(const std::array<double, 5>& moments, double z) {
    constexpr double bias = 5e-7, overestimation = 0.25;
    const std::array<double, 5> towards{1, 0, 0.375, 0, 0.375};
    std::array<double, 5> b{};
    for (std::size_t i = 0; i < b.size(); ++i)
        b[i] = (1 - bias) * moments[i] / moments[0] + bias * towards[i];
    const glm::dmat3 hankel{{b[0], b[1], b[2]}, {b[1], b[2], b[3]}, {b[2], b[3], b[4]}};
    const glm::dvec3 c = glm::inverse(hankel) * glm::dvec3(1, z, z * z);
    const double half = -0.5 * c.y / c.z;
    const double root = std::sqrt(std::max(0.0, half * half - c.x / c.z));
    const std::array<double, 3> at{z, half - root, half + root};
    const glm::dmat3 powers{
        {1, at[0], at[0] * at[0]}, {1, at[1], at[1] * at[1]}, {1, at[2], at[2] * at[2]}};
    const glm::dvec3 weights = glm::inverse(powers) * glm::dvec3(b[0], b[1], b[2]);
    double part = overestimation * weights[0];
    for (int i = 1; i < 3; ++i)
        if (at[static_cast<std::size_t>(i)] < z) part += weights[i];
    return std::clamp(part, 0.0, 1.0);
}

/// Muenstermann et al. 2018; absorbances end at 10, as in their code.
inline Light moments(Layers layers, const DepthBounds& bounds) {
    const auto z_of = [&](const ReferenceFragment& layer) {
        return 2 * std::log(layer.depth / bounds.least) / std::log(bounds.greatest / bounds.least) -
               1;
    };
    std::array<double, 5> sums{};
    for (const ReferenceFragment& layer : layers) {
        double power = std::min(10.0, -std::log1p(-layer.alpha));
        for (double& sum : sums) {
            sum += power;
            power *= z_of(layer);
        }
    }
    std::vector<double> logarithms;
    for (const ReferenceFragment& layer : layers)
        logarithms.push_back(std::log(layer.alpha) -
                             (sums[0] > 0 ? sums[0] * part_in_front(sums, z_of(layer)) : 0));
    return weighted_mean(layers, logarithms);
}

/// Salvi et al. 2011: steps behind which a part of the light comes through. Layers of one depth
/// make one step, and are blended in their order.
inline Light adaptive(Layers layers, std::size_t most_steps) {
    std::vector<std::pair<double, double>> steps;  // depth, part
    const auto limit = [&] {
        if (steps.size() <= most_steps) return;
        const auto area = [&](std::size_t i) {
            return (steps[i].first - steps[i - 1].first) * (steps[i - 1].second - steps[i].second);
        };
        std::size_t least = 1;
        for (std::size_t i = 2; i < steps.size(); ++i)
            if (area(i) < area(least)) least = i;
        steps[least - 1].second = steps[least].second;
        steps.erase(steps.begin() + static_cast<std::ptrdiff_t>(least));
    };
    Light light;
    for (std::size_t i = 0; i < layers.size();) {
        limit();
        const double depth = layers[i].depth;
        for (; i < layers.size() && layers[i].depth == depth; ++i)
            light.transmittance *= 1 - layers[i].alpha;
        steps.emplace_back(depth, light.transmittance);
    }
    limit();
    double passes = 1;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        if (i == 0 || layers[i].depth > layers[i - 1].depth) {
            passes = 1;
            for (const auto& [depth, part] : steps)
                if (depth < layers[i].depth) passes = part;
        }
        light.colour += passes * layers[i].alpha * layers[i].colour;
        passes *= 1 - layers[i].alpha;
    }
    return light;
}

/// Bavoil et al. 2007: the nearest layers, and nothing of the others.
inline Light nearest(Layers layers, std::size_t count) {
    Light light;
    for (const ReferenceFragment& layer : layers.first(std::min(count, layers.size()))) {
        light.colour += light.transmittance * layer.alpha * layer.colour;
        light.transmittance *= 1 - layer.alpha;
    }
    return light;
}

}  // namespace cellist::test::defined
