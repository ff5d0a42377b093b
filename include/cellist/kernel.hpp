#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <cellist/detail/arguments.hpp>
#include <cellist/detail/owned.hpp>
#include <cellist/device.hpp>
#include <cellist/range.hpp>
#include <cellist/struct.hpp>

namespace cellist {

/// The OpenCL C source of a program.
struct Source {
    std::string text = {};
    /// Stands before the line numbers in the compiler's messages.
    std::string file_name = "kernel";
    /// Added to the build options, which start with "-cl-std=CL1.2 -cl-kernel-arg-info". Macros that
    /// they define do not change the library's own text.
    std::string options = {};
};

/// A kernel of the user's, built for a device. A device keeps the last programs, by source, types and
/// options, and builds each of them once. A source with an #include of its own, or "-include" among its
/// options, is built for every Kernel, with the files as they are then.
/// `#include <cellist/lists.clh>` and `<cellist/glm.clh>` need no path and do not count. Movable, not
/// copyable; every use of a Kernel that was moved from throws Error.
class Kernel {
public:
    /// Builds `code` and takes the kernel called `name` from it. `uses` names the types that the
    /// source may use: containers, and cellist::type<T> for other adapted structs. Throws OpenClError
    /// with the compiler's log where the source does not build, where a struct's layout on the device
    /// differs, and where OpenCL C reserves the name of a struct or member. Blocks while it compiles.
    template <class... Uses>
    Kernel(const Device& device, const Source& code, const std::string& name, const Uses&... uses)
        : Kernel(device.state(), code, name, definitions_of(uses...)) {}
    template <class... Uses>
    Kernel(const Device& device, std::string_view code, const std::string& name,
           const Uses&... uses)
        : Kernel(device, Source{.text = std::string(code)}, name, uses...) {}

    Kernel(Kernel&&) noexcept;
    Kernel& operator=(Kernel&&) noexcept;
    Kernel(const Kernel&) = delete;
    Kernel& operator=(const Kernel&) = delete;
    ~Kernel();

    /// Enqueues the kernel over a range. Does not block. Kernels insert inside of build() only:
    /// elsewhere containers are read-only, and Lists::validate() counts the inserts that were refused.
    ///
    /// Arguments in the kernel's order: scalars, adapted structs, Buffer, Lists, cl::Buffer, cl::Image,
    /// cl::Pipe, cl::Sampler, LocalMemory. Throws Error if their number, or the kind, size or type of
    /// one does not fit the kernel's parameters; signs and the widths of vectors are not compared.
    ///
    /// Lists and Buffers of a Device with another queue of the same context are ordered by events: the
    /// kernel waits for that queue, and that queue for the kernel. Memory without an owner, such as a
    /// cl::Buffer, is the caller's to order: see Device::enqueue_wait.
    template <class... Args>
    cl::Event run(const Range& range, const Args&... args) {
        detail::Arguments arguments;
        (arguments.add(args), ...);
        cl::Event event;
        enqueue(range, arguments, &event);
        return event;
    }

    [[nodiscard]] const std::string& name() const;

    /// @private
    Kernel(std::shared_ptr<detail::DeviceState> device, const Source& code, const std::string& name,
           const detail::Definitions& definitions);
    /// @private Without an event, it takes less time.
    void enqueue(const Range& range, const detail::Arguments& arguments,
                 cl::Event* event = nullptr);

private:
    template <class... Uses>
    static detail::Definitions definitions_of(const Uses&... uses) {
        detail::Definitions all;
        (all.add(detail::definitions_used(uses)), ...);
        return all;
    }

    struct Impl;
    detail::Owned<std::unique_ptr<Impl>> impl_;
};

}  // namespace cellist
