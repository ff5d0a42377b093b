// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "beside.hpp"
#include "child_process.hpp"
#include "first_line.hpp"
#include "input_error.hpp"
#include "placement.hpp"
#include "raw_mesh.hpp"
#include "raw_mesh_bytes.hpp"
#include "read_file.hpp"
#include "text.hpp"

namespace support {
namespace {

constexpr std::uint64_t most_bytes_of_file = std::uint64_t{1} << 30;

// The file system that Assimp sees: the mesh, which is in memory, and regular files in its folder.
class FolderFiles final : public Assimp::IOSystem {
public:
    FolderFiles(const std::filesystem::path& path, const std::string& text,
                std::set<std::string>& refused)
        : path_(path), text_(text), refused_(refused) {}

    bool Exists(const char* name) const override { return is_mesh(name) || find(name); }
    char getOsSeparator() const override { return '/'; }
    void Close(Assimp::IOStream* stream) override { delete stream; }

    Assimp::IOStream* Open(const char* name, const char* mode) override {
        if (std::strpbrk(mode, "wa+") != nullptr) return nullptr;
        if (is_mesh(name))
            return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text_.data()),
                                              text_.size());
        const std::optional<std::filesystem::path> file = find(name);
        if (!file) return nullptr;
        try {
            const std::string bytes = read_file("file", *file, most_bytes_of_file);
            auto copy = std::make_unique<std::uint8_t[]>(bytes.size());
            std::memcpy(copy.get(), bytes.data(), bytes.size());
            return new Assimp::MemoryIOStream(copy.release(), bytes.size(), true);
        } catch (const InputError&) {
            return nullptr;
        }
    }

private:
    [[nodiscard]] bool is_mesh(const char* name) const { return path_.filename() == name; }

    [[nodiscard]] std::optional<std::filesystem::path> find(const char* name) const {
        std::string with_slashes(name);
        std::replace(with_slashes.begin(), with_slashes.end(), '\\', '/');
        std::optional<std::filesystem::path> file = path_beside(path_, with_slashes);
        std::error_code error;
        if (!file) refused_.insert(printable(name));
        if (!file || !std::filesystem::is_regular_file(*file, error)) return std::nullopt;
        return file;
    }

    const std::filesystem::path& path_;
    const std::string& text_;
    std::set<std::string>& refused_;
};

