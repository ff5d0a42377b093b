// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <cellist/struct.hpp>

namespace cellist {

/// A value that an expression uses by its name, such as `query` in "distance(record.position,
/// query)". Kernels take values as arguments: a kernel is not compiled again for another value of
/// the same type.
class Value {
public:
    /// The types are those of members: scalars other than bool, `cl_` vectors, GLM's types and
    /// adapted structs, but not arrays. On the host `cl_float3` is `cl_float4`, so the expression
    /// sees a float4; Vector3<cl_float> is a float3.
    ///
    /// The calls that take values throw Error if a name is not an identifier of OpenCL C, is a
    /// keyword, is `record`, starts with "cellist_", or occurs twice.
    template <class T>
    Value(std::string name, const T& value)
        : name_(std::move(name)),
          type_(DeviceType<T>::name()),
          alignment_(DeviceType<T>::alignment),
          bytes_(sizeof(T)),
          define_(&DeviceType<T>::define) {
        static_assert(!std::is_same_v<T, bool>,
                      "OpenCL C has no bool of a fixed size: use cl_uint for the value");
        static_assert(detail::KnownOnDevice<T> || std::is_same_v<T, bool>,
                      "OpenCL C has no such type for the value: adapt it with CELLIST_STRUCT");
        static_assert(!std::is_array_v<T>,
                      "a value cannot be an array: make it a member of an adapted struct");
        std::memcpy(bytes_.data(), &value, sizeof value);
    }

    [[nodiscard]] const std::string& name() const { return name_; }

    /// @private The type in OpenCL C.
    [[nodiscard]] const std::string& type() const { return type_; }
    /// @private In OpenCL C, in bytes.
    [[nodiscard]] std::size_t alignment() const { return alignment_; }
    /// @private
    [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }
    /// @private Adds the definitions that the type needs.
    void define(detail::Definitions& definitions) const { define_(definitions); }

private:
    std::string name_;
    std::string type_;
    std::size_t alignment_;
    std::vector<std::byte> bytes_;
    void (*define_)(detail::Definitions&);
};

/// The values of an expression: `{{"query", point}, {"scale", 2.0f}}`.
using Values = std::vector<Value>;

}  // namespace cellist
