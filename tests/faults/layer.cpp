// SPDX-License-Identifier: MIT
// What the drivers' entry points are replaced by: see layer.hpp. The loader's side of a layer is
// CL/cl_layer.h, the list of entry points CL/cl_icd.h.
#define CL_TARGET_OPENCL_VERSION 300
#define CL_USE_DEPRECATED_OPENCL_1_0_APIS
#define CL_USE_DEPRECATED_OPENCL_1_1_APIS
#define CL_USE_DEPRECATED_OPENCL_1_2_APIS
#define CL_USE_DEPRECATED_OPENCL_2_0_APIS
#define CL_USE_DEPRECATED_OPENCL_2_1_APIS
#define CL_USE_DEPRECATED_OPENCL_2_2_APIS
#include "layer.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>

#include <CL/cl_layer.h>

namespace cellist::faults {
namespace {

struct Object {
    References::Kind kind;
    std::uint64_t references;
    std::uint64_t bytes;  ///< of a buffer
};

std::mutex mutex;  ///< of everything that follows
std::optional<Plan> plan;
int pauses = 0;
std::uint64_t calls = 0;
std::map<std::string, std::uint64_t> calls_by_name;
std::vector<Fault> failed;
std::map<const void*, Object> objects;
std::uint64_t too_many_releases = 0;

cl_icd_dispatch drivers{};  ///< where calls go to
cl_icd_dispatch layer{};    ///< where calls come from

struct Verdict {
    cl_int code = CL_SUCCESS;  ///< what the call fails with, if it does
    bool first = false;        ///< no call has failed before
};

/// Counts a call.
Verdict next_call(const char* name, cl_int resources, cl_int object) {
    const std::lock_guard lock(mutex);
    ++calls_by_name[name];
    if (!plan || pauses > 0) return {};
    ++calls;
    const bool lost = plan->extent == Plan::Extent::lasting && calls > plan->call;
    if (calls != plan->call && calls != plan->again && !lost) return {};
    const cl_int code = plan->code == Plan::Code::resources ? resources : object;
    failed.push_back({name, code});
    return {code, failed.size() == 1};
}

void created(const void* handle, References::Kind kind) {
    if (handle == nullptr) return;
    std::size_t bytes = 0;
    if (kind == References::buffer)
        drivers.clGetMemObjectInfo(static_cast<cl_mem>(const_cast<void*>(handle)), CL_MEM_SIZE,
                                   sizeof bytes, &bytes, nullptr);
    const std::lock_guard lock(mutex);
    objects[handle] = {kind, 1, bytes};
}

void retained(const void* handle) {
    const std::lock_guard lock(mutex);
    if (const auto object = objects.find(handle); object != objects.end())
        ++object->second.references;
}

/// False if there was no reference to release.
bool released(const void* handle) {
    const std::lock_guard lock(mutex);
    const auto object = objects.find(handle);
    if (object == objects.end()) {
        ++too_many_releases;
        return false;
    }
    if (--object->second.references == 0) objects.erase(object);
    return true;
}

/// What is known of a type of handle: the code of an invalid one.
template <class T>
constexpr cl_int invalid = CL_SUCCESS;
template <>
constexpr cl_int invalid<cl_platform_id> = CL_INVALID_PLATFORM;
template <>
constexpr cl_int invalid<cl_device_id> = CL_INVALID_DEVICE;
template <>
constexpr cl_int invalid<cl_context> = CL_INVALID_CONTEXT;
template <>
constexpr cl_int invalid<cl_command_queue> = CL_INVALID_COMMAND_QUEUE;
template <>
constexpr cl_int invalid<cl_mem> = CL_INVALID_MEM_OBJECT;
template <>
constexpr cl_int invalid<cl_program> = CL_INVALID_PROGRAM;
template <>
constexpr cl_int invalid<cl_kernel> = CL_INVALID_KERNEL;
template <>
constexpr cl_int invalid<cl_sampler> = CL_INVALID_SAMPLER;
template <>
constexpr cl_int invalid<cl_event> = CL_INVALID_EVENT;

/// The code for the first argument that is a handle.
template <class... Args>
constexpr cl_int invalid_object() {
    cl_int code = CL_SUCCESS;
    ((code = code != CL_SUCCESS ? code : invalid<Args>), ...);
    return code != CL_SUCCESS ? code : CL_INVALID_VALUE;
}

References::Kind kind_of(cl_context) { return References::context; }
References::Kind kind_of(cl_command_queue) { return References::queue; }
References::Kind kind_of(cl_program) { return References::program; }
References::Kind kind_of(cl_kernel) { return References::kernel; }
References::Kind kind_of(cl_sampler) { return References::sampler; }
References::Kind kind_of(cl_event) { return References::event; }
References::Kind kind_of(cl_mem memory) {
    cl_mem_object_type type = CL_MEM_OBJECT_BUFFER;
    drivers.clGetMemObjectInfo(memory, CL_MEM_TYPE, sizeof type, &type, nullptr);
    return type == CL_MEM_OBJECT_BUFFER ? References::buffer : References::image;
}

template <class T>
void take_event(const T&) {}
void take_event(cl_event* event) {
    if (event != nullptr) created(*event, References::event);
}

/// Stands for one entry point.
template <auto Entry>
struct Call;
template <class Result, class... Args, Result (CL_API_CALL* cl_icd_dispatch::*Entry)(Args...)>
struct Call<Entry> {
    static inline const char* name = nullptr;
    static inline cl_int code = CL_SUCCESS;
    /// Where a wait fails after another failure, it does wait: a program can do no more to know
    /// that a device has stopped to write to its memory.
    static constexpr bool waits = std::is_same_v<Call, Call<&cl_icd_dispatch::clFinish>> ||
                                  std::is_same_v<Call, Call<&cl_icd_dispatch::clWaitForEvents>>;

