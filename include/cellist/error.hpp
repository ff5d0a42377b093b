// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

#include <cellist/detail/api.hpp>
#include <cellist/opencl.hpp>
#include <cellist/report.hpp>

namespace cellist {

/// The base of all exceptions of the library. The message names the value and the limit.
class CELLIST_API Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// An OpenCL call failed, for example because the device or the driver is out of memory.
class CELLIST_API OpenClError : public Error {
public:
    OpenClError(std::string call, cl_int code, std::string log = {});

    /// The failed function, e.g. "clBuildProgram".
    [[nodiscard]] const std::string& call() const { return call_; }
    /// Its error code, e.g. CL_BUILD_PROGRAM_FAILURE.
    [[nodiscard]] cl_int code() const { return code_; }
    /// The compiler's log if a program failed to build, with the line numbers of the user's source.
    /// Otherwise empty.
    [[nodiscard]] const std::string& log() const { return log_; }

private:
    std::string call_;
    cl_int code_;
    std::string log_;
};

/// A request exceeds the memory for it: the host's memory, the device's largest allocation, the
/// budget, or the pool. The library throws it before it calls a driver. out_of_memory() also
/// recognises the drivers' errors.
class CELLIST_API MemoryError : public Error {
public:
    using Error::Error;
};

/// The records of a build did not fit: under Overflow::stop, or because the pool could not grow.
/// The container is empty.
class CELLIST_API OverflowError : public MemoryError {
public:
    OverflowError(const std::string& message, const BuildReport& report)
        : MemoryError(message), report_(report) {}

    /// The report of the failed pass. The records to store were stored + dropped. In
    /// Storage::fixed, the pool needs slots for the longest list in every cell; what() has its
    /// length.
    [[nodiscard]] const BuildReport& report() const { return report_; }

private:
    BuildReport report_;
};

/// Returns true if an error means too little memory: a MemoryError, or an OpenClError with
/// CL_MEM_OBJECT_ALLOCATION_FAILURE, CL_OUT_OF_RESOURCES or CL_OUT_OF_HOST_MEMORY. Use it in a
/// handler:
///
///     catch (const cellist::Error& error) {
///         if (!cellist::out_of_memory(error)) throw;
///         ... // fewer records, a smaller budget, another storage, Lists::build_slices()
///     }
[[nodiscard]] CELLIST_API bool out_of_memory(const Error& error) noexcept;

/// Returns the name of an OpenCL error code, e.g. "CL_OUT_OF_RESOURCES", or "unknown error".
[[nodiscard]] CELLIST_API const char* error_name(cl_int code);

}  // namespace cellist
