// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <string>
#include <tuple>
#include <type_traits>

#include <cellist/detail/for_each.hpp>
#include <cellist/detail/record_type.hpp>
#include <cellist/opencl.hpp>
#include <cellist/types.hpp>

/// Adapts a struct: kernels know it by its own name, with the same members at the same offsets.
///
///     struct Hit { cl_float depth; cl_uint id; };
///     CELLIST_STRUCT(Hit, depth, id);
///
/// Put it in the namespace of the struct, and name every member in order of declaration. Members
/// are scalars, `cl_` vectors, arrays, and other adapted structs. Scalars are `cl_float`,
/// `cl_uint`, ..., the C++ types of the same size, and enums, but not bool. `<cellist/glm.hpp>`
/// adds GLM's types. On the host `cl_float3` is `cl_float4`, so a kernel sees a float4, and
/// `cl_half` is `cl_ushort`. Use Vector3<cl_float> and Half, from <cellist/types.hpp>.
///
/// The struct must be trivially copyable and have standard layout. The host compiler checks the
/// offsets against OpenCL C's rules, and each kernel build checks them with the device's compiler.
#define CELLIST_STRUCT(type, ...)                                                                  \
    constexpr auto cellist_describe(const type*) {                                                 \
        return ::cellist::detail::describe<type>(                                                  \
            #type CELLIST_FOR_EACH(CELLIST_STRUCT_MEMBER, type, __VA_ARGS__));                     \
    }                                                                                              \
    static_assert(std::is_trivially_copyable_v<type> && std::is_standard_layout_v<type>,           \
                  "CELLIST_STRUCT: " #type " must be trivially copyable and of standard layout");  \
    static_assert(::cellist::detail::is_plain_name(#type),                                         \
                  "CELLIST_STRUCT stands in the struct's own namespace, with its plain name");     \
    static_assert(!CELLIST_STRUCT_HAS_MORE(type, __VA_ARGS__),                                     \
                  "CELLIST_STRUCT: " #type " has more members than are named");                    \
    static_assert(cellist_describe(static_cast<const type*>(nullptr)).matches_device_layout(),     \
                  "CELLIST_STRUCT: the layout of " #type                                           \
                  " differs from OpenCL C's: name every member, in order of declaration, and use " \
                  "types that are aligned as on the device")

// True if an aggregate takes one more initialiser than there are named members. For a struct with
// constructors, a structured binding with the same number of names fails to compile if there are
// more.
#define CELLIST_STRUCT_HAS_MORE(type, ...)                                                         \
    []<class T>(const T*) {                                                                        \
        if constexpr (std::is_aggregate_v<T> &&                                                    \
                      requires { T{CELLIST_FOR_EACH(CELLIST_STRUCT_BRACES, type, __VA_ARGS__)}; }) \
            return requires { T{CELLIST_FOR_EACH(CELLIST_STRUCT_BRACES, type, __VA_ARGS__){}}; };  \
        else {                                                                                     \
            (void)[](const T& cellist_value) {                                                     \
                [[maybe_unused]] const auto& [CELLIST_STRUCT_NAMES(type, __VA_ARGS__)] =           \
                    cellist_value;                                                                 \
            };                                                                                     \
            return false;                                                                          \
        }                                                                                          \
    }(static_cast<const type*>(nullptr))
#define CELLIST_STRUCT_BRACES(type, member) {},
#define CELLIST_STRUCT_NAMES(type, first, ...)                                                     \
    cellist_member_##first CELLIST_FOR_EACH(CELLIST_STRUCT_NAME, type, __VA_ARGS__)
#define CELLIST_STRUCT_NAME(type, member) , cellist_member_##member

#define CELLIST_STRUCT_MEMBER(type, member)                                                        \
    , ::cellist::detail::member_of<type, decltype(type::member)>(#member, &type::member,           \
                                                                 offsetof(type, member))

namespace cellist {

/// How a C++ type appears in OpenCL C. Specialise it for a type that is not your own struct (see
/// <cellist/glm.hpp>). Members:
///   static constexpr std::size_t size, alignment;          by OpenCL C's rules
///   static std::string name();                             e.g. "float4"
///   static void define(detail::Definitions&);              adds the definitions for the name
///   static void add_scalars(const std::string& path, std::vector<std::string>&);
///                                                          the scalars of a value, in order
template <class T>
struct DeviceType;

/// Names a type of records that a kernel uses without a container:
/// `Kernel(device, source, "draw", fragments, cellist::type<Camera>)`.
template <class T>
struct Type {};
template <class T>
inline constexpr Type<T> type{};

namespace detail {

constexpr bool is_plain_name(const char* name) {
    for (; *name != '\0'; ++name)
        if (*name == ':' || *name == '<') return false;
    return true;
}

constexpr std::size_t round_up(std::size_t value, std::size_t multiple) {
    return (value + multiple - 1) / multiple * multiple;
}

template <class Owner, class M>
struct Member {
    const char* name;
    M Owner::*pointer;
    std::size_t offset;
    using type = M;
};

template <class Owner, class M>
constexpr Member<Owner, M> member_of(const char* name, M Owner::*pointer, std::size_t offset) {
    return {name, pointer, offset};
}

/// A type that kernels know: a scalar, a vector, an adapted struct, or an array of these.
template <class T>
concept KnownOnDevice = requires {
    DeviceType<T>::size;
};

template <class T, class... Members>
struct Description {
    const char* name;
    std::tuple<Members...> members;

    /// True if OpenCL C puts the members where the host has them.
    [[nodiscard]] constexpr bool matches_device_layout() const {
        std::size_t end = 0;
        std::size_t alignment = 1;
        bool same = true;
        std::apply(
            [&](const auto&... member) {
                (([&] {
                     using M = typename std::remove_cvref_t<decltype(member)>::type;
                     static_assert(KnownOnDevice<M>,
                                   "CELLIST_STRUCT: a member's type has no counterpart in OpenCL "
                                   "C: use scalars other than bool, cl_ vectors, arrays, and "
                                   "structs that are adapted before");
                     using OnDevice = DeviceType<M>;
                     end = round_up(end, OnDevice::alignment);
                     same = same && end == member.offset;
                     end += OnDevice::size;
                     alignment = alignment > OnDevice::alignment ? alignment : OnDevice::alignment;
                 }()),
                 ...);
            },
            members);
        return same && alignment == alignof(T) && round_up(end, alignment) == sizeof(T);
    }
};

template <class T, class... Members>
constexpr Description<T, Members...> describe(const char* name, Members... members) {
    return {name, {members...}};
}

template <class T>
concept Adapted = requires {
    cellist_describe(static_cast<const T*>(nullptr));
};

template <Adapted T>
inline constexpr auto description = cellist_describe(static_cast<const T*>(nullptr));

/// The name of a scalar in OpenCL C, by kind and size; nullptr if OpenCL C has no such type.
template <class T>
constexpr const char* scalar_name() {
    if constexpr (std::is_same_v<T, bool>)
        return nullptr;  // has no fixed size in OpenCL C
    else if constexpr (std::is_enum_v<T>)
        return scalar_name<std::underlying_type_t<T>>();
    else if constexpr (std::is_same_v<T, Half>)
        return "cellist_half";
    else if constexpr (std::is_same_v<T, float>)
        return "float";
    else if constexpr (std::is_same_v<T, double>)
        return "double";
    else if constexpr (std::is_integral_v<T>) {
        constexpr std::array names{"char", "uchar", "short", "ushort",
                                   "int",  "uint",  "long",  "ulong"};
        return names[2 * (std::bit_width(sizeof(T)) - 1) + (std::is_unsigned_v<T> ? 1 : 0)];
    } else
        return nullptr;
}

template <class T>
concept Scalar = (scalar_name<T>() != nullptr);

}  // namespace detail

template <detail::Scalar T>
struct DeviceType<T> {
    static constexpr std::size_t size = sizeof(T);
    static constexpr std::size_t alignment = sizeof(T);
    static std::string name() { return detail::scalar_name<T>(); }
    static void define(detail::Definitions& definitions) {
        if constexpr (std::is_same_v<T, double>) definitions.needs_fp64 = true;
    }
    static void add_scalars(const std::string& path, std::vector<std::string>& scalars) {
        scalars.push_back(path);
    }
};

template <class T, std::size_t count>
struct DeviceType<T[count]> {
    static constexpr std::size_t size = DeviceType<T>::size * count;
    static constexpr std::size_t alignment = DeviceType<T>::alignment;
    static std::string name() { return DeviceType<T>::name(); }
    static std::string extents() {
        return std::string("[").append(std::to_string(count)).append("]").append(inner_extents());
    }
    static void define(detail::Definitions& definitions) { DeviceType<T>::define(definitions); }
    static void add_scalars(const std::string& path, std::vector<std::string>& scalars) {
        for (std::size_t i = 0; i < count; ++i)
            DeviceType<T>::add_scalars(
                std::string(path).append("[").append(std::to_string(i)).append("]"), scalars);
    }

private:
    static std::string inner_extents() {
        if constexpr (std::is_array_v<T>)
            return DeviceType<T>::extents();
        else
            return {};
    }
};

template <detail::Adapted T>
struct DeviceType<T> {
    static constexpr std::size_t size = sizeof(T);
    static constexpr std::size_t alignment = alignof(T);
    static std::string name() { return detail::description<T>.name; }
    static void define(detail::Definitions& definitions) {
        detail::RecordType record{name(), size, alignment, {}, true};
        std::apply([&](const auto&... member) { (add_member(member, record, definitions), ...); },
                   detail::description<T>.members);
        definitions.add(record);
    }
    static void add_scalars(const std::string& path, std::vector<std::string>& scalars) {
        std::apply(
            [&](const auto&... member) {
                (DeviceType<typename std::remove_cvref_t<decltype(member)>::type>::add_scalars(
                     path + "." + member.name, scalars),
                 ...);
            },
            detail::description<T>.members);
    }

private:
    template <class M>
    static void add_member(const detail::Member<T, M>& member, detail::RecordType& record,
                           detail::Definitions& definitions) {
        using OnDevice = DeviceType<M>;
        OnDevice::define(definitions);
        detail::RecordMember out{member.name, OnDevice::name(), {}, member.offset, {}, false};
        if constexpr (std::is_array_v<M>) out.extents = OnDevice::extents();
        if constexpr (detail::Scalar<M>) out.is_scalar = true;
        OnDevice::add_scalars(std::string(".") + member.name, out.scalars);
        record.members.push_back(std::move(out));
    }
};

template <detail::Scalar T>
struct DeviceType<Vector3<T>> {
    static_assert(!std::is_same_v<T, Half>, "OpenCL C has no vectors of cellist_half");
    static constexpr std::size_t size = sizeof(Vector3<T>);
    static constexpr std::size_t alignment = alignof(Vector3<T>);
    static std::string name() { return DeviceType<T>::name() + "3"; }
    static void define(detail::Definitions& definitions) { DeviceType<T>::define(definitions); }
    static void add_scalars(const std::string& path, std::vector<std::string>& scalars) {
        for (const char* const part : {".x", ".y", ".z"}) scalars.push_back(path + part);
    }
};

/// @private The cl_ vectors.
#define CELLIST_VECTOR_TYPE(base, count)                                                           \
    template <>                                                                                    \
    struct DeviceType<cl_##base##count> {                                                          \
        static constexpr std::size_t size = sizeof(cl_##base##count);                              \
        static constexpr std::size_t alignment = sizeof(cl_##base##count);                         \
        static std::string name() { return #base #count; }                                         \
        static void define(detail::Definitions& definitions) {                                     \
            DeviceType<cl_##base>::define(definitions);                                            \
        }                                                                                          \
        static void add_scalars(const std::string& path, std::vector<std::string>& scalars) {      \
            for (std::size_t i = 0; i < count; ++i)                                                \
                scalars.push_back(path + ".s" + "0123456789abcdef"[i]);                            \
        }                                                                                          \
    };
#define CELLIST_VECTOR_TYPES(base)                                                                 \
    CELLIST_VECTOR_TYPE(base, 2)                                                                   \
    CELLIST_VECTOR_TYPE(base, 4) CELLIST_VECTOR_TYPE(base, 8) CELLIST_VECTOR_TYPE(base, 16)
CELLIST_VECTOR_TYPES(char)
CELLIST_VECTOR_TYPES(uchar)
CELLIST_VECTOR_TYPES(short)
CELLIST_VECTOR_TYPES(ushort)
CELLIST_VECTOR_TYPES(int)
CELLIST_VECTOR_TYPES(uint)
CELLIST_VECTOR_TYPES(long)
CELLIST_VECTOR_TYPES(ulong)
CELLIST_VECTOR_TYPES(float)
CELLIST_VECTOR_TYPES(double)
#undef CELLIST_VECTOR_TYPES
#undef CELLIST_VECTOR_TYPE

namespace detail {

/// The definitions that a program needs to use T.
template <class T>
Definitions definitions_of() {
    Definitions definitions;
    DeviceType<T>::define(definitions);
    return definitions;
}

/// A type of records: any type that kernels know, except arrays.
template <class T>
concept Record = KnownOnDevice<T> && !std::is_array_v<T>;

/// The definitions that a program needs to use lists of T.
template <Record T>
Definitions definitions_of_record() {
    Definitions definitions = definitions_of<T>();
    if constexpr (!Adapted<T>) {
        using OnDevice = DeviceType<T>;
        RecordMember value{"", OnDevice::name(), {}, 0, {}, Scalar<T>};
        OnDevice::add_scalars("", value.scalars);
        definitions.add({OnDevice::name(), OnDevice::size, OnDevice::alignment, {value}, false});
    }
    return definitions;
}

/// The name of the member that a pointer to member selects.
template <Adapted T, class M>
const char* member_name(M T::*pointer) {
    const char* name = "";
    std::apply(
        [&](const auto&... member) {
            (([&] {
                 if constexpr (std::is_same_v<typename std::remove_cvref_t<decltype(member)>::type,
                                              M>)
                     if (member.pointer == pointer) name = member.name;
             }()),
             ...);
        },
        description<T>.members);
    return name;
}

}  // namespace detail
}  // namespace cellist
