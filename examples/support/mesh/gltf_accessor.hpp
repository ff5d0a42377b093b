// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "gltf_file.hpp"
#include "gltf_value.hpp"

namespace support {

/// Component types, by their numbers in the file.
enum class GltfType {
    int8 = 5120,
    uint8 = 5121,
    int16 = 5122,
    uint16 = 5123,
    uint32 = 5125,
    float32 = 5126
};

/// How the components of an accessor become numbers.
struct GltfFormat {
    GltfType type;
    bool is_normalized;
    bool operator==(const GltfFormat&) const = default;
};

inline constexpr GltfFormat gltf_float32{GltfType::float32, false};
inline constexpr GltfFormat gltf_unit_uint8{GltfType::uint8, true};
inline constexpr GltfFormat gltf_unit_uint16{GltfType::uint16, true};

/// The elements of an accessor, all of them checked to lie within their buffer. Refers to the
/// buffers of a GltfFile, which must outlive it.
class GltfAccessor {
public:
    /// `shape` is "SCALAR", "VEC3" and so on. Throws InputError with the accessor's place if it has
    /// another shape, a format that is not among `formats`, or elements beyond its buffer.
    GltfAccessor(GltfFile& file, const GltfValue& index,
                 std::initializer_list<std::string_view> shapes,
                 std::initializer_list<GltfFormat> formats);

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] std::size_t components() const { return components_; }
    [[nodiscard]] double number(std::size_t element, std::size_t component) const;
    [[nodiscard]] std::uint32_t index(std::size_t element, std::size_t component = 0) const {
        return static_cast<std::uint32_t>(number(element, component));
    }

private:
    void read_view(GltfFile& file, const GltfValue& accessor);
    void replace_sparse(GltfFile& file, const GltfValue& sparse);

    std::size_t size_ = 0, components_ = 0, element_bytes_ = 0;
    GltfFormat format_{};
    std::string_view bytes_;   // from the first element on; empty where `owned_` has the elements
    std::vector<char> owned_;  // elements of sparse accessors and of those without a buffer
    std::size_t stride_ = 0;
};

/// Elements of an accessor without reading them.
[[nodiscard]] std::size_t gltf_accessor_size(const GltfFile& file, const GltfValue& index);

}  // namespace support
