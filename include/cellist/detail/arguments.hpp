// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <cellist/buffer.hpp>
#include <cellist/detail/api.hpp>
#include <cellist/struct.hpp>

namespace cellist {

/// A kernel argument: local memory of this size for each work-group.
struct LocalMemory {
    std::size_t size_bytes;
};

template <class T>
class Lists;

namespace detail {

/// The part of a Lists object that does not depend on the record type.
class ListsCore;

class Arguments;

/// Another container than Lists: one of <cellist/mpi.hpp>.
template <class C>
concept Container = requires(const C& container, Arguments& arguments) {
    container.add_to(arguments);
    { container.definitions() } -> std::same_as<Definitions>;
};

/// The arguments of one launch, in order.
class CELLIST_API Arguments {
public:
    enum class Kind { value, memory, sampler, local };
    struct Argument {
        Kind kind;
        std::size_t offset;  ///< into the bytes; unused for local memory
        std::size_t size;    ///< in bytes
        std::string type;   ///< in OpenCL C: of a value, of a buffer's elements; empty if not known
        bool is_container;  ///< the nodes of a container, which hold records of this type
        /// The device whose queue orders the uses of this memory; null for the user's own memory.
        const DeviceState* owner;
    };
    /// A container that takes no inserts: no build of it is under way.
    struct ClosedLists {
        std::weak_ptr<const ListsCore> lists;
        std::size_t index;  ///< of the argument that has its nodes
    };

    /// With room for what most kernels take.
    Arguments() {
        arguments_.reserve(24);
        bytes_.reserve(384);
    }

    template <class T>
    void add(const T& value) {
        static_assert(!std::is_same_v<T, bool>, "OpenCL C has no bool parameters: pass a cl_uint");
        static_assert(KnownOnDevice<T> || std::is_same_v<T, bool>,
                      "kernels take scalars, adapted structs, cellist::Buffer, cellist::Lists, "
                      "cl::Buffer, cl::Image, cl::Sampler and cellist::LocalMemory");
        append(Kind::value, &value, sizeof value);
        arguments_.back().type = DeviceType<T>::name();
    }
    template <class T>
    void add(const Buffer<T>& buffer) {
        add(buffer.memory());
        if constexpr (KnownOnDevice<T>) arguments_.back().type = DeviceType<T>::name();
    }
    template <class T>
    void add(const Lists<T>& lists) {
        add_lists(lists.core());
    }
    template <Container C>
    void add(const C& container) {
        container.add_to(*this);
    }
    template <std::derived_from<cl::Memory> M>
    void add(const M& memory) {
        const cl_mem handle = memory();
        append(Kind::memory, &handle, sizeof handle);
    }
    void add(const Memory& memory) {
        add(memory.cl());
        arguments_.back().owner = memory.device().get();
    }
    void add(const cl::Sampler& sampler) {
        const cl_sampler handle = sampler();
        append(Kind::sampler, &handle, sizeof handle);
    }
    void add(const LocalMemory& local) {
        arguments_.push_back({Kind::local, 0, local.size_bytes, {}, false, nullptr});
    }
    void append(Kind kind, const void* data, std::size_t size) {
        const std::size_t offset = bytes_.size();
        bytes_.resize(offset + size);
        std::memcpy(bytes_.data() + offset, data, size);
        arguments_.push_back({kind, offset, size, {}, false, nullptr});
    }

    /// Appends the arguments of another launch.
    void append(const Arguments& others) { append(others, 0, others.arguments_.size()); }
    /// Appends `count` of them, from `first` on.
    void append(const Arguments& others, std::size_t first, std::size_t count) {
        for (const ClosedLists& closed : others.closed_)
            if (closed.index - first < count)
                closed_.push_back({closed.lists, closed.index - first + arguments_.size()});
        for (const Argument& argument : others.list().subspan(first, count)) {
            arguments_.push_back(argument);
            arguments_.back().offset = bytes_.size();
            if (argument.kind == Kind::local) continue;
            const auto begin = others.bytes_.begin() + static_cast<std::ptrdiff_t>(argument.offset);
            bytes_.insert(bytes_.end(), begin, begin + static_cast<std::ptrdiff_t>(argument.size));
        }
        modes_ |= others.modes_;
    }

    /// The nodes of a container of records of this type.
    void add_nodes(const Memory& nodes, const std::string& record) {
        add(nodes);
        arguments_.back().type = record;
        arguments_.back().is_container = true;
    }
    /// Sets the type of the last argument.
    void set_type(const std::string& type) { arguments_.back().type = type; }
    /// Tells that a container among the arguments has this mode.
    void add_mode(cl_uint mode) { modes_ |= mode; }
    /// The modes of all containers among the arguments.
    [[nodiscard]] cl_uint modes() const { return modes_; }

    [[nodiscard]] std::span<const Argument> list() const { return arguments_; }
    [[nodiscard]] std::span<const ClosedLists> closed_lists() const { return closed_; }
    [[nodiscard]] const std::byte* data(const Argument& argument) const {
        return argument.kind == Kind::local ? nullptr : bytes_.data() + argument.offset;
    }

    void add_lists(const ListsCore& lists);  // in lists_core.cpp

private:
    std::vector<Argument> arguments_;
    std::vector<ClosedLists> closed_;
    std::vector<std::byte> bytes_;
    cl_uint modes_ = 0;
};

/// The mode in which a container is read.
[[nodiscard]] CELLIST_API unsigned read_mode(const ListsCore& lists);  // in lists_core.cpp

template <class T>
Definitions definitions_used(const Lists<T>& lists) {
    Definitions definitions = definitions_of_record<T>();
    definitions.modes = read_mode(lists.core());
    return definitions;
}
template <class T>
Definitions definitions_used(const Type<T>&) {
    return definitions_of_record<T>();
}
template <Container C>
Definitions definitions_used(const C& container) {
    return container.definitions();
}

}  // namespace detail
}  // namespace cellist
