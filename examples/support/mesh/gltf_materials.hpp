// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "gltf_file.hpp"
#include "mesh.hpp"

namespace support {

/// What a glTF file says about the alpha of a surface.
enum class GltfAlpha { opaque, mask, blend };

struct GltfMaterial {
    MeshMaterial look;
    GltfAlpha alpha = GltfAlpha::blend;
    double factor_alpha = 1;
    double cutoff = 0.5;
    std::uint64_t textures = 0;  ///< of its base colour
};

[[nodiscard]] std::vector<GltfMaterial> read_gltf_materials(const GltfFile& file);

}  // namespace support
