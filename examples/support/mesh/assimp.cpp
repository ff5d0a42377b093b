#include <cmath>
#include <string>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "first_line.hpp"
#include "input_error.hpp"
#include "raw_mesh.hpp"
#include "read_file.hpp"
#include "text.hpp"

namespace support {
namespace {

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

void append_mesh(const aiMesh& source, const glm::dmat4& transform, RawMesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const glm::dmat3 linear(transform);
    // Cofactors instead of the inverse: normals of singular and of tiny transforms stay finite.
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    const bool mirrored = glm::determinant(linear) < 0;
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
        mesh.positions.emplace_back(transform * glm::dvec4(to_glm(source.mVertices[i]), 1.0));
        glm::dvec3 normal(0);
        if (source.HasNormals()) normal = cofactors * to_glm(source.mNormals[i]);
        const double length = glm::length(mirrored ? normal = -normal : normal);
        mesh.normals.emplace_back(length > 0 && std::isfinite(length) ? normal / length
                                                                      : glm::dvec3(0));
    }
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
        const aiFace& face = source.mFaces[f];
        for (unsigned k = 0; k < face.mNumIndices; ++k) {
            const unsigned index = face.mIndices[mirrored ? face.mNumIndices - 1 - k : k];
            mesh.corners.push_back(index < source.mNumVertices ? first + index
                                                               : RawMesh::no_vertex);
        }
        mesh.face_ends.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    }
}

// Nodes form a tree; the depth bound only guards against damaged files.
void append_node(const aiScene& scene, const aiNode& node, const glm::dmat4& parent, int depth,
                 RawMesh& mesh) {
    if (depth > 1000) return;
    const glm::dmat4 transform = parent * to_glm(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i)
        if (node.mMeshes[i] < scene.mNumMeshes)
            append_mesh(*scene.mMeshes[node.mMeshes[i]], transform, mesh);
    for (unsigned i = 0; i < node.mNumChildren; ++i)
        append_node(scene, *node.mChildren[i], transform, depth + 1, mesh);
}

// OBJ does not say how much there should be. A file that was cut off ends within a line, as some
// whole ones do; a vertex or face that lacks coordinates or corners is a sure sign.
bool ends_within_line(const std::filesystem::path& path, const std::string& text) {
    const std::string extension = path.extension().string();
    if ((extension != ".obj" && extension != ".OBJ") || text.back() == '\n') return false;
    TextCursor words(std::string_view(text).substr(text.rfind('\n') + 1));
    const std::string_view keyword = words.next_word();
    int count = 0;
    while (!words.next_word().empty()) ++count;
    if ((keyword == "f" || keyword == "v") && count < 3)
        throw InputError(quoted("mesh", path) + " is truncated: its last line '" +
                         std::string(keyword) + "' has " + std::to_string(count) +
                         " values, the least is 3");
    return true;
}

}  // namespace

RawMesh read_with_assimp(const std::filesystem::path& path, const std::string& text) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path.string(), 0);
    if (scene == nullptr || scene->mRootNode == nullptr)
        throw InputError(quoted("mesh", path) +
                         " cannot be read: " + first_line(importer.GetErrorString()));
    RawMesh mesh;
    mesh.ends_within_line = ends_within_line(path, text);
    append_node(*scene, *scene->mRootNode, glm::dmat4(1.0), 0, mesh);
    return mesh;
}

}  // namespace support
