#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include <cellist/buffer.hpp>
#include <cellist/struct.hpp>

namespace cellist {

/// A kernel argument: local memory of this size for each work-group.
struct LocalMemory {
    std::size_t size_bytes;
};

template <class T>
class Lists;

namespace detail {

/// What a Lists object hands to a kernel; defined by the library's sources.
class ListsCore;

/// The arguments of one launch, in order.
class Arguments {
public:
    enum class Kind { value, memory, sampler, local };
    struct Argument {
        Kind kind;
        std::size_t offset;  ///< into the bytes; unused for local memory
        std::size_t size;    ///< in bytes
    };

    template <class T>
        requires(std::is_arithmetic_v<T> || std::is_enum_v<T> || requires { DeviceType<T>::size; })
    void add(const T& value) {
        static_assert(!std::is_same_v<T, bool>, "OpenCL C has no bool parameters: pass a cl_uint");
        append(Kind::value, &value, sizeof value);
    }
    template <class T>
    void add(const Buffer<T>& buffer) {
        add(buffer.cl());
    }
    template <class T>
    void add(const Lists<T>& lists) {
        add_lists(lists.core());
    }
    void add(const cl::Memory& memory) {
        const cl_mem handle = memory();
        append(Kind::memory, &handle, sizeof handle);
    }
    void add(const cl::Sampler& sampler) {
        const cl_sampler handle = sampler();
        append(Kind::sampler, &handle, sizeof handle);
    }
    void add(const LocalMemory& local) { arguments_.push_back({Kind::local, 0, local.size_bytes}); }
    void append(Kind kind, const void* data, std::size_t size) {
        const std::size_t offset = bytes_.size();
        bytes_.resize(offset + size);
        std::memcpy(bytes_.data() + offset, data, size);
        arguments_.push_back({kind, offset, size});
    }

    /// Tells that a container among the arguments has this mode.
    void add_mode(cl_uint mode) { modes_ |= mode; }
    /// The modes of all containers among the arguments.
    [[nodiscard]] cl_uint modes() const { return modes_; }

    [[nodiscard]] std::span<const Argument> list() const { return arguments_; }
    [[nodiscard]] const std::byte* data(const Argument& argument) const {
        return argument.kind == Kind::local ? nullptr : bytes_.data() + argument.offset;
    }

private:
    void add_lists(const ListsCore& lists);

    std::vector<Argument> arguments_;
    std::vector<std::byte> bytes_;
    cl_uint modes_ = 0;
};

/// The mode in which a container is read.
[[nodiscard]] unsigned read_mode(const ListsCore& lists);

template <class T>
Definitions definitions_used(const Lists<T>& lists) {
    Definitions definitions = definitions_of<T>();
    definitions.modes = read_mode(lists.core());
    return definitions;
}
template <class T>
Definitions definitions_used(const Type<T>&) {
    return definitions_of<T>();
}

}  // namespace detail
}  // namespace cellist
