#include <algorithm>
#include <map>
#include <numeric>
#include <regex>

#include <cellist/kernel.hpp>

#include "cellist_kernels.hpp"
#include "device_state.hpp"
#include "view.hpp"

namespace cellist {

namespace {

using detail::Arguments;
using detail::opencl;

/// What a kernel expects as one parameter.
struct Parameter {
    std::string declaration;  ///< e.g. "uint count"
    Arguments::Kind kind = Arguments::Kind::value;
    std::size_t size = 0;  ///< in bytes; 0 if not known
};

/// Takes the library's own #include lines out of a source, since its text stands before it already,
/// and keeps the line numbers.
std::string without_library_includes(const std::string& text, bool& uses_glm) {
    static const std::regex include(R"(^[ \t]*#[ \t]*include[ \t]*[<"]cellist/(\w+)\.clh[>"])",
                                    std::regex::multiline);
    std::string out;
    auto rest = text.begin();
    for (std::sregex_iterator match(text.begin(), text.end(), include), end; match != end;
         ++match) {
        const std::string name = (*match)[1];
        if (name != "lists" && name != "glm") continue;
        uses_glm = uses_glm || name == "glm";
        out.append(rest, (*match)[0].first);
        rest = (*match)[0].second;
    }
    return out.append(rest, text.end());
}

std::string whole_source(const Source& source, const detail::Definitions& definitions,
                         cl_uint modes) {
    bool uses_glm = false;
    const std::string text = without_library_includes(source.text, uses_glm);
    detail::Definitions all = definitions;
    if (uses_glm) all.add(detail::glm_source());
    std::string whole = "#define CELLIST_MODES " + std::to_string(modes) + "u\n";
    whole += "#line 1 \"cellist/view.h\"\n";
    whole += kernels::view_h;
    whole += "\n#line 1 \"cellist/lists.clh\"\n";
    whole += kernels::lists_clh;
    whole += "\n#line 1 \"structs\"\n" + all.source();
    whole += "\n#line 1 \"" + source.file_name + "\"\n" + text + "\n";
    return whole;
}

cl::Program build(detail::DeviceState& device, const Source& source,
                  const detail::Definitions& definitions, cl_uint modes) {
    if (definitions.needs_fp64 && !device.info.fp64)
        throw Error("a struct has members of type double, which " + device.info.name +
                    " does not support");
    try {
        return device.program(whole_source(source, definitions, modes),
                              "-cl-std=CL1.2 -cl-kernel-arg-info " + source.options);
    } catch (const OpenClError& error) {
        std::smatch what;
        static const std::regex check("cellist_layout_of_(\\w+)");
        if (std::regex_search(error.log(), what, check))
            throw Error("the layout of a struct differs between the host and " + device.info.name +
                        ": " + what[1].str() + " (struct_member)");
        throw;
    }
}

/// Bytes of a parameter passed by value; 0 if the type is not known.
std::size_t type_size(std::string name, const detail::Definitions& definitions) {
    if (name == "cellist_view") return sizeof(cellist_view);
    for (const detail::RecordType& record : definitions.records)
        if (record.name == name || "struct " + record.name == name) return record.size;
    if (name.starts_with("unsigned ")) name = "u" + name.substr(9);
    static const std::map<std::string, std::size_t> scalars{
        {"char", 1}, {"uchar", 1}, {"short", 2}, {"ushort", 2}, {"half", 2},  {"int", 4},
        {"uint", 4}, {"float", 4}, {"long", 8},  {"ulong", 8},  {"double", 8}};
    const std::size_t digits = std::min(name.find_first_of("0123456789"), name.size());
    const auto scalar = scalars.find(name.substr(0, digits));
    if (scalar == scalars.end()) return 0;
    if (digits == name.size()) return scalar->second;
    const std::size_t components = std::stoul(name.substr(digits));
    return scalar->second * (components == 3 ? 4 : components);
}

std::string text_of(const cl::Kernel& kernel, cl_uint index, cl_kernel_arg_info what) {
    std::size_t size = 0;
    if (clGetKernelArgInfo(kernel(), index, what, 0, nullptr, &size) != CL_SUCCESS) return {};
    std::string text(size, '\0');
    if (clGetKernelArgInfo(kernel(), index, what, size, text.data(), nullptr) != CL_SUCCESS)
        return {};
    return text.substr(0, text.find('\0'));
}

std::vector<Parameter> parameters_of(const cl::Kernel& kernel,
                                     const detail::Definitions& definitions) {
    std::vector<Parameter> parameters(kernel.getInfo<CL_KERNEL_NUM_ARGS>());
    for (cl_uint i = 0; i < parameters.size(); ++i) {
        const std::string type = text_of(kernel, i, CL_KERNEL_ARG_TYPE_NAME);
        const auto address = kernel.getArgInfo<CL_KERNEL_ARG_ADDRESS_QUALIFIER>(i);
        Parameter& parameter = parameters[i];
        parameter.declaration = type + " " + text_of(kernel, i, CL_KERNEL_ARG_NAME);
        if (type == "sampler_t")
            parameter.kind = Arguments::Kind::sampler;
        else if (address == CL_KERNEL_ARG_ADDRESS_LOCAL)
            parameter.kind = Arguments::Kind::local;
        else if (address != CL_KERNEL_ARG_ADDRESS_PRIVATE || type.starts_with("image"))
            parameter.kind = Arguments::Kind::memory;
        else
            parameter.size = type_size(type, definitions);
    }
    return parameters;
}

const char* kind_name(Arguments::Kind kind) {
    switch (kind) {
        case Arguments::Kind::value:
            return "a value";
        case Arguments::Kind::memory:
            return "a buffer or image";
        case Arguments::Kind::sampler:
            return "a sampler";
        case Arguments::Kind::local:
            return "local memory";
    }
    return "";
}

/// A work-group for ranges that do not name one; none if no useful size divides the range.
cl::NDRange local_range(const Range& range, std::size_t limit) {
    if (range.local[0] != 0) {
        switch (range.dimensions) {
            case 1:
                return {range.local[0]};
            case 2:
                return {range.local[0], range.local[1]};
            default:
                return {range.local[0], range.local[1], range.local[2]};
        }
    }
    const std::size_t most = std::min<std::size_t>(limit, 256);
    const std::size_t x = std::gcd(range.global[0], range.dimensions == 1 ? most : most / 8);
    const std::size_t y = std::gcd(range.global[1], std::size_t{8});
    if (range.dimensions == 1) return x >= 32 ? cl::NDRange(x) : cl::NullRange;
    if (x * y < 32) return cl::NullRange;
    return range.dimensions == 2 ? cl::NDRange(x, y) : cl::NDRange(x, y, 1);
}

cl::NDRange global_range(const Range& range) {
    switch (range.dimensions) {
        case 1:
            return {range.global[0]};
        case 2:
            return {range.global[0], range.global[1]};
        default:
            return {range.global[0], range.global[1], range.global[2]};
    }
}

/// The kernel, compiled for containers of some modes.
struct Variant {
    cl::Kernel kernel;
    std::vector<Parameter> parameters;
    std::size_t work_group_limit = 0;

