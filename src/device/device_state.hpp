// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

#include <cellist/device.hpp>
#include <cellist/error.hpp>

#include "device/pinned_staging.hpp"
#include "device/profile.hpp"
#include "device/programs.hpp"

namespace cellist::detail {

/// What a Device and everything made from it share.
struct CELLIST_API DeviceState {
    /// Throws cl::Error.
    DeviceState(cl::Context its_context, cl::CommandQueue its_queue, cl::Device its_device,
                bool is_out_of_order, bool owns_its_queue);
    DeviceState(const DeviceState&) = delete;
    DeviceState& operator=(const DeviceState&) = delete;
    /// Blocks until the work in a queue of its own has run: PoCL crashes if the process ends
    /// before.
    ~DeviceState();

    cl::Context context;
    cl::CommandQueue queue;
    cl::Device device;
    DeviceInfo info;
    bool out_of_order;                 ///< the queue
    bool owns_queue;                   ///< nobody else has made it
    std::uint64_t max_constant_bytes;  ///< of a buffer in constant memory
    std::shared_ptr<PinnedStaging> staging;
    Programs programs;

    /// The queue, for one command that starts after all that were enqueued before.
    const cl::CommandQueue& ordered_queue() const;
    /// Completes when all that was enqueued has.
    [[nodiscard]] cl::Event enqueue_marker() const;

    /// See Device::prepare.
    void prepare(const std::function<void()>& frame,
                 const std::function<void(std::size_t)>& progress);

    /// What `cellist tune` has stored of the device. Read the first time; any thread may call it.
    const std::optional<Profile>& profile();

private:
    std::once_flag profile_once_;
    std::optional<Profile> profile_;
};

/// Throws OpenClError if a call of the C interface has failed.
inline void check(const char* call, cl_int code) {
    if (code != CL_SUCCESS) throw OpenClError(call, code);
}

/// A count of 64 bits that kernels keep in two words.
inline std::uint64_t wide(cl_uint low, cl_uint high) { return (std::uint64_t{high} << 32) | low; }

/// The devices that a selector names, by their index in Device::all(): see Device::choose(). Throws
/// Error if there is none.
[[nodiscard]] CELLIST_API std::vector<std::size_t> devices_called(std::string_view selector);

/// Places for the threads of a device that has some (threads.clh): twice as many, so that a table
/// of them is never crowded; a power of two.
inline cl_uint thread_slots_of(const DeviceInfo& device) {
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
