// SPDX-License-Identifier: MIT
#include "device/programs.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "device/device_state.hpp"
#include "device/preparation.hpp"
#include "device/program_text.hpp"

namespace cellist::detail {

namespace {

/// The log, up to the first NUL: drivers differ in whether they count it.
std::string build_log(const cl::Program& program, const cl::Device& device) {
    const std::string all = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
    std::istringstream lines(all.substr(0, all.find('\0')));
    std::string log;
    for (std::string line; std::getline(lines, line);) {
        // NVIDIA's compiler adds an attribute of its own to kernels, and warns of it.
        if (!line.ends_with("is a kernel, so overriding noinline attribute. "
                            "The function may be inlined when called."))
            log += line + '\n';
    }
    log.erase(0, log.find_first_not_of(" \n"));
    log.erase(log.find_last_not_of(" \n") + 1);
    return log;
}

/// Whether the kernels tell their parameters, which not every driver keeps in binaries.
bool tells_parameters(cl::Program& program) {
    std::vector<cl::Kernel> kernels;
    program.createKernels(&kernels);
    for (const cl::Kernel& kernel : kernels) {
        if (kernel.getInfo<CL_KERNEL_NUM_ARGS>() == 0) continue;
        std::size_t bytes = 0;
        if (clGetKernelArgInfo(kernel(), 0, CL_KERNEL_ARG_TYPE_NAME, 0, nullptr, &bytes) !=
                CL_SUCCESS ||
            bytes <= 1)
            return false;
    }
    return true;
}

}  // namespace

std::string Program::log(const cl::Device& device) const {
    return stored_log ? *stored_log : opencl([&] { return build_log(program, device); });
}

Programs::Programs(const cl::Context& context, const cl::Device& device, const DeviceInfo& info)
    : context_(context),
      device_(device),
      stores_at_once_(info.platform != "Portable Computing Language"),
      files_(info) {}

Program Programs::get(const std::string& source, const std::string& options) {
    const std::string key = options + '\0' + source;
    Program made;
    {
        const std::lock_guard lock(mutex_);
        if (const Program* known = programs_.find(key)) return opencl([&] { return *known; });
        if (includes_files(source, options)) {
            // Drivers cache programs as well, and some ignore included files: no text is used
            // twice.
            static std::atomic<std::uint64_t> count = std::random_device{}();
            return build(source + "\n// " + std::to_string(++count) + "\n", options);
        }
        std::optional<Program> loaded = load(key, options);
        Program& kept = programs_.add(key, loaded ? std::move(*loaded) : build(source, options));
        if (stores_at_once_) store(key, kept);
        made = opencl([&] { return kept; });
    }
    if (Preparation* preparation = Preparation::current()) preparation->count_program();
    return made;
}

Program Programs::build(const std::string& source, const std::string& options) const {
    return opencl([&] {
        cl::Program program(context_, source);
        // Not by the bindings, which ask for the log of every build, and where that fails, throw
        // that.
        const cl_int code =
            clBuildProgram(program(), 1, &device_(), options.c_str(), nullptr, nullptr);
        if (code == CL_SUCCESS) return Program{std::move(program)};
        std::string log;
        try {
            log = build_log(program, device_);
        } catch (const cl::Error&) {
            // There is none to be had.
        }
        throw OpenClError("clBuildProgram", code, log);
    });
}

/// None if the driver does not take the binary of the file. The source is then built: where the
/// device is the cause, that fails as well.
std::optional<Program> Programs::load(const std::string& key, const std::string& options) const {
    std::optional<StoredProgram> stored = files_.load(key);
    if (!stored) return {};
    try {
        const auto* bytes = reinterpret_cast<const unsigned char*>(stored->binary.data());
        const std::size_t size = stored->binary.size();
        cl_int code = CL_SUCCESS;
        cl::Program program(
            clCreateProgramWithBinary(context_(), 1, &device_(), &size, &bytes, nullptr, &code));
        if (code != CL_SUCCESS || clBuildProgram(program(), 1, &device_(), options.c_str(), nullptr,
                                                 nullptr) != CL_SUCCESS)
            return {};
        if (!tells_parameters(program)) return {};
        return Program{std::move(program), std::move(stored->log), true};
    } catch (const cl::Error&) {
        return {};
    }
}

void Programs::store() {
    const std::lock_guard lock(mutex_);
    for (auto& [key, program] : programs_) store(key, program);
}

/// A failure leaves the program without a file.
void Programs::store(const std::string& key, Program& program) const {
    if (std::exchange(program.has_file, true) || !files_.path_of(key)) return;
    try {
        std::size_t size = 0;
        check("clGetProgramInfo", clGetProgramInfo(program.program(), CL_PROGRAM_BINARY_SIZES,
                                                   sizeof size, &size, nullptr));
        std::string binary(size, '\0');
        char* bytes = binary.data();
        check("clGetProgramInfo", clGetProgramInfo(program.program(), CL_PROGRAM_BINARIES,
                                                   sizeof bytes, &bytes, nullptr));
        if (size > 0) files_.store(key, {program.log(device_), std::move(binary)});
    } catch (const Error&) {
        // The next process builds it again.
    }
}

}  // namespace cellist::detail
