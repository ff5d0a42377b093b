#pragma once

#include <algorithm>
#include <bit>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

#include <cellist/device.hpp>
#include <cellist/error.hpp>

#include "profile.hpp"
#include "staging.hpp"

namespace cellist::detail {

/// What a Device and everything made from it share.
struct DeviceState {
    cl::Context context;
    cl::CommandQueue queue;
    cl::Device device;
    DeviceInfo info;
    bool out_of_order = false;  ///< the queue
    std::shared_ptr<Staging> staging;

    /// The queue, for one command that starts after all that were enqueued before.
    const cl::CommandQueue& ordered_queue() const;
    /// Completes when all that was enqueued has.
    [[nodiscard]] cl::Event marker() const;

    /// The program with this source and these options; builds it the first time. It stays where it is.
    /// Throws OpenClError with the compiler's log. Any thread may call it.
    const cl::Program& program(const std::string& source, const std::string& options);

    /// What `cellist tune` has stored of the device. Read the first time; any thread may call it.
    const std::optional<Profile>& profile();

private:
    std::mutex mutex_;
    std::once_flag profile_once_;
    std::optional<Profile> profile_;
    std::unordered_map<std::string, cl::Program> programs_;  ///< by options and source
};

/// Whether a device had no memory for what was asked of it.
inline bool out_of_memory(const OpenClError& error) {
    return error.code() == CL_MEM_OBJECT_ALLOCATION_FAILURE ||
           error.code() == CL_OUT_OF_RESOURCES || error.code() == CL_OUT_OF_HOST_MEMORY;
}

/// Throws OpenClError if a call of the C interface has failed.
inline void check(const char* call, cl_int code) {
    if (code != CL_SUCCESS) throw OpenClError(call, code);
}

/// Places for the threads of a device that has some (threads.clh): twice as many, so that a table of them is
/// never crowded; a power of two.
inline cl_uint hands_of(const DeviceInfo& device) {
    return std::bit_ceil(std::max(2 * device.compute_units, 8U));
}

/// Runs OpenCL calls and turns their failure into the library's error.
template <class Call>
decltype(auto) opencl(Call&& call) {
    try {
        return call();
    } catch (const cl::Error& error) {
        throw OpenClError(error.what(), error.err());
    }
}

}  // namespace cellist::detail
