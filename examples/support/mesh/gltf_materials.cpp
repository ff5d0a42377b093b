// SPDX-License-Identifier: MIT
#include "gltf_materials.hpp"

#include <algorithm>
#include <optional>

#include "text.hpp"

namespace support {
namespace {

GltfMaterial read_material(const GltfValue& material) {
    GltfMaterial out;
    if (const auto name = material.find("name")) out.look.name = name->text();

    std::optional<GltfValue> look = material.find("pbrMetallicRoughness");
    const char* factor_key = "baseColorFactor";
    const char* texture_key = "baseColorTexture";
    if (const auto extensions = material.find("extensions"))
        if (auto specular = extensions->find("KHR_materials_pbrSpecularGlossiness")) {
            look = specular;
            factor_key = "diffuseFactor";
            texture_key = "diffuseTexture";
        }
    glm::dvec4 factor(1);
    if (look) {
        if (const auto value = look->find(factor_key)) {
            const std::vector<double> numbers = value->numbers(4);
            for (int i = 0; i < 4; ++i)
                factor[i] = std::clamp(numbers[static_cast<std::size_t>(i)], 0.0, 1.0);
        }
        if (look->find(texture_key)) ++out.textures;
    }
    out.look.base_colour = glm::vec3(factor);
    out.factor_alpha = factor.a;

    const auto mode = material.find("alphaMode");
    if (!mode || mode->text() == "OPAQUE")
        out.alpha = GltfAlpha::opaque;
    else if (mode->text() == "MASK")
        out.alpha = GltfAlpha::mask;
    else if (mode->text() != "BLEND")
        mode->fail("is '" + printable(mode->text()) + "', it may be OPAQUE, MASK or BLEND");
    if (const auto cutoff = material.find("alphaCutoff")) out.cutoff = cutoff->number();
    out.look.opacity = out.alpha == GltfAlpha::blend ? static_cast<float>(factor.a) : 1.0F;
    return out;
}

}  // namespace

std::vector<GltfMaterial> read_gltf_materials(const GltfFile& file) {
    std::vector<GltfMaterial> materials;
    for (std::size_t i = 0; i < file.count("materials"); ++i)
        materials.push_back(read_material(file.root().at("materials")[i]));
    return materials;
}

}  // namespace support
