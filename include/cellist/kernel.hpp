// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <cellist/detail/api.hpp>
#include <cellist/detail/arguments.hpp>
#include <cellist/detail/owned.hpp>
#include <cellist/device.hpp>
#include <cellist/range.hpp>
#include <cellist/struct.hpp>

namespace cellist {

/// The OpenCL C source of a program.
struct Source {
    std::string text = {};
    /// The file name in the compiler's messages.
    std::string file_name = "kernel";
    /// Build options, after "-cl-std=CL1.2 -cl-kernel-arg-info". Macros in these options do not
    /// change the library's own text.
    std::string options = {};

    /// Reads the text from a file. Throws Error with the system's reason if that fails.
    ///
    ///     Kernel bin(device, Source::from_file("kernels/bin.cl"), "bin", bins);
    [[nodiscard]] CELLIST_API static Source from_file(const std::string& path,
                                                      const std::string& options = {});
};

/// A kernel from the user's source, built for a device. Movable, not copyable. Using a moved-from
/// Kernel throws Error.
///
/// A device caches the last 128 programs, by source, types and options, and files in the user's
/// cache directory keep more of them: see Device::prepare and docs/devices.md. Neither keeps a
/// source that includes the user's own files, by a directive or by the option "-include". Each
/// Kernel compiles such a source again from the current files. `#include <cellist/lists.clh>` and
/// `<cellist/glm.clh>` need no path and do not prevent caching.
class CELLIST_API Kernel {
public:
    /// Compiles `code` and takes the kernel `name` from it. `uses` names the types that the source
    /// may use: containers, and cellist::type<T> for other adapted structs. Blocks while it
    /// compiles.
    ///
    /// Throws OpenClError with the compiler's log if the source does not compile or has no such
    /// kernel, if the device lays a struct out differently, or if OpenCL C reserves the name of a
    /// struct or member. Throws Error if the source is empty, if two structs have the same name, or
    /// if a struct has doubles and the device does not.
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

    /// Enqueues the kernel over a range. Does not block, except to finish a pending build of an
    /// argument. It then throws what that build throws.
    ///
    /// Pass arguments in the order of the parameters: scalars, adapted structs, Buffer, Lists,
    /// cl::Buffer, cl::Image, cl::Pipe, cl::Sampler, LocalMemory. Throws Error if their number,
    /// kind, size, type or context does not fit the parameters. Signs and the widths of vectors are
    /// not compared. Throws Error if only some extents of Range::local are 0, and if the device has
    /// too little local memory. Throws OpenClError if the launch fails.
    ///
    /// Kernels can insert only during build(). Outside a build, containers are read-only, and
    /// Lists::validate() counts the refused inserts.
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
    /// Returns the OpenCL kernel, as compiled for the containers that the constructor named. run()
    /// sets all of its arguments. A build may use other kernels of the same source. The reference
    /// is valid as long as the Kernel. Does not block.
    [[nodiscard]] const cl::Kernel& cl() const;
    /// Returns the compiler's log of the same kernel's program, with the line numbers of the user's
    /// source. Usually empty if there are no warnings; some drivers also report that the build is
    /// complete. Throws OpenClError if the driver fails. Does not block.
    [[nodiscard]] std::string log() const;

    /// @private
    Kernel(std::shared_ptr<detail::DeviceState> device, const Source& code, const std::string& name,
           const detail::Definitions& definitions);
    /// @private Faster without an event.
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
