// SPDX-License-Identifier: MIT
#include "raw_mesh_bytes.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "input_error.hpp"

namespace support {
namespace {

class Writer {
public:
    template <typename T>
    void operator()(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    }
    template <typename T>
    void operator()(const std::vector<T>& values) {
        (*this)(static_cast<std::uint64_t>(values.size()));
        if constexpr (std::is_trivially_copyable_v<T>)
            bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        else
            for (const T& value : values) (*this)(value);
    }
    void operator()(const std::string& text) {
        (*this)(static_cast<std::uint64_t>(text.size()));
        bytes_ += text;
    }
    void operator()(const MeshMaterial& material) {
        (*this)(material.name);
        (*this)(material.base_colour);
        (*this)(material.opacity);
    }

    [[nodiscard]] std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
};

class RawMeshReader {
public:
    explicit RawMeshReader(std::string_view bytes) : bytes_(bytes) {}

    template <typename T>
    void operator()(T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    }
    template <typename T>
    void operator()(std::vector<T>& values) {
        const std::uint64_t count = this->count();
        if constexpr (std::is_trivially_copyable_v<T>) {
            const std::string_view bytes = take(count * sizeof(T));
            values.resize(count);
            if (count > 0)
                std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
        } else {
            for (std::uint64_t i = 0; i < count; ++i) (*this)(values.emplace_back());
        }
    }
    void operator()(std::string& text) { text = take(count()); }
    void operator()(MeshMaterial& material) {
        (*this)(material.name);
        (*this)(material.base_colour);
        (*this)(material.opacity);
    }

private:
    std::uint64_t count() {
        std::uint64_t value = 0;
        (*this)(value);
        if (value > bytes_.size()) throw InputError("its result is damaged");
        return value;
    }
    std::string_view take(std::size_t bytes) {
        if (bytes > bytes_.size()) throw InputError("its result is damaged");
        const std::string_view taken = bytes_.substr(0, bytes);
        bytes_.remove_prefix(bytes);
        return taken;
    }

    std::string_view bytes_;
};

// Reads or writes all members of a mesh.
template <typename Stream, typename M>
void transfer(Stream& stream, M& mesh) {
    stream(mesh.positions);
    stream(mesh.normals);
    stream(mesh.colours);
    stream(mesh.corners);
    stream(mesh.face_ends);
    stream(mesh.face_materials);
    stream(mesh.materials);
    stream(mesh.drops);
    stream(mesh.ends_within_line);
    stream(mesh.ignored_textures);
    stream(mesh.up);
    stream(mesh.notes);
}

bool arrays_match(const RawMesh& mesh) {
    const auto of_vertices = [&](std::size_t size) {
        return size == 0 || size == mesh.positions.size();
    };
    const std::size_t last = mesh.face_ends.empty() ? 0 : mesh.face_ends.back();
    return of_vertices(mesh.normals.size()) && of_vertices(mesh.colours.size()) &&
           last == mesh.corners.size() &&
           std::is_sorted(mesh.face_ends.begin(), mesh.face_ends.end()) &&
           (mesh.face_materials.empty() || mesh.face_materials.size() == mesh.face_ends.size()) &&
           std::all_of(mesh.face_materials.begin(), mesh.face_materials.end(),
                       [&](std::uint32_t material) { return material < mesh.materials.size(); });
}

}  // namespace

std::string bytes_of(const RawMesh& mesh) {
    Writer writer;
    transfer(writer, mesh);
    return writer.take();
}

RawMesh raw_mesh_from(std::string_view bytes) {
    RawMesh mesh;
    RawMeshReader reader(bytes);
    transfer(reader, mesh);
    if (!arrays_match(mesh)) throw InputError("its result is damaged");
    return mesh;
}

}  // namespace support