    /// An entry point that fails. What it creates is counted: its result, or the event of a
    /// command.
    static Result CL_API_CALL fallible(Args... arguments) {
        if (const Verdict verdict = next_call(name, code, invalid_object<Args...>());
            verdict.code != CL_SUCCESS) {
            if (waits && !verdict.first) (drivers.*Entry)(arguments...);
            return failed(verdict.code, arguments...);
        }
        const Result result = (drivers.*Entry)(arguments...);
        if constexpr (!std::is_same_v<Result, cl_int>) {
            if constexpr (std::is_same_v<Result, void*>)
                result != nullptr ? (take_event(arguments), ...) : void();
            else if (result != nullptr)
                created(result, kind_of(result));
        } else if (result == CL_SUCCESS) {
            (take_event(arguments), ...);
        }
        return result;
    }

    static Result CL_API_CALL retain(Args... handle) {
        if (const Verdict verdict = next_call(name, code, invalid_object<Args...>());
            verdict.code != CL_SUCCESS)
            return verdict.code;
        const cl_int result = (drivers.*Entry)(handle...);
        if (result == CL_SUCCESS) (retained(handle), ...);
        return result;
    }

    /// Before the driver may give the same handle to a new object.
    static Result CL_API_CALL release(Args... handle) {
        return (released(handle) && ...) ? (drivers.*Entry)(handle...) : invalid_object<Args...>();
    }

private:
    static Result failed(cl_int failure, Args... arguments) {
        if constexpr (std::is_same_v<Result, cl_int>) {
            return failure;
        } else {
            const auto last = std::get<sizeof...(Args) - 1>(std::tuple(arguments...));
            if constexpr (std::is_same_v<decltype(last), cl_int* const>)
                if (last != nullptr) *last = failure;
            return nullptr;
        }
    }
};

cl_int CL_API_CALL create_kernels(cl_program program, cl_uint room, cl_kernel* kernels,
                                  cl_uint* count) {
    cl_uint made = 0;
    const cl_int result =
        Call<&cl_icd_dispatch::clCreateKernelsInProgram>::fallible(program, room, kernels, &made);
    if (result != CL_SUCCESS) return result;
    if (count != nullptr) *count = made;
    for (cl_uint i = 0; kernels != nullptr && i < made; ++i)
        created(kernels[i], References::kernel);
    return result;
}

enum class Role { fallible, retain, release };

template <auto Entry, Role role = Role::fallible>
void wrap(const char* name, cl_int code) {
    using Wrapped = Call<Entry>;
    if (drivers.*Entry == nullptr) return;
    Wrapped::name = name;
    Wrapped::code = code;
    if constexpr (role == Role::retain)
        layer.*Entry = Wrapped::retain;
    else if constexpr (role == Role::release)
        layer.*Entry = Wrapped::release;
    else
        layer.*Entry = Wrapped::fallible;
}

#define CELLIST_WRAP(entry, code) wrap<&cl_icd_dispatch::entry>(#entry, code);
#define CELLIST_WRAP_OBJECT(object)                                                                \
    wrap<&cl_icd_dispatch::clRetain##object, Role::retain>("clRetain" #object,                     \
                                                           CL_OUT_OF_HOST_MEMORY);                 \
    wrap<&cl_icd_dispatch::clRelease##object, Role::release>("clRelease" #object, CL_SUCCESS);

/// All of OpenCL 1.0 to 3.0 but what cannot fail, with the code that tells of missing resources.
/// Devices are not counted: those of a platform are never freed.
void wrap_all() {
    CELLIST_WRAP_OBJECT(Context)
    CELLIST_WRAP_OBJECT(CommandQueue)
    CELLIST_WRAP_OBJECT(MemObject)
    CELLIST_WRAP_OBJECT(Sampler)
    CELLIST_WRAP_OBJECT(Program)
    CELLIST_WRAP_OBJECT(Kernel)
    CELLIST_WRAP_OBJECT(Event)

    CELLIST_WRAP(clGetPlatformIDs, CL_OUT_OF_HOST_MEMORY)
    CELLIST_WRAP(clGetPlatformInfo, CL_OUT_OF_HOST_MEMORY)
    CELLIST_WRAP(clGetDeviceIDs, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clGetDeviceInfo, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clCreateSubDevices, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clRetainDevice, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clCreateContext, CL_OUT_OF_HOST_MEMORY)
    CELLIST_WRAP(clCreateContextFromType, CL_OUT_OF_HOST_MEMORY)
    CELLIST_WRAP(clGetContextInfo, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clSetContextDestructorCallback, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clCreateCommandQueue, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clCreateCommandQueueWithProperties, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clGetCommandQueueInfo, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clSetCommandQueueProperty, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clSetDefaultDeviceCommandQueue, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clGetDeviceAndHostTimer, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clGetHostTimer, CL_OUT_OF_RESOURCES)

    CELLIST_WRAP(clCreateBuffer, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clCreateBufferWithProperties, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clCreateSubBuffer, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clCreateImage, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clCreateImage2D, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clCreateImage3D, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clCreateImageWithProperties, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clCreatePipe, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clGetSupportedImageFormats, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clGetMemObjectInfo, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clGetImageInfo, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clGetPipeInfo, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clSetMemObjectDestructorCallback, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clCreateSampler, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clCreateSamplerWithProperties, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clGetSamplerInfo, CL_OUT_OF_RESOURCES)

    CELLIST_WRAP(clCreateProgramWithSource, CL_OUT_OF_HOST_MEMORY)
    CELLIST_WRAP(clCreateProgramWithBinary, CL_OUT_OF_HOST_MEMORY)
    CELLIST_WRAP(clCreateProgramWithBuiltInKernels, CL_OUT_OF_HOST_MEMORY)
    CELLIST_WRAP(clCreateProgramWithIL, CL_OUT_OF_HOST_MEMORY)
    CELLIST_WRAP(clBuildProgram, CL_BUILD_PROGRAM_FAILURE)
    CELLIST_WRAP(clCompileProgram, CL_COMPILE_PROGRAM_FAILURE)
    CELLIST_WRAP(clLinkProgram, CL_LINK_PROGRAM_FAILURE)
    CELLIST_WRAP(clUnloadCompiler, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clUnloadPlatformCompiler, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clGetProgramInfo, CL_OUT_OF_HOST_MEMORY)
    CELLIST_WRAP(clGetProgramBuildInfo, CL_OUT_OF_HOST_MEMORY)
    CELLIST_WRAP(clSetProgramReleaseCallback, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clSetProgramSpecializationConstant, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clCreateKernel, CL_OUT_OF_HOST_MEMORY)
    CELLIST_WRAP(clCreateKernelsInProgram, CL_OUT_OF_HOST_MEMORY)
    CELLIST_WRAP(clCloneKernel, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clSetKernelArg, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clSetKernelArgSVMPointer, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clSetKernelExecInfo, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clGetKernelInfo, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clGetKernelArgInfo, CL_OUT_OF_HOST_MEMORY)
    CELLIST_WRAP(clGetKernelWorkGroupInfo, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clGetKernelSubGroupInfo, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clGetKernelSubGroupInfoKHR, CL_OUT_OF_RESOURCES)
    layer.clCreateKernelsInProgram = create_kernels;

    CELLIST_WRAP(clWaitForEvents, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clGetEventInfo, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clGetEventProfilingInfo, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clSetEventCallback, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clCreateUserEvent, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clSetUserEventStatus, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clFlush, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clFinish, CL_OUT_OF_RESOURCES)

    CELLIST_WRAP(clEnqueueReadBuffer, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueReadBufferRect, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueWriteBuffer, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueWriteBufferRect, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueCopyBuffer, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clEnqueueCopyBufferRect, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clEnqueueFillBuffer, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clEnqueueReadImage, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueWriteImage, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueCopyImage, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clEnqueueCopyImageToBuffer, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clEnqueueCopyBufferToImage, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clEnqueueFillImage, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clEnqueueMapBuffer, CL_MAP_FAILURE)
    CELLIST_WRAP(clEnqueueMapImage, CL_MAP_FAILURE)
    CELLIST_WRAP(clEnqueueUnmapMemObject, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueMigrateMemObjects, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clEnqueueNDRangeKernel, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clEnqueueTask, CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CELLIST_WRAP(clEnqueueNativeKernel, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueMarker, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueMarkerWithWaitList, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueWaitForEvents, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueBarrier, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueBarrierWithWaitList, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clSVMAlloc, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueSVMFree, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueSVMMemcpy, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueSVMMemFill, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueSVMMap, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueSVMUnmap, CL_OUT_OF_RESOURCES)
    CELLIST_WRAP(clEnqueueSVMMigrateMem, CL_OUT_OF_RESOURCES)
}

}  // namespace

bool Fault::lacks_memory() const {
    return code == CL_MEM_OBJECT_ALLOCATION_FAILURE || code == CL_OUT_OF_RESOURCES ||
           code == CL_OUT_OF_HOST_MEMORY;
}

void arm(const Plan& chosen) {
    const std::lock_guard lock(mutex);
    plan = chosen;
    calls = 0;
    failed.clear();
}

void disarm() {
    const std::lock_guard lock(mutex);
    plan.reset();
}

std::vector<Fault> failures() {
    const std::lock_guard lock(mutex);
    return failed;
}

std::uint64_t calls_of(const std::string& call) {
    const std::lock_guard lock(mutex);
    return calls_by_name[call];
}

Pause::Pause() {
    const std::lock_guard lock(mutex);
    ++pauses;
}

Pause::~Pause() {
    const std::lock_guard lock(mutex);
    --pauses;
}

References references() {
    const std::lock_guard lock(mutex);
    References sum;
    for (const auto& [handle, object] : objects) {
        sum.held[object.kind] += object.references;
        sum.buffer_bytes += object.bytes;
    }
    sum.too_many_releases = too_many_releases;
    return sum;
}

std::string References::to_string() const {
    static constexpr std::array<const char*, kinds> names{"context", "queue", "program", "kernel",
                                                          "buffer",  "image", "sampler", "event"};
    std::string text;
    for (std::size_t kind = 0; kind < kinds; ++kind)
        if (held[kind] != 0)
            text += (text.empty() ? "" : ", ") + std::to_string(held[kind]) + " " + names[kind];
    if (buffer_bytes != 0) text += " of " + std::to_string(buffer_bytes) + " bytes";
    if (too_many_releases != 0)
        text += ", " + std::to_string(too_many_releases) + " releases too many";
    return text;
}

bool loaded() { return drivers.clGetPlatformIDs != nullptr; }

}  // namespace cellist::faults