    /// Throws Error if an argument does not fit the parameter. Drivers do not all check this: PoCL
    /// takes a value of any size.
    void check(const std::string& name, cl_uint index, const Arguments::Argument& argument) const {
        const Parameter& parameter = parameters[index];
        const bool right_kind = argument.kind == parameter.kind;
        if (right_kind && (parameter.size == 0 || argument.size == parameter.size)) return;
        const std::string where = "kernel " + name + ", parameter " + std::to_string(index) + " '" +
                                  parameter.declaration + "': takes ";
        if (!right_kind)
            throw Error(where + kind_name(parameter.kind) + ", was given " +
                        kind_name(argument.kind));
        throw Error(where + std::to_string(parameter.size) + " bytes, was given " +
                    std::to_string(argument.size));
    }
};

}  // namespace

struct Kernel::Impl {
    std::shared_ptr<detail::DeviceState> device;
    Source source;
    std::string name;
    detail::Definitions definitions;
    std::map<cl_uint, Variant> variants;  ///< by modes

    /// The kernel for containers of these modes; builds it the first time.
    Variant& variant(cl_uint modes) {
        if (const auto known = variants.find(modes); known != variants.end()) return known->second;
        const cl::Program program = build(*device, source, definitions, modes);
        return opencl([&]() -> Variant& {
            Variant made;
            made.kernel = cl::Kernel(program, name.c_str());
            made.parameters = parameters_of(made.kernel, definitions);
            made.work_group_limit =
                made.kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device->device);
            return variants.emplace(modes, std::move(made)).first->second;
        });
    }
};

Kernel::Kernel(std::shared_ptr<detail::DeviceState> device, const Source& source,
               const std::string& name, const detail::Definitions& definitions)
    : impl_(new Impl{std::move(device), source, name, definitions, {}}) {
    impl_->variant(definitions.modes);
}

Kernel::Kernel(Kernel&&) noexcept = default;
Kernel& Kernel::operator=(Kernel&&) noexcept = default;
Kernel::~Kernel() = default;

const std::string& Kernel::name() const { return impl_->name; }

cl::Event Kernel::enqueue(const Range& range, const Arguments& arguments) {
    Variant& variant =
        impl_->variant(arguments.modes() != 0 ? arguments.modes() : impl_->definitions.modes);
    const auto list = arguments.list();
    if (list.size() != variant.parameters.size())
        throw Error("kernel " + impl_->name + " has " + std::to_string(variant.parameters.size()) +
                    " parameters and was given " + std::to_string(list.size()) +
                    " (a container counts as 4)");
    for (cl_uint i = 0; i < list.size(); ++i) {
        variant.check(impl_->name, i, list[i]);
        opencl([&] { variant.kernel.setArg(i, list[i].size, arguments.data(list[i])); });
    }

    cl::Event event;
    opencl([&] {
        const cl::CommandQueue& queue = impl_->device->queue;
        const auto& extents = range.global;
        if (std::find(extents.begin(), extents.end(), 0u) != extents.end())
            queue.enqueueMarkerWithWaitList(nullptr, &event);
        else
            queue.enqueueNDRangeKernel(variant.kernel, cl::NullRange, global_range(range),
                                       local_range(range, variant.work_group_limit), nullptr,
                                       &event);
    });
    return event;
}

}  // namespace cellist
