// SPDX-License-Identifier: MIT
#pragma once
// Allows GLM's vectors and matrices as members of adapted structs.
//
// GLM packs its types: vec3 takes 12 bytes, and each type has the alignment of its scalar. Kernels
// see structs of the same layout, which cellist/glm.clh defines. glm::vec3 becomes a cellist_vec3
// with members x, y, z, and cellist_float3(v) converts it to a float3. glm::mat4 becomes a
// cellist_mat4 with four cellist_vec4 columns. GLM_FORCE_DEFAULT_ALIGNED_GENTYPES is not supported.

#include <string>
#include <type_traits>
#include <vector>

#include <glm/mat2x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cellist/struct.hpp>

namespace cellist {

namespace detail {

/// The prefix of "vec" and "mat" for a scalar: "", "i", "u" or "d"; nullptr for other scalars.
template <class T>
constexpr const char* glm_prefix() {
    if constexpr (std::is_same_v<T, float>)
        return "";
    else if constexpr (std::is_same_v<T, int>)
        return "i";
    else if constexpr (std::is_same_v<T, unsigned>)
        return "u";
    else if constexpr (std::is_same_v<T, double>)
        return "d";
    else
        return nullptr;
}

template <class T>
void define_glm(Definitions& definitions) {
    DeviceType<T>::define(definitions);
    definitions.add(glm_source());
}

}  // namespace detail

template <glm::length_t count, class T>
    requires(detail::glm_prefix<T>() != nullptr)
struct DeviceType<glm::vec<count, T, glm::defaultp>> {
    static_assert(sizeof(glm::vec<count, T, glm::defaultp>) == count * sizeof(T),
                  "cellist needs GLM's packed types");
    static constexpr std::size_t size = count * sizeof(T);
    static constexpr std::size_t alignment = sizeof(T);
    static std::string name() {
        return std::string("cellist_") + detail::glm_prefix<T>() + "vec" + std::to_string(count);
    }
    static void define(detail::Definitions& definitions) { detail::define_glm<T>(definitions); }
    static void add_scalars(const std::string& path, std::vector<std::string>& scalars) {
        for (glm::length_t i = 0; i < count; ++i) scalars.push_back(path + "." + "xyzw"[i]);
    }
};

template <glm::length_t count, class T>
    requires(detail::glm_prefix<T>() != nullptr && std::is_floating_point_v<T>)
struct DeviceType<glm::mat<count, count, T, glm::defaultp>> {
    using Column = DeviceType<glm::vec<count, T, glm::defaultp>>;
    static constexpr std::size_t size = count * Column::size;
    static constexpr std::size_t alignment = Column::alignment;
    static std::string name() {
        return std::string("cellist_") + detail::glm_prefix<T>() + "mat" + std::to_string(count);
    }
    static void define(detail::Definitions& definitions) { detail::define_glm<T>(definitions); }
    static void add_scalars(const std::string& path, std::vector<std::string>& scalars) {
        for (glm::length_t i = 0; i < count; ++i)
            Column::add_scalars(
                std::string(path).append(".columns[").append(std::to_string(i)).append("]"),
                scalars);
    }
};

}  // namespace cellist
