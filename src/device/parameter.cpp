// SPDX-License-Identifier: MIT
#include "device/parameter.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <string_view>

#include "device/view.hpp"

namespace cellist::detail {

namespace {

using Kind = Parameter::Kind;

/// Bytes of a parameter passed by value; 0 if the type is not known.
std::size_t type_size(std::string name, const Definitions& definitions) {
    if (name.find("cellist_view_") != std::string::npos) return sizeof(cellist_view);
    for (const RecordType& record : definitions.records)
        if (record.name == name || record.type() == name) return record.size;
    if (name.starts_with("unsigned ")) name.replace(0, 9, "u");
    static const std::map<std::string, std::size_t> scalars{
        {"char", 1}, {"uchar", 1}, {"short", 2}, {"ushort", 2}, {"half", 2},  {"int", 4},
        {"uint", 4}, {"float", 4}, {"long", 8},  {"ulong", 8},  {"double", 8}};
    static const std::map<std::string, std::size_t> components{{"", 1},  {"2", 2}, {"3", 4},
                                                               {"4", 4}, {"8", 8}, {"16", 16}};
    const std::size_t digits = std::min(name.find_first_of("0123456789"), name.size());
    const auto scalar = scalars.find(name.substr(0, digits));
    const auto count = components.find(name.substr(digits));
    if (scalar == scalars.end() || count == components.end()) return 0;
    return scalar->second * count->second;
}

std::string text_of(const cl::Kernel& kernel, cl_uint index, cl_kernel_arg_info what) {
    std::size_t size = 0;
    check("clGetKernelArgInfo", clGetKernelArgInfo(kernel(), index, what, 0, nullptr, &size));
    std::string text(size, '\0');
    check("clGetKernelArgInfo",
          clGetKernelArgInfo(kernel(), index, what, size, text.data(), nullptr));
    return text.substr(0, text.find('\0'));
}

/// "float4" for "float4*", "Hit" for "struct Hit*".
std::string pointed_to(std::string type) {
    type.resize(std::min(type.size(), type.find_first_of("*")));
    type.erase(type.find_last_not_of(' ') + 1);
    return type.starts_with("struct ") ? type.substr(7) : type;
}

/// The part of a type in which an argument and a parameter must match: float or integer with the
/// size of the scalar, or the name of a struct. Vectors count as their scalars, and signs do not
/// count. Empty for other types, which are not compared.
std::string comparable(const std::string& type, const Definitions& definitions) {
    if (type.empty()) return {};
    for (const RecordType& record : definitions.records)
        if (record.is_struct && record.name == type) return type;
    const std::string scalar = type.substr(0, type.find_first_of("0123456789"));
    const std::size_t size = type_size(scalar, definitions);
    if (size == 0) return {};
    const bool is_float = scalar == "float" || scalar == "double" || scalar == "half";
    return (is_float ? "float" : "integer") + std::to_string(8 * size);
}

/// Images in OpenCL C and in the host's API.
struct ImageType {
    std::string_view type;
    cl_mem_object_type object;
    const char* name;
};
constexpr std::array image_types{
    ImageType{"image1d_t", CL_MEM_OBJECT_IMAGE1D, "a 1D image"},
    ImageType{"image1d_buffer_t", CL_MEM_OBJECT_IMAGE1D_BUFFER, "a 1D image of a buffer"},
    ImageType{"image1d_array_t", CL_MEM_OBJECT_IMAGE1D_ARRAY, "an array of 1D images"},
    ImageType{"image2d_t", CL_MEM_OBJECT_IMAGE2D, "a 2D image"},
    ImageType{"image2d_array_t", CL_MEM_OBJECT_IMAGE2D_ARRAY, "an array of 2D images"},
    ImageType{"image3d_t", CL_MEM_OBJECT_IMAGE3D, "a 3D image"},
};

const char* image_name(cl_mem_object_type object) {
    for (const ImageType& image : image_types)
        if (image.object == object) return image.name;
    return "an image";
}

/// Takes `part` out of a type; false if it is not there.
bool take_out(std::string& type, std::string_view part) {
    const std::size_t at = type.find(part);
    if (at == std::string::npos) return false;
    type.erase(at, part.size());
    return true;
}

void describe_image(Parameter& parameter, std::string type) {
    parameter.kind = Kind::image;
    parameter.is_depth = take_out(type, "_depth");
    take_out(type, "_msaa");
    for (const ImageType& image : image_types)
        if (type == image.type) parameter.image = image.object;
}

/// Whether a parameter is an image: by its type, or, for a typedef, by its access and address
/// qualifiers.
bool is_image(const std::string& type, cl_kernel_arg_address_qualifier address,
              cl_kernel_arg_access_qualifier access) {
    Parameter known;
    describe_image(known, type);
    return known.image != 0 ||
           (access != CL_KERNEL_ARG_ACCESS_NONE && address != CL_KERNEL_ARG_ADDRESS_PRIVATE &&
            type.find('*') == std::string::npos);
}

const char* kind_name(Kind kind) {
    switch (kind) {
        case Kind::value:
            return "a value";
        case Kind::buffer:
            return "a buffer";
        case Kind::image:
            return "an image";
        case Kind::pipe:
            return "a pipe";
        case Kind::sampler:
            return "a sampler";
        case Kind::local:
            return "local memory";
    }
    return "";
}

const char* access_name(cl_kernel_arg_access_qualifier access) {
    switch (access) {
        case CL_KERNEL_ARG_ACCESS_READ_ONLY:
            return "read_only ";
        case CL_KERNEL_ARG_ACCESS_WRITE_ONLY:
            return "write_only ";
        case CL_KERNEL_ARG_ACCESS_READ_WRITE:
            return "read_write ";
        default:
            return "";
    }
}

const char* space_name(const Parameter& parameter) {
    if (parameter.kind == Kind::local) return "local ";
    if (parameter.kind != Kind::buffer) return access_name(parameter.access);
    return parameter.is_constant ? "constant " : "global ";
}

Parameter parameter_of(const cl::Kernel& kernel, cl_uint index, const Definitions& definitions) {
    const std::string type = text_of(kernel, index, CL_KERNEL_ARG_TYPE_NAME);
    const auto address = kernel.getArgInfo<CL_KERNEL_ARG_ADDRESS_QUALIFIER>(index);
    Parameter parameter;
    parameter.name = text_of(kernel, index, CL_KERNEL_ARG_NAME);
    parameter.type = pointed_to(type);
    parameter.access = kernel.getArgInfo<CL_KERNEL_ARG_ACCESS_QUALIFIER>(index);
    constexpr std::string_view nodes = "cellist_node_";
    parameter.is_container = parameter.type.starts_with(nodes);
    if (parameter.is_container) parameter.type.erase(0, nodes.size());
    parameter.comparable = comparable(parameter.type, definitions);
    parameter.is_constant = address == CL_KERNEL_ARG_ADDRESS_CONSTANT;
    const bool is_pipe =
        (kernel.getArgInfo<CL_KERNEL_ARG_TYPE_QUALIFIER>(index) & CL_KERNEL_ARG_TYPE_PIPE) != 0;
    if (is_pipe)
        parameter.kind = Kind::pipe;
    else if (is_image(type, address, parameter.access))
        describe_image(parameter, type);
    else if (type == "sampler_t")
        parameter.kind = Kind::sampler;
    else if (address == CL_KERNEL_ARG_ADDRESS_LOCAL)
        parameter.kind = Kind::local;
    else if (address != CL_KERNEL_ARG_ADDRESS_PRIVATE)
        parameter.kind = Kind::buffer;
    parameter.size = type_size(parameter.type, definitions);
    parameter.declaration = space_name(parameter) + type + " " + parameter.name;
    return parameter;
}

/// A property of memory. The C++ bindings are not used, because they would retain the object.
template <class T>
T memory_info(cl_mem memory, cl_mem_info what) {
    T value{};
    check("clGetMemObjectInfo", clGetMemObjectInfo(memory, what, sizeof value, &value, nullptr));
    return value;
}

/// The object that an argument refers to. Its C++ class does not tell the kind: cl::Memory may be
/// any object.
struct Given {
    Kind kind = Kind::value;
    cl_mem memory = nullptr;
    cl_mem_object_type object = CL_MEM_OBJECT_BUFFER;
    cl_context context = nullptr;  ///< null where there is no object
};

Given given(const Arguments::Argument& argument, const std::byte* data) {
    Given given;
    switch (argument.kind) {
        case Arguments::Kind::value:
            break;
        case Arguments::Kind::local:
            given.kind = Kind::local;
            break;
        case Arguments::Kind::sampler: {
            given.kind = Kind::sampler;
            cl_sampler sampler = nullptr;
            std::memcpy(&sampler, data, sizeof sampler);
            if (sampler == nullptr) break;
            check("clGetSamplerInfo",
                  clGetSamplerInfo(sampler, CL_SAMPLER_CONTEXT, sizeof given.context,
                                   &given.context, nullptr));
            break;
        }
        case Arguments::Kind::memory:
            given.kind = Kind::buffer;
            std::memcpy(&given.memory, data, sizeof given.memory);
            if (argument.owner != nullptr) {
                given.context = argument.owner->context();
                break;
            }
            if (given.memory == nullptr) break;
            given.context = memory_info<cl_context>(given.memory, CL_MEM_CONTEXT);
            given.object = memory_info<cl_mem_object_type>(given.memory, CL_MEM_TYPE);
            if (given.object == CL_MEM_OBJECT_PIPE)
                given.kind = Kind::pipe;
            else if (given.object != CL_MEM_OBJECT_BUFFER)
                given.kind = Kind::image;
            break;
    }
    return given;
}

bool holds_depths(cl_mem image) {
    cl_image_format format{};
    check("clGetImageInfo",
          clGetImageInfo(image, CL_IMAGE_FORMAT, sizeof format, &format, nullptr));
    return format.image_channel_order == CL_DEPTH || format.image_channel_order == CL_DEPTH_STENCIL;
}

std::string bytes(std::uint64_t size) { return std::to_string(size) + " bytes"; }

// These call `fail` with what the parameter takes and what the kernel was given.

template <class Fail>
void check_local_size(const DeviceInfo& device, const Parameter& parameter, std::size_t size,
                      const Fail& fail) {
    const std::size_t least = std::max<std::size_t>(parameter.size, 1);
    if (size < least) fail("at least " + bytes(least), std::to_string(size));
    if (size > device.local_memory_bytes)
        fail("at most " + bytes(device.local_memory_bytes) + " on " + device.name,
             std::to_string(size));
}

template <class Fail>
void check_constant_size(const DeviceState& device, cl_mem memory, const Fail& fail) {
    const auto size = memory_info<std::size_t>(memory, CL_MEM_SIZE);
    if (size > device.max_constant_bytes)
        fail("at most " + bytes(device.max_constant_bytes) + " on " + device.info.name,
             std::to_string(size) + " (declare it as a global const pointer)");
}

template <class Fail>
void check_image(const Parameter& parameter, const Given& found, const Fail& fail) {
    if (parameter.image != 0 && found.object != parameter.image)
        fail(image_name(parameter.image), image_name(found.object));
    if (parameter.image != 0 && holds_depths(found.memory) != parameter.is_depth)
        fail(parameter.is_depth ? "a depth image" : "a colour image",
             parameter.is_depth ? "a colour image" : "a depth image");
    const auto flags = memory_info<cl_mem_flags>(found.memory, CL_MEM_FLAGS);
    const auto access = parameter.access;
    if ((flags & CL_MEM_READ_ONLY) != 0 && access != CL_KERNEL_ARG_ACCESS_READ_ONLY)
        fail("an image that kernels may write", "one with CL_MEM_READ_ONLY");
    if ((flags & CL_MEM_WRITE_ONLY) != 0 && access != CL_KERNEL_ARG_ACCESS_WRITE_ONLY)
        fail("an image that kernels may read", "one with CL_MEM_WRITE_ONLY");
}

}  // namespace

std::vector<Parameter> parameters_of(const cl::Kernel& kernel, const Definitions& definitions) {
    std::vector<Parameter> parameters;
    const auto count = kernel.getInfo<CL_KERNEL_NUM_ARGS>();
    for (cl_uint i = 0; i < count; ++i) parameters.push_back(parameter_of(kernel, i, definitions));
    return parameters;
}

void ArgumentCheck::operator()(std::size_t number, const Parameter& parameter,
                               const Arguments::Argument& argument, const std::byte* data) const {
    const auto fail = [&](const std::string& takes, const std::string& was_given) {
        throw Error("kernel " + kernel_ + ", argument " + std::to_string(number) + " '" +
                    parameter.declaration + "': takes " + takes + ", was given " + was_given);
    };
    const Given found = given(argument, data);
    const bool is_object = found.kind != Kind::value && found.kind != Kind::local;
    const bool missing = is_object && found.context == nullptr;

    if (argument.is_container != parameter.is_container ||
        (argument.is_container && argument.type != parameter.type))
        fail(parameter.is_container ? "lists of " + parameter.type : kind_name(parameter.kind),
             argument.is_container ? "lists of " + argument.type : kind_name(found.kind));
    if (found.kind != parameter.kind && !(missing && found.kind == Kind::buffer))
        fail(kind_name(parameter.kind), kind_name(found.kind));
    if (missing)
        fail(kind_name(parameter.kind),
             found.kind == Kind::sampler ? "an empty sampler" : "an empty buffer or image");
    if (is_object && found.context != device_.context())
        fail("memory of " + device_.info.name, "memory of another context");

    if (found.kind == Kind::value && parameter.size != 0 && argument.size != parameter.size)
        fail(parameter.type + " of " + bytes(parameter.size),
             argument.type + " of " + bytes(argument.size));
    // A fast path: most types are spelt as the parameter's.
    if (!parameter.comparable.empty() && argument.type != parameter.type) {
        const std::string type = comparable(argument.type, definitions_);
        if (!type.empty() && type != parameter.comparable)
            fail(parameter.type,
                 argument.type + (found.kind == Kind::buffer
                                      ? " (pass Buffer::cl() to reinterpret its elements)"
                                      : ""));
    }
    if (found.kind == Kind::local) check_local_size(device_.info, parameter, argument.size, fail);
    if (found.kind == Kind::buffer && parameter.is_constant)
        check_constant_size(device_, found.memory, fail);
    if (found.kind == Kind::image) check_image(parameter, found, fail);
}

}  // namespace cellist::detail
