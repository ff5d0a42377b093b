// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>

#include "raw_mesh.hpp"

namespace support {

/// Makes a material for each colour of the faces.
class ColourTable {
public:
    explicit ColourTable(RawMesh& mesh) : mesh_(mesh) {}

    /// The material of this linear colour and opacity. Leaves the opacity unset if the file has
    /// none.
    std::uint32_t material_of(const glm::vec4& colour, bool has_opacity) {
        const auto [entry, is_new] =
            materials_.try_emplace({colour.r, colour.g, colour.b, colour.a},
                                   static_cast<std::uint32_t>(mesh_.materials.size()));
        if (is_new) {
            MeshMaterial material;
            material.base_colour = glm::vec3(colour);
            if (has_opacity) material.opacity = colour.a;
            mesh_.materials.push_back(material);
        }
        return entry->second;
    }

private:
    RawMesh& mesh_;
    std::map<std::tuple<float, float, float, float>, std::uint32_t> materials_;
};

/// Gives all faces a material with opacity 1, so that only the opacities of the vertices count.
inline void take_opacity_of_vertices(RawMesh& mesh) {
    MeshMaterial material;
    material.opacity = 1.0F;
    mesh.materials = {material};
    mesh.face_materials.assign(mesh.face_ends.size(), 0);
}

}  // namespace support
