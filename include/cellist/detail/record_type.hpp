// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <cellist/detail/api.hpp>

namespace cellist::detail {

/// A member of an adapted struct, as OpenCL C sees it.
struct RecordMember {
    std::string name;                  ///< empty for a record that is no struct
    std::string type;                  ///< e.g. "float4"
    std::string extents;               ///< e.g. "[4][2]" for an array
    std::size_t offset = 0;            ///< on the host, in bytes
    std::vector<std::string> scalars;  ///< paths of its scalars, in order, e.g. ".position.s0"
    bool is_scalar = false;            ///< may serve as a key
};

/// A type of records, as OpenCL C sees it: an adapted struct, or a type with one nameless member.
struct CELLIST_API RecordType {
    std::string name;
    std::size_t size = 0;
    std::size_t alignment = 1;
    std::vector<RecordMember> members;
    bool is_struct = true;

    /// The type in OpenCL C, e.g. "struct Hit" or "uint".
    [[nodiscard]] std::string type() const { return (is_struct ? "struct " : "") + name; }
    /// The OpenCL C source that defines the struct and checks its layout.
    [[nodiscard]] std::string definition() const;
};

/// The types that a program needs, each after the types that it is made of.
struct CELLIST_API Definitions {
    std::vector<RecordType> records;
    std::vector<std::string> texts;  ///< definitions of types that are not records, in order
    bool needs_fp64 = false;
    unsigned modes = 0;  ///< of the containers that the program is built for, as in view.h

    /// Adds a record, a text or everything in `other` unless it is there already. Throws Error if a
    /// different record has the same name.
    void add(const RecordType& record);
    void add(const std::string& text);
    void add(const Definitions& other);

    /// The OpenCL C source that defines the types, checks their layout, and gives each record its
    /// order and the container's functions.
    [[nodiscard]] std::string source() const;
};

/// The node that holds a record: the record, a 32-bit link, padding to the alignment.
struct NodeLayout {
    std::size_t size;
    std::size_t alignment;
};
[[nodiscard]] CELLIST_API NodeLayout node_layout(const RecordType& record);

/// The device's definitions of GLM's types, for Definitions::texts.
[[nodiscard]] CELLIST_API std::string glm_source();

}  // namespace cellist::detail