CL_API_ENTRY cl_int CL_API_CALL clGetLayerInfo(cl_layer_info what, size_t room, void* value,
                                               size_t* size) {
    const auto give = [&](const void* source, size_t bytes) {
        if (size != nullptr) *size = bytes;
        if (value == nullptr) return CL_SUCCESS;
        if (room < bytes) return CL_INVALID_VALUE;
        std::memcpy(value, source, bytes);
        return CL_SUCCESS;
    };
    constexpr cl_layer_api_version version = CL_LAYER_API_VERSION_100;
    constexpr char name[] = "cellist faults";
    switch (what) {
        case CL_LAYER_API_VERSION:
            return give(&version, sizeof version);
        case CL_LAYER_NAME:
            return give(name, sizeof name);
        default:
            return CL_INVALID_VALUE;
    }
}

CL_API_ENTRY cl_int CL_API_CALL clInitLayer(cl_uint entries, const cl_icd_dispatch* target,
                                            cl_uint* own_entries, const cl_icd_dispatch** own) {
    using namespace cellist::faults;
    if (target == nullptr || own_entries == nullptr || own == nullptr) return CL_INVALID_VALUE;
    // A loader may know fewer entry points than these headers: the last ones stay empty.
    constexpr cl_uint known = sizeof(cl_icd_dispatch) / sizeof(void*);
    *own_entries = std::min(entries, known);
    std::memcpy(&drivers, target, *own_entries * sizeof(void*));
    layer = drivers;
    wrap_all();
    *own = &layer;
    return CL_SUCCESS;
}
