#include "mesh.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <string>
#include <unordered_map>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "first_line.hpp"
#include "input_error.hpp"

namespace support {
namespace {

bool is_finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

glm::vec3 to_glm(const aiVector3D& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

glm::dmat4 to_glm(const aiMatrix4x4& m) {
    glm::dmat4 out;
    for (unsigned row = 0; row < 4; ++row)
        for (unsigned column = 0; column < 4; ++column)
            out[static_cast<int>(column)][static_cast<int>(row)] =
                static_cast<double>(m[row][column]);
    return out;
}

// Takes out what triangulation could stumble on: faces that use a vertex that does not exist or is
// not finite, points and lines.
void drop_bad_faces(aiMesh& mesh, MeshDrops& drops) {
    std::vector<bool> finite(mesh.mNumVertices);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        finite[i] = is_finite(to_glm(mesh.mVertices[i]));
        if (!finite[i]) ++drops.nonfinite_vertices;
    }
    unsigned kept = 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        const unsigned* begin = face.mIndices;
        const unsigned* end = begin + face.mNumIndices;
        const auto bad = [&](unsigned index) { return index >= mesh.mNumVertices; };
        if (face.mNumIndices < 3)
            ++drops.points_and_lines;
        else if (std::any_of(begin, end, bad))
            ++drops.out_of_range_triangles;
        else if (std::any_of(begin, end, [&](unsigned index) { return !finite[index]; }))
            ++drops.nonfinite_triangles;
        else
            std::swap(mesh.mFaces[kept++], mesh.mFaces[f]);
    }
    mesh.mNumFaces = kept;
}

void append_mesh(const aiMesh& source, const glm::dmat4& transform, Mesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const glm::dmat3 linear(transform);
    // Cofactors instead of the inverse: normals of singular and of tiny transforms stay finite.
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    const bool mirrored = glm::determinant(linear) < 0;
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
        mesh.positions.emplace_back(transform *
                                    glm::dvec4(glm::dvec3(to_glm(source.mVertices[i])), 1.0));
        glm::dvec3 normal(0);
        if (source.HasNormals()) normal = cofactors * glm::dvec3(to_glm(source.mNormals[i]));
        const double length = glm::length(mirrored ? normal = -normal : normal);
        mesh.normals.emplace_back(length > 0 && std::isfinite(length) ? normal / length
                                                                      : glm::dvec3(0));
    }
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
        const aiFace& face = source.mFaces[f];
        if (face.mNumIndices != 3) continue;
        std::array<std::uint32_t, 3> triangle{};
        for (std::size_t k = 0; k < 3; ++k) triangle[k] = first + face.mIndices[k];
        if (mirrored) std::swap(triangle[1], triangle[2]);
        mesh.triangles.push_back(triangle);
    }
}

