#pragma once

#include <stdexcept>
#include <string>

#include <cellist/opencl.hpp>
#include <cellist/report.hpp>

namespace cellist {

/// Base of everything that the library throws. The message names the value and the limit.
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// An OpenCL call failed, for example because the device or the driver is out of memory.
class OpenClError : public Error {
public:
    OpenClError(std::string call, cl_int code, std::string log = {});

    /// The function that failed, e.g. "clBuildProgram".
    [[nodiscard]] const std::string& call() const { return call_; }
    /// Its error code, e.g. CL_BUILD_PROGRAM_FAILURE.
    [[nodiscard]] cl_int code() const { return code_; }
    /// The compiler's log where a program failed to build, with the line numbers of the user's own
    /// source; otherwise empty.
    [[nodiscard]] const std::string& log() const { return log_; }

private:
    std::string call_;
    cl_int code_;
    std::string log_;
};

/// Something is larger than the memory for it: the host's, the device's largest allocation, the
/// budget, or the pool. Thrown before any driver is asked; out_of_memory() covers the drivers, too.
class MemoryError : public Error {
public:
    using Error::Error;
};

/// A build did not fit under Overflow::stop, or could not grow. The container is empty.
class OverflowError : public MemoryError {
public:
    OverflowError(const std::string& message, const BuildReport& report)
        : MemoryError(message), report_(report) {}

    /// The failed pass: what was attempted and what would have been needed (stored + dropped).
    [[nodiscard]] const BuildReport& report() const { return report_; }

private:
    BuildReport report_;
};

/// Whether an error means that there was not enough memory: a MemoryError, or an OpenClError with
/// CL_MEM_OBJECT_ALLOCATION_FAILURE, CL_OUT_OF_RESOURCES or CL_OUT_OF_HOST_MEMORY. Use it in a
/// handler:
///
///     catch (const cellist::Error& error) {
///         if (!cellist::out_of_memory(error)) throw;
///         ... // fewer records, a smaller budget, another storage, Lists::build_slices()
///     }
[[nodiscard]] bool out_of_memory(const Error& error) noexcept;

/// The name of an OpenCL error code, e.g. "CL_OUT_OF_RESOURCES"; "unknown error" if it has none.
[[nodiscard]] const char* error_name(cl_int code);

}  // namespace cellist
