// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <utility>

#include <cellist/device.hpp>

#include "device/device_state.hpp"
#include "device/preparation.hpp"

namespace cellist {

namespace {

using detail::check;

/// Every device of every platform. No platform and no device are not errors.
std::vector<cl::Device> all_devices() {
    constexpr cl_int platform_not_found = -1001;  // CL_PLATFORM_NOT_FOUND_KHR
    cl_uint count = 0;
    cl_int code = clGetPlatformIDs(0, nullptr, &count);
    if (code == platform_not_found || (code == CL_SUCCESS && count == 0)) return {};
    check("clGetPlatformIDs", code);
    std::vector<cl_platform_id> ids(count);
    check("clGetPlatformIDs", clGetPlatformIDs(count, ids.data(), nullptr));
    std::vector<cl::Device> devices;
    for (const cl_platform_id platform : ids) {
        code = clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count);
        if (code == CL_DEVICE_NOT_FOUND || (code == CL_SUCCESS && count == 0)) continue;
        check("clGetDeviceIDs", code);
        std::vector<cl_device_id> handles(count);
        check("clGetDeviceIDs",
              clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, handles.data(), nullptr));
        for (const cl_device_id handle : handles) devices.emplace_back(handle, true);
    }
    return devices;
}

/// One property of a queue. Not by the bindings, which release what they could not retain.
template <class T>
T queue_info(const cl::CommandQueue& queue, cl_command_queue_info what) {
    T value{};
    check("clGetCommandQueueInfo",
          clGetCommandQueueInfo(queue(), what, sizeof value, &value, nullptr));
    return value;
}

/// The text up to the first NUL: drivers differ in whether they count it.
std::string trimmed(std::string text) {
    text.resize(std::min(text.size(), text.find('\0')));
    text.erase(0, text.find_first_not_of(' '));
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
}

// Whether kernels can tell the threads of this processor apart: see threads.clh.
#if defined(__linux__) && (defined(__x86_64__) || defined(__aarch64__))
constexpr bool knows_threads = true;
#else
constexpr bool knows_threads = false;
#endif

DeviceInfo describe(const cl::Device& device) {
    const std::string extensions = device.getInfo<CL_DEVICE_EXTENSIONS>();
    const auto has = [&](const char* name) { return extensions.find(name) != std::string::npos; };
    DeviceInfo info;
    info.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    info.platform =
        trimmed(cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>());
    info.version = trimmed(device.getInfo<CL_DEVICE_VERSION>());
    info.driver = trimmed(device.getInfo<CL_DRIVER_VERSION>());
    info.type = device.getInfo<CL_DEVICE_TYPE>();
    info.global_memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    info.max_allocation_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    info.local_memory_bytes = device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
    info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    info.max_work_group_size = device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
    info.int64_atomics = has("cl_khr_int64_base_atomics");
    info.sub_groups = has("cl_khr_subgroups") || has("cl_intel_subgroups");
    info.fp64 = device.getInfo<CL_DEVICE_DOUBLE_FP_CONFIG>() != 0;
    if (has("cl_nv_device_attribute_query"))
        info.warp_aggregation = device.getInfo<CL_DEVICE_COMPUTE_CAPABILITY_MAJOR_NV>() >= 7;
    info.one_thread_per_work_group = knows_threads &&
                                     info.platform == "Portable Computing Language" &&
                                     info.type == CL_DEVICE_TYPE_CPU && info.int64_atomics;
    return info;
}

std::string lower(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

constexpr const char* no_device =
    "no OpenCL device found: install a driver, or PoCL for the CPU (pocl-opencl-icd)";

/// The indices of the devices that a selector names.
std::vector<std::size_t> called(const std::vector<cl::Device>& devices, std::string_view selector) {
    if (devices.empty()) throw Error(no_device);
    std::string known;
    for (std::size_t i = 0; i < devices.size(); ++i)
        known += (i == 0 ? "" : ", ") + std::to_string(i) + " = " + describe(devices[i]).name;

    std::size_t index = 0;
    const char* end = selector.data() + selector.size();
    const auto [stop, error] = std::from_chars(selector.data(), end, index);
    if (error != std::errc::invalid_argument && stop == end) {
        if (error == std::errc() && index < devices.size()) return {index};
        throw Error("no device has the index " + std::string(selector) + "; there are: " + known);
    }

    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const DeviceInfo info = describe(devices[i]);
        if (!selector.empty() &&
            lower(info.name + "\n" + info.platform).find(lower(selector)) != std::string::npos)
            found.push_back(i);
    }
    if (found.empty())
        throw Error("no device is called '" + std::string(selector) + "'; there are: " + known);
    return found;
}

}  // namespace

