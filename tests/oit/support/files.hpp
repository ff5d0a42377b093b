// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "mesh.hpp"

namespace cellist::test {

/// A new folder that is removed with everything in it.
class Folder {
public:
    Folder() {
        std::string name = (std::filesystem::temp_directory_path() / "cellist-oit-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
        path_ = name;
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() {
        std::error_code error;
        std::filesystem::remove_all(path_, error);
    }
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
        return path_ / name;
    }
    /// Writes a file and returns its path.
    [[nodiscard]] std::filesystem::path write(const std::string& name,
                                              const std::string& text) const {
        std::ofstream(path_ / name, std::ios::binary) << text;
        return path_ / name;
    }

private:
    std::filesystem::path path_;
};

inline std::string read_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

template <class T>
void append_bytes(std::string& out, const T& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

inline std::string obj_text(const support::Mesh& mesh) {
    std::string text;
    for (const glm::vec3& p : mesh.positions)
        text += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) +
                "\n";
    for (const auto& t : mesh.triangles)
        text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
                std::to_string(t[2] + 1) + "\n";
    return text;
}

inline std::string ply_header(const support::Mesh& mesh, const std::string& format) {
    return "ply\nformat " + format + " 1.0\nelement vertex " +
           std::to_string(mesh.positions.size()) +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
           std::to_string(mesh.triangles.size()) +
           "\nproperty list uchar uint vertex_indices\nend_header\n";
}

inline std::string ply_text(const support::Mesh& mesh) {
    std::string text = ply_header(mesh, "ascii");
    for (const glm::vec3& p : mesh.positions)
        text += std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
    for (const auto& t : mesh.triangles)
        text += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " +
                std::to_string(t[2]) + "\n";
    return text;
}

/// Little-endian, as the machines that run the tests.
inline std::string ply_binary(const support::Mesh& mesh) {
    std::string bytes = ply_header(mesh, "binary_little_endian");
    for (const glm::vec3& p : mesh.positions) append_bytes(bytes, p);
    for (const auto& t : mesh.triangles) {
        bytes.push_back(3);
        append_bytes(bytes, t);
    }
    return bytes;
}

inline std::string stl_binary(const support::Mesh& mesh) {
    std::string bytes(80, ' ');
    append_bytes(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const auto& t : mesh.triangles) {
        append_bytes(bytes, glm::vec3(0));
        for (const std::uint32_t vertex : t) append_bytes(bytes, mesh.positions[vertex]);
        append_bytes(bytes, std::uint16_t{0});
    }
    return bytes;
}

}  // namespace cellist::test