// Nodes form a tree; the depth bound only guards against damaged files.
void append_node(const aiScene& scene, const aiNode& node, const glm::dmat4& parent, int depth,
                 Mesh& mesh) {
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
bool ends_within_line(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    if (extension != ".obj" && extension != ".OBJ") return false;
    std::ifstream file(path, std::ios::binary);
    constexpr std::streamoff tail_bytes = 1024;
    file.seekg(0, std::ios::end);
    file.seekg(-std::min<std::streamoff>(tail_bytes, file.tellg()), std::ios::end);
    const std::string tail{std::istreambuf_iterator<char>(file), {}};
    if (tail.empty() || tail.back() == '\n') return false;
    std::istringstream line(tail.substr(tail.rfind('\n') + 1));
    std::string keyword, word;
    line >> keyword;
    int words = 0;
    while (line >> word) ++words;
    if ((keyword == "f" || keyword == "v") && words < 3)
        throw InputError("mesh '" + path.string() + "' is truncated: its last line '" + keyword +
                         "' has " + std::to_string(words) + " values, the least is 3");
    return true;
}

struct VertexKey {
    std::array<std::uint32_t, 6> bits;
    bool operator==(const VertexKey&) const = default;
};

struct VertexKeyHash {
    std::size_t operator()(const VertexKey& key) const {
        std::uint64_t hash = 0xCBF29CE484222325;
        for (const std::uint32_t word : key.bits) {
            hash = (hash ^ word) * 0x100000001B3;
            hash ^= hash >> 29;
        }
        return static_cast<std::size_t>(hash);
    }
};

VertexKey key_of(const glm::vec3& position, const glm::vec3& normal) {
    VertexKey key{};
    for (int i = 0; i < 3; ++i) {
        // -0 and +0 are the same place.
        key.bits[static_cast<std::size_t>(i)] = std::bit_cast<std::uint32_t>(position[i] + 0.0F);
        key.bits[static_cast<std::size_t>(i) + 3] = std::bit_cast<std::uint32_t>(normal[i] + 0.0F);
    }
    return key;
}

// Area-weighted mean of the normals of the triangles around each vertex.
std::vector<glm::dvec3> face_normals_by_vertex(const Mesh& mesh) {
    double scale = 0;
    for (const glm::vec3& p : mesh.positions)
        for (int i = 0; i < 3; ++i) scale = std::max(scale, std::abs(static_cast<double>(p[i])));
    if (scale == 0) scale = 1;
    std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0));
    for (const auto& t : mesh.triangles) {
        const glm::dvec3 a = glm::dvec3(mesh.positions[t[0]]) / scale;
        const glm::dvec3 b = glm::dvec3(mesh.positions[t[1]]) / scale;
        const glm::dvec3 c = glm::dvec3(mesh.positions[t[2]]) / scale;
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        for (const std::uint32_t vertex : t) sums[vertex] += normal;
    }
    return sums;
}

void complete_normals(Mesh& mesh) {
    if (std::none_of(mesh.normals.begin(), mesh.normals.end(),
                     [](const glm::vec3& n) { return n == glm::vec3(0); }))
        return;
    const std::vector<glm::dvec3> sums = face_normals_by_vertex(mesh);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        if (mesh.normals[i] != glm::vec3(0)) continue;
        const double length = glm::length(sums[i]);
        mesh.normals[i] = length > 0 ? glm::vec3(sums[i] / length) : glm::vec3(0, 1, 0);
    }
}

void turn_towards_normals(Mesh& mesh) {
    for (auto& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
        const glm::dvec3 corner_normals = glm::dvec3(mesh.normals[t[0]]) +
                                          glm::dvec3(mesh.normals[t[1]]) +
                                          glm::dvec3(mesh.normals[t[2]]);
        if (glm::dot(glm::cross(b - a, c - a), corner_normals) < 0) std::swap(t[1], t[2]);
    }
}

}  // namespace

Mesh clean_mesh(const Mesh& source) {
    Mesh mesh;
    mesh.drops = source.drops;
    mesh.ends_within_line = source.ends_within_line;
    std::unordered_map<VertexKey, std::uint32_t, VertexKeyHash> merged;
    merged.reserve(source.positions.size());
    constexpr std::uint32_t unusable = 0xFFFFFFFF;
    std::vector<std::uint32_t> renumbered(source.positions.size(), unusable);
    for (std::size_t i = 0; i < source.positions.size(); ++i) {
        const glm::vec3& position = source.positions[i];
        const bool has_normal = i < source.normals.size() && is_finite(source.normals[i]);
        const glm::vec3 normal = has_normal ? source.normals[i] : glm::vec3(0);
        if (!is_finite(position)) {
            ++mesh.drops.nonfinite_vertices;
            continue;
        }
        const auto [entry, is_new] = merged.try_emplace(
            key_of(position, normal), static_cast<std::uint32_t>(mesh.positions.size()));
        if (is_new) {
            mesh.positions.push_back(position);
            mesh.normals.push_back(normal);
        }
        renumbered[i] = entry->second;
    }
    for (const auto& t : source.triangles) {
        if (std::any_of(t.begin(), t.end(), [&](auto v) { return v >= renumbered.size(); })) {
            ++mesh.drops.out_of_range_triangles;
            continue;
        }
        const std::array<std::uint32_t, 3> out{renumbered[t[0]], renumbered[t[1]],
                                               renumbered[t[2]]};
        if (out[0] == unusable || out[1] == unusable || out[2] == unusable)
            ++mesh.drops.nonfinite_triangles;
        else if (out[0] == out[1] || out[1] == out[2] || out[2] == out[0])
            ++mesh.drops.degenerate_triangles;
        else
            mesh.triangles.push_back(out);
    }
    complete_normals(mesh);
    turn_towards_normals(mesh);
    // Coincident triangles then start at the same corner, whatever their winding, and the
    // rasteriser gives them equal depths to the last bit.
    for (auto& t : mesh.triangles)
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return mesh;
}

