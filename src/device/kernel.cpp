// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <sstream>
#include <system_error>

#include <cellist/detail/build.hpp>
#include <cellist/kernel.hpp>

#include "cellist_kernels.hpp"
#include "device/device_state.hpp"
#include "device/distribution.hpp"
#include "device/other_queues.hpp"
#include "device/parameter.hpp"
#include "device/program_text.hpp"
#include "device/view.hpp"

namespace cellist {

namespace {

using detail::Arguments;
using detail::opencl;
using detail::Parameter;
using detail::ProgramText;

/// The part of a program that defines the adapted structs.
constexpr auto structs = "cellist/structs";

/// What a device has, unless the build options define it.
void add_switch(ProgramText& whole, const std::string& name, bool on) {
    whole.add(
        "#ifndef CELLIST_" + name + "\n#define CELLIST_" + name + (on ? " 1" : " 0") + "\n#endif",
        "CELLIST_" + name);
}

ProgramText make_library_text(bool distributed) {
    ProgramText text;
    text.add(kernels::view_h, "cellist/view.h");
    text.add(kernels::warp_clh, "cellist/warp.clh");
    text.add(kernels::threads_clh, "cellist/threads.clh");
    text.add(kernels::allocation_clh, "cellist/allocation.clh");
    if (distributed) text.add(kernels::distributed_clh, "cellist/distributed.clh");
#define CELLIST_ADD_STORAGE(name, modes, unused, unused_too)                                       \
    text.add(kernels::name##_clh, "cellist/" #name ".clh");
    CELLIST_STORAGES(CELLIST_ADD_STORAGE, , )
#undef CELLIST_ADD_STORAGE
    text.add(kernels::lists_clh, "cellist/lists.clh");
    text.add(kernels::around_clh, "cellist/around.clh");
    text.add(kernels::hash_clh, "cellist/hash.clh");
    return text;
}

/// The library's part of every program. Put together once: each new Kernel needs the whole text.
const ProgramText& library_text(bool distributed) {
    static const ProgramText library = make_library_text(false);
    if (!distributed) return library;
    static const ProgramText distributed_library = make_library_text(true);
    return distributed_library;
}

ProgramText whole_source(const Source& source, const detail::Definitions& definitions,
                         cl_uint modes, const DeviceInfo& device) {
    bool uses_glm = false;
    const std::string text = detail::without_library_includes(source.text, uses_glm);
    detail::Definitions all = definitions;
    if (uses_glm) all.add(detail::glm_source());
    ProgramText whole;
    // Hides the macros of the build options from the library's text; only the user's source sees
    // them.
    const std::vector<std::string> macros = detail::defined_macros(source.options);
    std::string hide, show;
    for (const std::string& macro : macros) {
        hide += "#pragma push_macro(\"" + macro + "\")\n#undef " + macro + "\n";
        show.insert(0, "#pragma pop_macro(\"" + macro + "\")\n");
    }
    whole.add(hide, "options");
    const cl_uint distributed = modes & CELLIST_DISTRIBUTED_MODE;
    whole.add("#define CELLIST_MODES " + std::to_string(modes - distributed) + "u", "modes");
    add_switch(whole, "WARP_AGGREGATION", device.warp_aggregation);
    add_switch(whole, "ONE_THREAD_PER_WORK_GROUP", device.one_thread_per_work_group);
    whole.add(library_text(distributed != 0));
    whole.add(all.source(), structs);
    whole.add(show, "options");
    whole.add(text, source.file_name);
    return whole;
}

/// Says which struct or member the device's compiler does not accept, and why; empty for other
/// errors.
std::string complaint_about_structs(const ProgramText& whole, const std::string& log,
                                    const DeviceInfo& device) {
    const std::vector<ProgramText::Complaint> errors = whole.errors(log, structs);
    if (errors.empty()) return {};
    // A member that the compiler drops changes the layout, too.
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

/// A hint that names the macros of the build options that replace a member, or that the log
/// mentions.
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

detail::Program compile(detail::DeviceState& device, const Source& source,
                        const detail::Definitions& definitions, cl_uint modes) {
    if (source.text.empty()) throw Error("the source of " + source.file_name + " is empty");
    if (definitions.needs_fp64 && !device.info.fp64)
        throw Error("a record holds values of type double, which " + device.info.name +
                    " does not support");
    const ProgramText whole = whole_source(source, definitions, modes, device.info);
    try {
        return device.programs.get(whole.text(),
                                   "-cl-std=CL1.2 -cl-kernel-arg-info " + source.options);
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

cl::NDRange nd_range(const std::array<std::size_t, 3>& extents, std::size_t dimensions) {
    if (dimensions == 1) return {extents[0]};
    if (dimensions == 2) return {extents[0], extents[1]};
    return {extents[0], extents[1], extents[2]};
}

/// The work-group of a launch: the range's own, else the one that the kernel requires, else one of
/// up to 256 items that divides the range; the driver's choice where none of a useful size does.
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

/// The names of a program's kernels, e.g. "first, second". CL_PROGRAM_KERNEL_NAMES does not serve:
/// NVIDIA's driver 580 damages the heap where it answers.
std::string kernel_names(cl::Program program) {
    std::vector<cl::Kernel> kernels;
    std::string names;
    try {
        program.createKernels(&kernels);
        for (const cl::Kernel& kernel : kernels)
            names += (names.empty() ? "" : ", ") + kernel.getInfo<CL_KERNEL_FUNCTION_NAME>();
    } catch (const cl::Error&) {
        // Some drivers fail where there are no kernels.
    }
    return names;
}

cl::Kernel kernel_called(const cl::Program& program, const std::string& name,
                         const Source& source) {
    try {
        return {program, name.c_str()};
    } catch (const cl::Error& error) {
        if (error.err() != CL_INVALID_KERNEL_NAME) throw;
        const std::string known = kernel_names(program);
        throw OpenClError(error.what(), error.err(),
                          source.file_name + " has no kernel called '" + name + "'; " +
                              (known.empty() ? "it has no kernels" : "its kernels: " + known));
    }
}

/// What CELLIST_LISTS declares: nodes, heads, shards and view.
constexpr std::size_t container_parameters = 4;
/// What it declares in programs for a distributed container, too: an outbox, its shards, and the
/// distribution.
constexpr std::size_t distribution_parameters = 3;

/// The parameters of a container after its first.
std::size_t more_parameters(cl_uint modes) {
    const bool distributed = (modes & CELLIST_DISTRIBUTED_MODE) != 0;
    return container_parameters - 1 + (distributed ? distribution_parameters : 0);
}

/// Parameters or arguments as they are written: a container is one of them.
std::size_t written(const auto& list, cl_uint modes) {
    const auto containers = static_cast<std::size_t>(std::count_if(
        list.begin(), list.end(), [](const auto& item) { return item.is_container; }));
    return list.size() - containers * more_parameters(modes);
}

/// The arguments for a program with a distributed container. Other containers get no outbox, and a
/// distribution that maps each cell to itself.
Arguments with_distributions(const Arguments& given) {
    Arguments all;
    const auto list = given.list();
    for (std::size_t i = 0; i < list.size();) {
        const std::size_t count = list[i].is_container ? container_parameters : 1;
        all.append(given, i, count);
        i += count;
        if (count == 1 || (i + 2 < list.size() && list[i + 2].type == detail::distribution_type))
            continue;
        cellist_view view;
        std::memcpy(&view, given.data(list[i - 1]), sizeof view);
        all.append(given, i - 2, 1);
        all.append(given, i - 2, 1);
        detail::add_distribution(all, detail::whole_distribution(view));
    }
    return all;
}

/// The kernel, compiled for containers of some modes.
struct Variant {
    detail::Program program;
    cl::Kernel kernel;
    std::vector<Parameter> parameters;
    std::size_t work_group_limit = 0;
    std::size_t own_local_bytes = 0;                   ///< of local memory without parameters
    std::array<std::size_t, 3> required_work_group{};  ///< 0 if the kernel requires none
};

/// Throws Error if the kernel takes more local memory than there is.
void check_local_memory(const detail::DeviceState& device, const std::string& name,
                        const Variant& variant, std::span<const Arguments::Argument> list) {
    std::uint64_t bytes = variant.own_local_bytes;
    for (const Arguments::Argument& argument : list)
        if (argument.kind == Arguments::Kind::local) bytes += argument.size;
    if (bytes > device.info.local_memory_bytes)
        throw Error("kernel " + name + " takes " + std::to_string(bytes) +
                    " bytes of local memory together, " + device.info.name + " has " +
                    std::to_string(device.info.local_memory_bytes));
}

/// Why a launch fails with an error code, if its work-group is the cause.
std::string work_group_fault(const detail::DeviceState& device, const std::string& name,
                             const Variant& variant, const Range& range) {
    const auto text = [&](const std::array<std::size_t, 3>& extents) {
        std::string all = std::to_string(extents[0]);
        for (std::size_t i = 1; i < range.dimensions; ++i) all += "x" + std::to_string(extents[i]);
        return all;
    };
    const std::array<std::size_t, 3>& local = range.local;
    const std::array<std::size_t, 3>& required = variant.required_work_group;
    const auto end = local.begin() + static_cast<std::ptrdiff_t>(range.dimensions);
    const std::size_t items =
        std::accumulate(local.begin(), end, std::size_t{1}, std::multiplies<std::size_t>());
    const std::string begin = "the work-groups of " + text(local) + " work-items ";
    if (local[0] == 0)
        return required[0] == 0 ? ""
                                : "kernel " + name + " requires work-groups of " + text(required) +
                                      ", which do not divide the range of " + text(range.global);
    if (required[0] != 0 && !std::equal(local.begin(), end, required.begin()))
        return begin + "are not the " + text(required) + " that kernel " + name + " requires";
    if (items > variant.work_group_limit)
        return begin + "exceed the limit of " + std::to_string(variant.work_group_limit) +
               " work-items that kernel " + name + " has on " + device.info.name;
    for (std::size_t i = 0; i < range.dimensions; ++i)
        if (range.global[i] % local[i] != 0)
            return begin + "do not divide the range of " + text(range.global) +
                   ": see Range::padded";
    const auto most =
        opencl([&] { return device.device.getInfo<CL_DEVICE_MAX_WORK_ITEM_SIZES>(); });
    for (std::size_t i = 0; i < std::min(range.dimensions, most.size()); ++i)
        if (local[i] > most[i])
            return begin + "exceed the limit of " + std::to_string(most[i]) +
                   " work-items in dimension " + std::to_string(i);
    return {};
}

}  // namespace

struct Kernel::Impl {
    std::shared_ptr<detail::DeviceState> device;
    Source source;
    std::string name;
    detail::Definitions definitions;
    std::map<cl_uint, Variant> variants;  ///< by modes

    /// Checks all arguments, then sets them.
    void set(Variant& variant, const Arguments& arguments) const {
        const auto list = arguments.list();
        if (list.size() != variant.parameters.size())
            throw Error("kernel " + name + " takes " +
                        std::to_string(written(variant.parameters, arguments.modes())) +
                        " arguments and was given " +
                        std::to_string(written(list, arguments.modes())) +
                        " (a container counts as one; build(kernel, ...) passes it first)");
        const detail::ArgumentCheck check(*device, definitions, name);
        std::size_t before = 0;  // further parameters of containers
        for (cl_uint i = 0; i < list.size(); ++i) {
            check(i + 1 - before, variant.parameters[i], list[i], arguments.data(list[i]));
            if (list[i].is_container) before += more_parameters(arguments.modes());
        }
        check_local_memory(*device, name, variant, list);
        opencl([&] {
            for (cl_uint i = 0; i < list.size(); ++i)
                variant.kernel.setArg(i, list[i].size, arguments.data(list[i]));
        });
    }

    void launch(Variant& variant, const Range& range, cl::Event* event) const try {
        const cl::CommandQueue& queue = device->ordered_queue();
        const auto& extents = range.global;
        if (std::find(extents.begin(), extents.end(), 0u) != extents.end()) {
            if (event != nullptr) queue.enqueueMarkerWithWaitList(nullptr, event);
        } else {
            queue.enqueueNDRangeKernel(
                variant.kernel, cl::NullRange, nd_range(range.global, range.dimensions),
                work_group(range, variant.required_work_group, variant.work_group_limit), nullptr,
                event);
        }
    } catch (const cl::Error& error) {
        const bool by_size =
            error.err() == CL_INVALID_WORK_GROUP_SIZE || error.err() == CL_INVALID_WORK_ITEM_SIZE;
        throw OpenClError(error.what(), error.err(),
                          by_size ? work_group_fault(*device, name, variant, range) : "");
    }

    /// The kernel for containers of these modes; compiles it the first time.
    Variant& variant(cl_uint modes) {
        if (const auto known = variants.find(modes); known != variants.end()) return known->second;
        detail::Program program = compile(*device, source, definitions, modes);
        return opencl([&]() -> Variant& {
            Variant made;
            made.kernel = kernel_called(program.program, name, source);
            made.program = std::move(program);
            made.parameters = parameters_of(made.kernel, definitions);
            made.work_group_limit =
                made.kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device->device);
            made.own_local_bytes =
                made.kernel.getWorkGroupInfo<CL_KERNEL_LOCAL_MEM_SIZE>(device->device);
            made.required_work_group =
                made.kernel.getWorkGroupInfo<CL_KERNEL_COMPILE_WORK_GROUP_SIZE>(device->device);
            return variants.emplace(modes, std::move(made)).first->second;
        });
    }
};

Source Source::from_file(const std::string& path, const std::string& options) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    // A directory opens, and only reading it fails.
    if (file.peek() != std::ifstream::traits_type::eof()) text << file.rdbuf();
    if (!file.is_open() || file.bad())
        throw Error("cannot read the kernel source " + path + ": " +
                    std::generic_category().message(errno));
    return {.text = std::move(text).str(), .file_name = path, .options = options};
}

Kernel::Kernel(std::shared_ptr<detail::DeviceState> device, const Source& source,
               const std::string& name, const detail::Definitions& definitions)
    : impl_("a Kernel",
            std::unique_ptr<Impl>(new Impl{std::move(device), source, name, definitions, {}})) {
    impl_->variant(definitions.modes);
}

Kernel::Kernel(Kernel&&) noexcept = default;
Kernel& Kernel::operator=(Kernel&&) noexcept = default;
Kernel::~Kernel() = default;

const std::string& Kernel::name() const { return impl_->name; }
const cl::Kernel& Kernel::cl() const { return impl_->variants.at(impl_->definitions.modes).kernel; }

std::string Kernel::log() const {
    const Impl& own = *impl_;
    const cl_uint modes = own.definitions.modes;
    const std::string log = own.variants.at(modes).program.log(own.device->device);
    if (log.empty()) return log;
    return whole_source(own.source, own.definitions, modes, own.device->info).in_parts(log);
}

void Kernel::enqueue(const Range& range, const Arguments& given, cl::Event* event) {
    std::optional<Arguments> all;
    if ((given.modes() & CELLIST_DISTRIBUTED_MODE) != 0) all = with_distributions(given);
    const Arguments& arguments = all ? *all : given;
    Variant& variant =
        impl_->variant(arguments.modes() != 0 ? arguments.modes() : impl_->definitions.modes);
    impl_->set(variant, arguments);
    for (const Arguments::ClosedLists& closed : arguments.closed_lists())
        detail::Build::note_bystander(closed.lists, variant.parameters[closed.index].name,
                                      impl_->name);

    const detail::OtherQueues others(*impl_->device, arguments);
    if (others.empty()) return impl_->launch(variant, range, event);
    cl::Event done = others.run_between([&] {
        cl::Event launched;
        impl_->launch(variant, range, &launched);
        return launched;
    });
    if (event != nullptr) *event = std::move(done);
}

}  // namespace cellist
