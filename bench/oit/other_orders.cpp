// SPDX-License-Identifier: MIT
#include "oit/other_orders.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "frame/node_layout.hpp"
#include "image.hpp"
#include "reference/blend.hpp"

namespace bench {
namespace {

using Fragments = std::span<const oit::ReferenceFragment>;

double error_of(const glm::dvec3& colour, const cl_float4& pixel) {
    double error = 0;
    for (int channel = 0; channel < 3; ++channel)
        error = std::max(
            error, std::abs(support::srgb_from_linear(colour[channel]) -
                            support::srgb_from_linear(static_cast<double>(pixel.s[channel]))));
    return error;
}

// The light of a pixel's fragments in some order, without the background.
glm::dvec3 light_of(Fragments fragments, const std::vector<std::size_t>& order,
                    std::size_t samples) {
    const oit::ReferenceOptions options;
    glm::dvec3 sum(0);
    for (std::size_t sample = 0; sample < samples; ++sample) {
        oit::ReferenceLight light(1, options);
        for (const std::size_t i : order)
            if ((fragments[i].coverage >> sample & 1) != 0) light.add(fragments[i]);
        sum += light.end(glm::dvec3(0), std::numeric_limits<double>::infinity());
    }
    return sum / static_cast<double>(samples);
}

// The fragments from `first` up to `end` (exclusive), each close to the next.
struct Group {
    std::size_t first, end;
};

std::vector<Group> groups_of(Fragments fragments) {
    std::vector<Group> groups;
    for (std::size_t i = 0; i < fragments.size(); ++i) {
        const double depth = fragments[i].depth;
        if (i > 0 && depth - fragments[i - 1].depth <= oit::depth_resolution * depth)
            groups.back().end = i + 1;
        else
            groups.push_back({i, i + 1});
    }
    std::erase_if(groups, [](const Group& group) { return group.end - group.first < 2; });
    return groups;
}

// The next combination of orders within the groups; false after the last.
bool next_order(std::vector<std::size_t>& order, const std::vector<Group>& groups) {
    return std::ranges::any_of(groups, [&](const Group& group) {
        const auto at = [&](std::size_t i) {
            return order.begin() + static_cast<std::ptrdiff_t>(i);
        };
        return std::next_permutation(at(group.first), at(group.end));
    });
}

}  // namespace

// The background has the same effect in each order, because the light that passes is a product.
bool any_other_order(const oit::Reference& reference, std::size_t pixel, int samples, int most,
                     const std::function<bool(const glm::dvec3&)>& use) {
    const std::uint64_t first = reference.offsets[pixel];
    const Fragments fragments =
        Fragments(reference.fragments).subspan(first, reference.offsets[pixel + 1] - first);
    const std::vector<Group> groups = groups_of(fragments);
    std::vector<std::size_t> order(fragments.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto light = [&] {
        return light_of(fragments, order, static_cast<std::size_t>(samples));
    };
    const glm::dvec3 behind = reference.image[pixel] - light();
    for (int tried = 0; tried < most && next_order(order, groups); ++tried)
        if (use(behind + light())) return true;
    return false;
}

std::uint64_t pixels_of_another_order(const oit::Reference& reference,
                                      std::span<const cl_float4> image, int samples) {
    constexpr int most_orders = 100'000;  // of a pixel
    std::uint64_t count = 0;
    for (std::size_t p = 0; p < image.size(); ++p) {
        if (error_of(reference.image[p], image[p]) <= 1.0 / 255) continue;
        const auto is_near = [&](const glm::dvec3& colour) {
            return error_of(colour, image[p]) <= 1.0 / 255;
        };
        if (any_other_order(reference, p, samples, most_orders, is_near)) ++count;
    }
    return count;
}

}  // namespace bench