glm::dvec3 to_glm(const aiVector3D& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

glm::dmat4 to_glm(const aiMatrix4x4& m) {
    glm::dmat4 out;
    for (unsigned row = 0; row < 4; ++row)
        for (unsigned column = 0; column < 4; ++column)
            out[static_cast<int>(column)][static_cast<int>(row)] =
                static_cast<double>(m[row][column]);
    return out;
}

// Turns what Assimp read into polygons, placed by the transforms of their nodes.
class SceneReader {
public:
    explicit SceneReader(const aiScene& scene) : scene_(scene) {}

    RawMesh read() {
        read_materials();
        struct Placed {
            const aiNode* node;
            glm::dmat4 transform;
        };
        std::vector<Placed> stack{{scene_.mRootNode, to_glm(scene_.mRootNode->mTransformation)}};
        while (!stack.empty()) {
            const Placed placed = stack.back();
            stack.pop_back();
            for (unsigned i = 0; i < placed.node->mNumMeshes; ++i)
                if (placed.node->mMeshes[i] < scene_.mNumMeshes)
                    append_mesh(*scene_.mMeshes[placed.node->mMeshes[i]], placed.transform);
            for (unsigned i = 0; i < placed.node->mNumChildren; ++i)
                stack.push_back(
                    {placed.node->mChildren[i],
                     placed.transform * to_glm(placed.node->mChildren[i]->mTransformation)});
        }
        for (std::size_t i = 0; i < textures_.size(); ++i)
            if (is_used_[i]) mesh_.ignored_textures += textures_[i];
        if (poses_ > 0)
            mesh_.notes.push_back("meshes with joints or morph targets, which are not applied: " +
                                  std::to_string(poses_));
        return std::move(mesh_);
    }

private:
    void read_materials() {
        for (unsigned i = 0; i < scene_.mNumMaterials; ++i) {
            const aiMaterial& source = *scene_.mMaterials[i];
            MeshMaterial& material = mesh_.materials.emplace_back();
            aiString name;
            if (source.Get(AI_MATKEY_NAME, name) == AI_SUCCESS) material.name = name.C_Str();
            textures_.push_back(source.GetTextureCount(aiTextureType_DIFFUSE) +
                                source.GetTextureCount(aiTextureType_BASE_COLOR) +
                                source.GetTextureCount(aiTextureType_OPACITY));
            // Skips the default material that Assimp adds to files without materials.
            if (material.name == AI_DEFAULT_MATERIAL_NAME) continue;
            aiColor4D colour;
            float opacity = 1;
            const bool has_colour = source.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == AI_SUCCESS;
            if (has_colour)
                material.base_colour =
                    glm::clamp(glm::vec3(colour.r, colour.g, colour.b), 0.0F, 1.0F);
            if (source.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS)
                material.opacity = std::clamp(opacity, 0.0F, 1.0F);
            else if (has_colour && colour.a < 1)
                material.opacity = std::clamp(colour.a, 0.0F, 1.0F);
        }
        is_used_.resize(textures_.size());
    }

    void append_mesh(const aiMesh& source, const glm::dmat4& transform) {
        if (source.mNumBones > 0 || source.mNumAnimMeshes > 0) ++poses_;
        const std::size_t first = mesh_.positions.size();
        const Placement placement(transform);
        append_vertices(source, placement);
        for (unsigned f = 0; f < source.mNumFaces; ++f) {
            const aiFace& face = source.mFaces[f];
            if (face.mNumIndices < 3) {
                ++mesh_.drops.points_and_lines;
                continue;
            }
            for (unsigned k = 0; k < face.mNumIndices; ++k) {
                const unsigned index =
                    face.mIndices[placement.mirrors() ? face.mNumIndices - 1 - k : k];
                mesh_.corners.push_back(index < source.mNumVertices
                                            ? static_cast<std::uint32_t>(first + index)
                                            : RawMesh::no_vertex);
            }
            mesh_.face_ends.push_back(static_cast<std::uint32_t>(mesh_.corners.size()));
            mesh_.face_materials.push_back(source.mMaterialIndex);
        }
        if (mesh_.is_too_large())
            throw InputError("it has more than 4294967294 vertices or corners, the limit");
        if (source.mMaterialIndex < is_used_.size()) is_used_[source.mMaterialIndex] = true;
    }

    void append_vertices(const aiMesh& source, const Placement& placement) {
        for (unsigned i = 0; i < source.mNumVertices; ++i)
            placement.add(to_glm(source.mVertices[i]),
                          source.HasNormals() ? to_glm(source.mNormals[i]) : glm::dvec3(0), mesh_);
        if (!source.HasVertexColors(0) && mesh_.colours.empty()) return;
        mesh_.colours.resize(mesh_.positions.size(), glm::vec4(1));
        if (!source.HasVertexColors(0)) return;
        for (unsigned i = 0; i < source.mNumVertices; ++i) {
            const aiColor4D& colour = source.mColors[0][i];
            const auto channel = [](float value) {
                return value > 0 ? static_cast<double>(std::min(value, 1.0F)) : 0.0;
            };
            mesh_.colours[mesh_.positions.size() - source.mNumVertices + i] = {
                linear_from_srgb(channel(colour.r)), linear_from_srgb(channel(colour.g)),
                linear_from_srgb(channel(colour.b)), to_float(channel(colour.a))};
        }
    }

    const aiScene& scene_;
    RawMesh mesh_;
    std::vector<std::uint64_t> textures_;  // of each material
    std::vector<bool> is_used_;
    std::uint64_t poses_ = 0;
};

// Assimp turns COLLADA and 3DS files so that y points up. For FBX files it reports the axis.
UpAxis up_axis(const aiScene& scene, const std::string& extension) {
    if (extension == ".dae" || extension == ".3ds") return UpAxis::y;
    int axis = -1, sign = 1;
    if (scene.mMetaData == nullptr || !scene.mMetaData->Get("UpAxis", axis)) return UpAxis::unknown;
    (void)scene.mMetaData->Get("UpAxisSign", sign);
    if (sign < 0) return UpAxis::unknown;
    return axis == 0 ? UpAxis::x : axis == 1 ? UpAxis::y : axis == 2 ? UpAxis::z : UpAxis::unknown;
}

// Formats that have a reader of their own never go through Assimp, whatever a file is called.
void leave_out_own_formats(Assimp::Importer& importer) {
    for (const char* extension : {"gltf", "glb", "obj", "off", "ply", "stl"})
        while (Assimp::BaseImporter* loader = importer.GetImporter(extension))
            if (importer.UnregisterLoader(loader) != AI_SUCCESS) break;
}

RawMesh import(const std::filesystem::path& path, const std::string& text) {
    std::set<std::string> refused;
    Assimp::Importer importer;
    leave_out_own_formats(importer);
    importer.SetIOHandler(new FolderFiles(path, text, refused));
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    const aiScene* scene = importer.ReadFile(path.filename().string(), 0);
    if (scene == nullptr || scene->mRootNode == nullptr)
        throw InputError(first_line(importer.GetErrorString()));
    RawMesh mesh = SceneReader(*scene).read();
    mesh.up = up_axis(*scene, path.extension().string());
    for (const std::string& name : refused)
        mesh.notes.push_back("file '" + name + "' is not in the mesh's folder and was not read");
    return mesh;
}

}  // namespace

RawMesh read_with_assimp(const std::filesystem::path& path, const std::string& text) {
    // Loaders hold several copies of a mesh while they read it.
    const ChildLimits limits{30 + static_cast<unsigned>(text.size() >> 20),
                             (std::uint64_t{1} << 31) + 64 * text.size(),
                             (std::uint64_t{1} << 30) + 64 * text.size()};
    try {
        return raw_mesh_from(run_in_child([&] { return bytes_of(import(path, text)); }, limits));
    } catch (const InputError& error) {
        throw InputError(quoted("mesh", path) + " cannot be read by Assimp: " + error.what());
    }
}

}  // namespace support
