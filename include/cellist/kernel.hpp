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
    /// Added to the build options, which start with "-cl-std=CL1.2 -cl-kernel-arg-info". Macros in
    /// these options do not change the library's own text.
    std::string options = {};
};

/// A kernel from the user's source, built for a device. A device keeps the last 128 programs, by
/// source, types and options, and builds each of them once. A source that includes the user's own
/// files, by #include or by the option "-include", is built for every Kernel, with the current
/// files. `#include <cellist/lists.clh>` and `<cellist/glm.clh>` need no path and do not count.
/// Movable, not copyable; every use of a moved-from Kernel throws Error.
class Kernel {
public:
    /// Builds `code` and takes the kernel called `name` from it. `uses` names the types that the
    /// source may use: containers, and cellist::type<T> for other adapted structs. Throws
    /// OpenClError with the compiler's log if the source does not build, if a struct's layout on
    /// the device differs, and if OpenCL C reserves the name of a struct or member. Throws Error if
    /// the source is empty, if two structs have the same name, or if the device lacks doubles that
    /// a struct has. Blocks while it compiles.
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
    /// elsewhere containers are read-only, and Lists::validate() counts the inserts that were
    /// refused.
    ///
    /// Arguments in the kernel's order: scalars, adapted structs, Buffer, Lists, cl::Buffer,
    /// cl::Image, cl::Pipe, cl::Sampler, LocalMemory. Throws Error if their number, or the kind,
    /// size, type or context of one does not fit the kernel's parameters; signs and the widths of
    /// vectors are not compared. Throws Error for a Range::local that is only partly 0, and for
    /// more local memory than the device has. Throws OpenClError if the launch fails. An argument
    /// with a pending build ends that build first, and then throws what the build throws.
    ///
    /// Lists and Buffers may belong to a Device with another queue of the same context. The kernel
    /// then waits for the commands that are on that queue, and later commands there wait for the
    /// kernel. Memory without a Device, such as a cl::Buffer, is not ordered: see
    /// Device::enqueue_wait.
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
