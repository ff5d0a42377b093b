// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <cellist/detail/arguments.hpp>
#include <cellist/detail/record_type.hpp>

#include "device/device_state.hpp"

namespace cellist::detail {

/// What a kernel expects as one parameter.
struct Parameter {
    enum class Kind { value, buffer, image, pipe, sampler, local };

    std::string declaration;    ///< e.g. "global uint* counts"
    std::string name;           ///< e.g. "counts"
    std::string type;           ///< of the value or of what a pointer points to, e.g. "uint"
    std::string comparable;     ///< the part of the type that an argument must match
    bool is_container = false;  ///< the nodes of a container; `type` is their record
    bool is_constant = false;   ///< a buffer in constant memory
    Kind kind = Kind::value;
    std::size_t size = 0;  ///< of a value, or of an element of a buffer, in bytes; 0 if not known
    cl_mem_object_type image = 0;  ///< the kind of an image; 0 if not known
    bool is_depth = false;         ///< an image of depths
    cl_kernel_arg_access_qualifier access = CL_KERNEL_ARG_ACCESS_NONE;
};

/// The parameters of a kernel that was built with -cl-kernel-arg-info.
[[nodiscard]] std::vector<Parameter> parameters_of(const cl::Kernel& kernel,
                                                   const Definitions& definitions);

/// Throws Error if an argument does not fit a parameter of a kernel. Not every driver checks this:
/// PoCL accepts a value of any size, and a buffer for an image. No driver knows the type of a
/// buffer's elements.
class ArgumentCheck {
public:
    ArgumentCheck(const DeviceState& device, const Definitions& definitions,
                  const std::string& kernel)
        : device_(device), definitions_(definitions), kernel_(kernel) {}

    /// `number` counts the arguments as they are written, from 1 on.
    void operator()(std::size_t number, const Parameter& parameter,
                    const Arguments::Argument& argument, const std::byte* data) const;

private:
    const DeviceState& device_;
    const Definitions& definitions_;
    const std::string& kernel_;
};

}  // namespace cellist::detail