Mesh load_mesh(const std::filesystem::path& path) {
    const std::string quoted = "mesh '" + path.string() + "'";
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) throw InputError(quoted + " does not exist");
    if (std::filesystem::is_directory(status)) throw InputError(quoted + " is a folder");
    if (!std::ifstream(path, std::ios::binary)) throw InputError(quoted + " cannot be read");
    if (std::filesystem::file_size(path, error) == 0 && !error)
        throw InputError(quoted + " is empty (0 bytes)");
    check_ply_is_complete(path);
    const bool cut_short = ends_within_line(path);

    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path.string(), 0);
    if (scene == nullptr)
        throw InputError(quoted + " cannot be read: " + first_line(importer.GetErrorString()));

    Mesh raw;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) drop_bad_faces(*scene->mMeshes[m], raw.drops);
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
    if (scene == nullptr || scene->mRootNode == nullptr)
        throw InputError(quoted + " cannot be read: " + first_line(importer.GetErrorString()));

    append_node(*scene, *scene->mRootNode, glm::dmat4(1.0), 0, raw);
    if (raw.positions.size() >= std::numeric_limits<std::uint32_t>::max())
        throw InputError(quoted + " has " + std::to_string(raw.positions.size()) +
                         " vertices, the limit is 4294967294");
    const std::uint64_t counted = raw.drops.nonfinite_vertices;
    raw.ends_within_line = cut_short;
    Mesh mesh = clean_mesh(raw);
    mesh.drops.nonfinite_vertices = std::max(counted, mesh.drops.nonfinite_vertices - counted);
    if (mesh.triangles.empty())
        throw InputError(quoted + " has no triangle that can be drawn (" +
                         std::to_string(mesh.positions.size()) + " vertices, " +
                         std::to_string(mesh.drops.triangles()) + " triangles dropped)");
    return mesh;
}

void fit_to_unit_sphere(Mesh& mesh) {
    if (mesh.positions.empty()) return;
    // Steps towards the farthest vertex, each shorter than the one before (Badoiu and Clarkson
    // 2003).
    glm::dvec3 low(mesh.positions.front()), high = low;
    for (const glm::vec3& p : mesh.positions) {
        low = glm::min(low, glm::dvec3(p));
        high = glm::max(high, glm::dvec3(p));
    }
    glm::dvec3 centre = 0.5 * (low + high);
    double radius = 0;
    for (int step = 1; step <= 64; ++step) {
        glm::dvec3 farthest = centre;
        radius = 0;
        for (const glm::vec3& p : mesh.positions) {
            const double distance = glm::length(glm::dvec3(p) - centre);
            if (distance > radius) {
                radius = distance;
                farthest = p;
            }
        }
        if (step < 64) centre += (farthest - centre) / (step + 1.0);
    }
    const double scale = radius > 0 ? 1 / radius : 1;
    for (glm::vec3& p : mesh.positions) p = glm::vec3((glm::dvec3(p) - centre) * scale);
}

}  // namespace support
