// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <cellist/detail/api.hpp>
#include <cellist/detail/owned.hpp>
#include <cellist/opencl.hpp>

namespace cellist {

namespace detail {
struct DeviceState;
}

/// The properties of a device.
struct DeviceInfo {
    std::string name;
    std::string platform;
    std::string version;  ///< OpenCL version, e.g. "OpenCL 3.0 CUDA"
    std::string driver;
    cl_device_type type = 0;
    std::uint64_t global_memory_bytes = 0;
    std::uint64_t max_allocation_bytes = 0;  ///< largest single buffer
    std::uint64_t local_memory_bytes = 0;    ///< per work-group
    std::uint32_t compute_units = 0;
    std::size_t max_work_group_size = 0;
    bool int64_atomics = false;
    bool sub_groups = false;
    bool fp64 = false;
    /// The work-items of a warp can exchange values: NVIDIA, compute capability 7.0 or later.
    bool warp_aggregation = false;
    /// A work-group runs on one thread: PoCL on x86-64 and AArch64 processors.
    bool one_thread_per_work_group = false;

    /// Whether the type includes CL_DEVICE_TYPE_GPU.
    [[nodiscard]] bool is_gpu() const { return (type & CL_DEVICE_TYPE_GPU) != 0; }
};

/// An OpenCL device with a context, a queue and a cache of built programs. Objects that are made
/// from a Device share these, and stay valid after the Device object is destroyed. The destructor
/// of the last of them blocks until all work in the queue has run, unless the queue is the
/// caller's. Movable, not copyable. Using a moved-from Device throws Error. Every function that
/// calls OpenCL throws OpenClError if the call fails.
///
/// Several threads may use one Device and the objects made from it, if each object is used by one
/// thread at a time.
class CELLIST_API Device {
public:
    /// Returns the device that the environment variable CELLIST_DEVICE names, as in
    /// choose(selector). If the variable is unset or empty, returns the first GPU, or else the
    /// first device. Throws Error if there is none. The queue is in order. It does not profile,
    /// because profiling would double the time of small builds.
    [[nodiscard]] static Device choose();

    /// Returns the device with this index in all(), or the first whose name or platform contains
    /// the selector, in any case. Throws Error if there is none; the message lists the devices.
    [[nodiscard]] static Device choose(std::string_view selector);

    /// Works on the caller's own context and queue. Throws Error if the queue belongs to another
    /// context. Events have times if the queue was made with CL_QUEUE_PROFILING_ENABLE.
    ///
    /// Several Devices may share a context. If a kernel of one uses Lists or Buffers of another, it
    /// runs in order with the commands of the other's queue. In an out-of-order queue, every
    /// command of the library starts after all commands that were enqueued before it, including the
    /// caller's.
    Device(cl::Context context, cl::CommandQueue queue);

    Device(Device&&) noexcept;
    Device& operator=(Device&&) noexcept;
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    ~Device();

    /// Returns all devices of all platforms, in the order of choose()'s index. Empty if there is no
    /// platform.
    [[nodiscard]] static std::vector<DeviceInfo> all();

    [[nodiscard]] const DeviceInfo& info() const;
    [[nodiscard]] const cl::Context& context() const;
    [[nodiscard]] const cl::CommandQueue& queue() const;

    /// Blocks until all enqueued work has run.
    void finish() const;

    /// Makes later commands start after these events, of any queue of the context. Does not block.
    void enqueue_wait(const std::vector<cl::Event>& events) const;
    /// Returns an event that completes after all enqueued work. Does not block.
    [[nodiscard]] cl::Event enqueue_marker() const;

    /// Compiles what `frame` needs, so that later calls of it do not pause. `frame` makes the calls
    /// of a frame: builds, sorts, reads and Kernel::run, with its real ranges and about its real
    /// number of records. Call prepare() once, before the first frame.
    ///
    ///     device.prepare([&] { hits.build(insert, n, rays); hits.sort(&Hit::depth); });
    ///
    /// prepare() runs `frame` at least twice and until a run compiles nothing, at most 64 times:
    /// some storages build in another way the second time. In Storage::automatic, blocking builds
    /// also end their trial. Sorts compile what lists of all lengths need. At the end, prepare()
    /// stores the programs in the library's cache of programs (docs/devices.md).
    ///
    /// `progress` is called after each program that was compiled, or loaded from the cache, with
    /// the number of programs so far. Throws what `frame` and `progress` throw, and Error if
    /// `frame` calls prepare(). Blocks until everything has run.
    void prepare(const std::function<void()>& frame,
                 const std::function<void(std::size_t programs)>& progress = {}) const;

    /// @private
    [[nodiscard]] const std::shared_ptr<detail::DeviceState>& state() const {
        return state_.pointer();
    }

private:
    explicit Device(const cl::Device& device);
    detail::Owned<std::shared_ptr<detail::DeviceState>> state_;
};

}  // namespace cellist
