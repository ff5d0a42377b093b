// SPDX-License-Identifier: MIT
#include "gltf_skin.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace support {

std::vector<glm::dmat4> place_gltf_joints(GltfFile& file, const GltfValue& skin,
                                          const std::vector<glm::dmat4>& nodes) {
    const GltfValue joints = skin.at("joints");
    if (joints.size() == 0) joints.fail("is empty");
    std::optional<GltfAccessor> inverses;
    if (const auto accessor = skin.find("inverseBindMatrices")) {
        inverses.emplace(file, *accessor, std::initializer_list<std::string_view>{"MAT4"},
                         std::initializer_list<GltfFormat>{gltf_float32});
        if (inverses->size() < joints.size())
            accessor->fail("has " + std::to_string(inverses->size()) + " matrices for " +
                           std::to_string(joints.size()) + " joints");
    }
    std::vector<glm::dmat4> matrices;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        glm::dmat4 inverse(1);
        for (int i = 0; inverses && i < 16; ++i)
            inverse[i / 4][i % 4] = inverses->number(j, static_cast<std::size_t>(i));
        matrices.push_back(nodes[file.element_index("nodes", joints[j])] * inverse);
    }
    return matrices;
}

GltfSkin::GltfSkin(GltfFile& file, const std::vector<glm::dmat4>& joints,
                   const GltfValue& attributes, std::size_t vertices)
    : joints_(joints) {
    for (std::size_t number = 0;; ++number) {
        const auto joint_index = attributes.find("JOINTS_" + std::to_string(number));
        const auto weight_index = attributes.find("WEIGHTS_" + std::to_string(number));
        if (!joint_index || !weight_index) return;
        Influences set{
            {file, *joint_index, {"VEC4"}, {{GltfType::uint8, false}, {GltfType::uint16, false}}},
            {file, *weight_index, {"VEC4"}, {gltf_float32, gltf_unit_uint8, gltf_unit_uint16}}};
        if (set.joints.size() != vertices || set.weights.size() != vertices)
            joint_index->fail("does not have as many elements as POSITION");
        for (std::size_t v = 0; v < vertices; ++v)
            for (std::size_t i = 0; i < 4; ++i)
                if (set.joints.index(v, i) >= joints.size() && set.weights.number(v, i) != 0)
                    joint_index->fail("vertex " + std::to_string(v) + " follows joint " +
                                      std::to_string(set.joints.index(v, i)) + ", the skin has " +
                                      std::to_string(joints.size()));
        influences_.push_back(std::move(set));
    }
}

glm::dmat4 GltfSkin::matrix_of(std::size_t vertex) const {
    glm::dmat4 matrix(0);
    double sum = 0;
    for (const Influences& set : influences_)
        for (std::size_t i = 0; i < 4; ++i) {
            const double weight = set.weights.number(vertex, i);
            if (weight == 0) continue;
            matrix += joints_[set.joints.index(vertex, i)] * weight;
            sum += weight;
        }
    // The sum of the weights is 1 except for rounding.
    if (sum > 0) return matrix / sum;
    const std::size_t first = influences_[0].joints.index(vertex);
    return joints_[std::min(first, joints_.size() - 1)];
}

}  // namespace support