Device Device::choose() {
    const char* selector = std::getenv("CELLIST_DEVICE");
    if (selector != nullptr && *selector != '\0') return choose(selector);
    return detail::opencl([] {
        const std::vector<cl::Device> devices = all_devices();
        if (devices.empty()) throw Error(no_device);
        const auto gpu = std::find_if(devices.begin(), devices.end(), [](const cl::Device& device) {
            return (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU) != 0;
        });
        return Device(gpu != devices.end() ? *gpu : devices.front());
    });
}

Device Device::choose(std::string_view selector) {
    return detail::opencl([&] {
        const std::vector<cl::Device> devices = all_devices();
        return Device(devices[called(devices, selector).front()]);
    });
}

Device::Device(const cl::Device& device)
    : state_("a Device", detail::opencl([&] {
                 cl::Context context(device);
                 cl::CommandQueue queue(context, device);
                 return std::make_shared<detail::DeviceState>(std::move(context), std::move(queue),
                                                              device, false, true);
             })) {}

Device::Device(cl::Context context, cl::CommandQueue queue)
    : state_("a Device", detail::opencl([&] {
                 if (queue_info<cl_context>(queue, CL_QUEUE_CONTEXT) != context())
                     throw Error("the command queue belongs to another context");
                 const bool out_of_order =
                     (queue_info<cl_command_queue_properties>(queue, CL_QUEUE_PROPERTIES) &
                      CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE) != 0;
                 cl::Device device(queue_info<cl_device_id>(queue, CL_QUEUE_DEVICE), true);
                 return std::make_shared<detail::DeviceState>(
                     std::move(context), std::move(queue), std::move(device), out_of_order, false);
             })) {}

Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;
Device::~Device() = default;

std::vector<DeviceInfo> Device::all() {
    return detail::opencl([] {
        std::vector<DeviceInfo> infos;
        for (const cl::Device& device : all_devices()) infos.push_back(describe(device));
        return infos;
    });
}

const DeviceInfo& Device::info() const { return state_->info; }
const cl::Context& Device::context() const { return state_->context; }
const cl::CommandQueue& Device::queue() const { return state_->queue; }

void Device::finish() const {
    detail::opencl([&] { state_->queue.finish(); });
}

void Device::enqueue_wait(const std::vector<cl::Event>& events) const {
    if (events.empty()) return;
    detail::opencl([&] { state_->queue.enqueueBarrierWithWaitList(&events); });
}

cl::Event Device::enqueue_marker() const { return state_->enqueue_marker(); }

void Device::prepare(const std::function<void()>& frame,
                     const std::function<void(std::size_t programs)>& progress) const {
    state_->prepare(frame, progress);
}

namespace detail {

std::vector<std::size_t> devices_called(std::string_view selector) {
    return opencl([&] { return called(all_devices(), selector); });
}

DeviceState::DeviceState(cl::Context its_context, cl::CommandQueue its_queue, cl::Device its_device,
                         bool is_out_of_order, bool owns_its_queue)
    : context(std::move(its_context)),
      queue(std::move(its_queue)),
      device(std::move(its_device)),
      info(cellist::describe(device)),
      out_of_order(is_out_of_order),
      owns_queue(owns_its_queue),
      max_constant_bytes(device.getInfo<CL_DEVICE_MAX_CONSTANT_BUFFER_SIZE>()),
      staging(std::make_shared<PinnedStaging>(context, queue)),
      programs(context, device, info) {}

// Not by the bindings, which throw. A failure is of no use to anybody any more.
DeviceState::~DeviceState() {
    if (owns_queue) clFinish(queue());
}

const cl::CommandQueue& DeviceState::ordered_queue() const {
    if (out_of_order) opencl([&] { queue.enqueueBarrierWithWaitList(); });
    return queue;
}

cl::Event DeviceState::enqueue_marker() const {
    return opencl([&] {
        cl::Event event;
        queue.enqueueMarkerWithWaitList(nullptr, &event);
        return event;
    });
}

const std::optional<Profile>& DeviceState::profile() {
    std::call_once(profile_once_, [&] { profile_ = load_profile(info); });
    return profile_;
}

void DeviceState::prepare(const std::function<void()>& frame,
                          const std::function<void(std::size_t)>& progress) {
    Preparation(progress).run([&] {
        frame();
        opencl([&] { queue.finish(); });
    });
    programs.store();
}

}  // namespace detail
}  // namespace cellist
