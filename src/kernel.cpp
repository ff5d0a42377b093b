#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <numeric>

#include <cellist/kernel.hpp>

#include "cellist_kernels.hpp"
#include "device_state.hpp"
#include "program_text.hpp"
#include "view.hpp"

namespace cellist {

namespace {

using detail::Arguments;
using detail::check;
using detail::opencl;
using detail::ProgramText;

/// What a kernel expects as one parameter.
struct Parameter {
    std::string declaration;    ///< e.g. "uint count"
    std::string type;           ///< of the value or of what a pointer points to, e.g. "uint"
    std::string comparable;     ///< what of the type must be the same in an argument
    bool is_container = false;  ///< the nodes of a container; `type` is their record
    Arguments::Kind kind = Arguments::Kind::value;
    std::size_t size = 0;  ///< in bytes; 0 if not known
};

/// The part of a program that defines the adapted structs.
constexpr auto structs = "cellist/structs";

/// What a device has, unless the build options define it.
void add_switch(ProgramText& whole, const std::string& name, bool on) {
    whole.add(
        "#ifndef CELLIST_" + name + "\n#define CELLIST_" + name + (on ? " 1" : " 0") + "\n#endif",
        "CELLIST_" + name);
}

ProgramText whole_source(const Source& source, const detail::Definitions& definitions,
                         cl_uint modes, const DeviceInfo& device) {
    bool uses_glm = false;
    const std::string text = detail::without_library_includes(source.text, uses_glm);
    detail::Definitions all = definitions;
    if (uses_glm) all.add(detail::glm_source());
    ProgramText whole;
    // Macros of the build options are for the user's source, and unknown to the library's.
    const std::vector<std::string> macros = detail::defined_macros(source.options);
    std::string hide, show;
    for (const std::string& macro : macros) {
        hide += "#pragma push_macro(\"" + macro + "\")\n#undef " + macro + "\n";
        show.insert(0, "#pragma pop_macro(\"" + macro + "\")\n");
    }
    whole.add(hide, "options");
    whole.add("#define CELLIST_MODES " + std::to_string(modes) + "u", "modes");
    add_switch(whole, "LANES", device.lanes);
    add_switch(whole, "THREADS", device.threads);
    whole.add(kernels::view_h, "cellist/view.h");
    whole.add(kernels::lanes_clh, "cellist/lanes.clh");
    whole.add(kernels::threads_clh, "cellist/threads.clh");
    whole.add(kernels::allocation_clh, "cellist/allocation.clh");
    whole.add(kernels::lists_clh, "cellist/lists.clh");
    whole.add(all.source(), structs);
    whole.add(show, "options");
    whole.add(text, source.file_name);
    return whole;
}

/// Which struct or member the device's compiler does not accept, and why; empty if it is something else.
std::string complaint_about_structs(const ProgramText& whole, const std::string& log,
                                    const DeviceInfo& device) {
    const std::vector<ProgramText::Complaint> errors = whole.errors(log, structs);
    if (errors.empty()) return {};
    // A member that the compiler drops changes the layout as well.
    const auto name = std::find_if(errors.begin(), errors.end(), [](const auto& error) {
        return error.message.find("negative") == std::string_view::npos;
    });
    const std::string_view line = name == errors.end() ? errors.front().line : name->line;
    constexpr std::string_view because = "  // ";
    const std::size_t comment = line.rfind(because);
    if (comment == std::string_view::npos) return {};
    const std::string subject(line.substr(comment + because.size()));
    if (name == errors.end())
        return "the layout of a struct differs between the host and " + device.name + ": " +
               subject + "\n";
    return "the compiler of " + device.name + " does not accept " + subject +
           ": where its name is a word or a macro of OpenCL C, or of the library, rename it\n";
}

/// Names the macros of the build options where one replaces a member, or the log complains about one.
std::string macro_hint(const std::string& options, const detail::Definitions& definitions,
                       const std::string& log) {
    const bool in_log = log.find("<command line>") != std::string::npos;
    const auto names_member = [&](const std::string& macro) {
        return std::any_of(
            definitions.records.begin(), definitions.records.end(), [&](const auto& record) {
                return record.name == macro ||
                       std::any_of(record.members.begin(), record.members.end(),
                                   [&](const auto& member) { return member.name == macro; });
            });
    };
    std::string hint;
    for (const std::string& macro : detail::defined_macros(options))
        if (names_member(macro))
            hint += "\nhint: the build options define the macro '" + macro +
                    "', which is the name of a struct or member";
        else if (in_log)
            hint += "\nhint: the build options define the macro '" + macro + "'";
    return hint;
}

const cl::Program& build(detail::DeviceState& device, const Source& source,
                         const detail::Definitions& definitions, cl_uint modes) {
    if (source.text.empty()) throw Error("the source of " + source.file_name + " is empty");
    if (definitions.needs_fp64 && !device.info.fp64)
        throw Error("a struct has members of type double, which " + device.info.name +
                    " does not support");
    const ProgramText whole = whole_source(source, definitions, modes, device.info);
    try {
        return device.program(whole.text(), "-cl-std=CL1.2 -cl-kernel-arg-info " + source.options);
    } catch (const OpenClError& error) {
        const std::string log = whole.in_parts(error.log());
        const auto known = [&](const std::string& name) {
            return std::any_of(definitions.records.begin(), definitions.records.end(),
                               [&](const auto& record) { return record.name == name; });
        };
        const std::string complaint = complaint_about_structs(whole, log, device.info);
        throw OpenClError(error.call(), error.code(),
                          (complaint.empty() ? detail::with_hints(log, known) : complaint + log) +
                              macro_hint(source.options, definitions, log));
    }
}

/// Bytes of a parameter passed by value; 0 if the type is not known.
std::size_t type_size(std::string name, const detail::Definitions& definitions) {
    if (name.find("cellist_view_") != std::string::npos) return sizeof(cellist_view);
    for (const detail::RecordType& record : definitions.records)
        if (record.name == name || "struct " + record.name == name) return record.size;
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

/// What must be the same in an argument and a parameter: float or integer with the size of the scalar,
/// or the name of a struct. Vectors count as their scalars, and signs do not count. Empty for other
/// types, which are not compared.
std::string comparable(const std::string& type, const detail::Definitions& definitions) {
    if (type.empty()) return {};
    for (const detail::RecordType& record : definitions.records)
        if (record.name == type) return type;
    const std::string scalar = type.substr(0, type.find_first_of("0123456789"));
    const std::size_t size = type_size(scalar, definitions);
    if (size == 0) return {};
    const bool is_float = scalar == "float" || scalar == "double" || scalar == "half";
    return (is_float ? "float" : "integer") + std::to_string(8 * size);
}

std::vector<Parameter> parameters_of(const cl::Kernel& kernel,
                                     const detail::Definitions& definitions) {
    std::vector<Parameter> parameters(kernel.getInfo<CL_KERNEL_NUM_ARGS>());
    for (cl_uint i = 0; i < parameters.size(); ++i) {
        const std::string type = text_of(kernel, i, CL_KERNEL_ARG_TYPE_NAME);
        const auto address = kernel.getArgInfo<CL_KERNEL_ARG_ADDRESS_QUALIFIER>(i);
        Parameter& parameter = parameters[i];
        parameter.declaration = type + " " + text_of(kernel, i, CL_KERNEL_ARG_NAME);
        parameter.type = pointed_to(type);
        constexpr std::string_view nodes = "cellist_node_";
        parameter.is_container = parameter.type.starts_with(nodes);
        if (parameter.is_container) parameter.type.erase(0, nodes.size());
        parameter.comparable = comparable(parameter.type, definitions);
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

cl::NDRange nd_range(const std::array<std::size_t, 3>& extents, std::size_t dimensions) {
    if (dimensions == 1) return {extents[0]};
    if (dimensions == 2) return {extents[0], extents[1]};
    return {extents[0], extents[1], extents[2]};
}

/// The work-group of a launch: the range's own, else the one that the kernel requires, else one of up
/// to 256 items that divides the range; the driver's choice where none of a useful size does.
cl::NDRange work_group(const Range& range, const std::array<std::size_t, 3>& required,
                       std::size_t limit) {
    const auto end = range.local.begin() + static_cast<std::ptrdiff_t>(range.dimensions);
    const auto zeros = std::count(range.local.begin(), end, 0u);
    if (zeros == 0) return nd_range(range.local, range.dimensions);
    if (zeros != end - range.local.begin())
        throw Error("Range::local has an extent of 0: name all of them, or none");
    if (required[0] != 0) return nd_range(required, range.dimensions);

    constexpr std::size_t least = 32;
    const std::size_t most = std::min<std::size_t>(limit, 256);
    if (most < least) return cl::NullRange;
    const std::size_t x = std::gcd(range.global[0], range.dimensions == 1 ? most : most / 8);
    const std::size_t y = range.dimensions == 1 ? 1 : std::gcd(range.global[1], std::size_t{8});
    return x * y < least ? cl::NullRange : nd_range({x, y, 1}, range.dimensions);
}

cl::Kernel kernel_called(const cl::Program& program, const std::string& name,
                         const Source& source) {
    try {
        return {program, name.c_str()};
    } catch (const cl::Error& error) {
        if (error.err() != CL_INVALID_KERNEL_NAME) throw;
        throw OpenClError(error.what(), error.err(),
                          source.file_name + " has no kernel called '" + name + "'");
    }
}

/// Parameters or arguments as they are written: a container is one of them and takes four.
std::size_t written(const auto& list) {
    const auto containers =
        std::count_if(list.begin(), list.end(), [](const auto& item) { return item.is_container; });
    return list.size() - 3 * static_cast<std::size_t>(containers);
}

/// Null where there is no memory.
cl_context context_of(const std::byte* memory_handle) {
    cl_mem memory = nullptr;
    std::memcpy(&memory, memory_handle, sizeof(cl_mem));
    if (memory == nullptr) return nullptr;
    cl_context context = nullptr;
    check("clGetMemObjectInfo",
          clGetMemObjectInfo(memory, CL_MEM_CONTEXT, sizeof(cl_context), &context, nullptr));
    return context;
}

/// The kernel, compiled for containers of some modes.
struct Variant {
    cl::Kernel kernel;
    std::vector<Parameter> parameters;
    std::size_t work_group_limit = 0;
    std::array<std::size_t, 3> required_work_group{};  ///< 0 if the kernel requires none

    /// Throws Error if an argument does not fit the parameter. Drivers do not all check this: PoCL
    /// takes a value of any size, and none knows what a buffer holds.
    void check(const detail::DeviceState& device, const detail::Definitions& definitions,
               const std::string& name, cl_uint index, const Arguments::Argument& argument,
               const std::byte* data) const {
        const Parameter& parameter = parameters[index];
        const auto fail = [&](const std::string& takes, const std::string& given) {
            throw Error("kernel " + name + ", parameter " + std::to_string(index) + " '" +
                        parameter.declaration + "': takes " + takes + ", was given " + given);
        };
        if (argument.kind != parameter.kind)
            fail(kind_name(parameter.kind), kind_name(argument.kind));
        if (parameter.size != 0 && argument.size != parameter.size)
            fail(std::to_string(parameter.size) + " bytes", std::to_string(argument.size));
        if (argument.is_container != parameter.is_container ||
            (argument.is_container && argument.type != parameter.type))
            fail(parameter.is_container ? "lists of " + parameter.type : "a buffer",
                 argument.is_container ? "lists of " + argument.type : "a buffer");
        // Most types are written as the parameter's, which is soon told.
        if (!parameter.comparable.empty() && argument.type != parameter.type) {
            const std::string given = comparable(argument.type, definitions);
            if (!given.empty() && given != parameter.comparable)
                fail(parameter.type,
                     argument.type + (argument.kind == Arguments::Kind::memory
                                          ? " (pass Buffer::cl() to reinterpret its elements)"
                                          : ""));
        }
        if (argument.kind != Arguments::Kind::memory) return;
        const cl_context context = context_of(data);
        if (context == nullptr) fail("memory", "an empty buffer");
        if (context != device.context())
            fail("memory of " + device.info.name, "memory of another context");
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
        const cl::Program& program = build(*device, source, definitions, modes);
        return opencl([&]() -> Variant& {
            Variant made;
            made.kernel = kernel_called(program, name, source);
            made.parameters = parameters_of(made.kernel, definitions);
            made.work_group_limit =
                made.kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device->device);
            made.required_work_group =
                made.kernel.getWorkGroupInfo<CL_KERNEL_COMPILE_WORK_GROUP_SIZE>(device->device);
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

void Kernel::enqueue(const Range& range, const Arguments& arguments, cl::Event* event) {
    Variant& variant =
        impl_->variant(arguments.modes() != 0 ? arguments.modes() : impl_->definitions.modes);
    const auto list = arguments.list();
    if (list.size() != variant.parameters.size())
        throw Error("kernel " + impl_->name + " takes " +
                    std::to_string(written(variant.parameters)) + " arguments and was given " +
                    std::to_string(written(list)) +
                    " (a container counts as one; build(kernel, ...) passes it first)");
    for (cl_uint i = 0; i < list.size(); ++i) {
        const std::byte* data = arguments.data(list[i]);
        variant.check(*impl_->device, impl_->definitions, impl_->name, i, list[i], data);
        opencl([&] { variant.kernel.setArg(i, list[i].size, data); });
    }

    opencl([&] {
        const cl::CommandQueue& queue = impl_->device->ordered_queue();
        const auto& extents = range.global;
        if (std::find(extents.begin(), extents.end(), 0u) != extents.end()) {
            if (event != nullptr) queue.enqueueMarkerWithWaitList(nullptr, event);
        } else {
            queue.enqueueNDRangeKernel(
                variant.kernel, cl::NullRange, nd_range(range.global, range.dimensions),
                work_group(range, variant.required_work_group, variant.work_group_limit), nullptr,
                event);
        }
    });
}

}  // namespace cellist
