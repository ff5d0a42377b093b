// SPDX-License-Identifier: MIT
#include <cellist/error.hpp>

namespace cellist {

namespace {

std::string message(const std::string& call, cl_int code, const std::string& log) {
    std::string text = call + " failed: " + error_name(code) + " (" + std::to_string(code) + ")";
    if (!log.empty()) text += "\n" + log;
    return text;
}

}  // namespace

OpenClError::OpenClError(std::string call, cl_int code, std::string log)
    : Error(message(call, code, log)), call_(std::move(call)), code_(code), log_(std::move(log)) {}

bool out_of_memory(const Error& error) noexcept {
    if (const auto* failure = dynamic_cast<const OpenClError*>(&error))
        return failure->code() == CL_MEM_OBJECT_ALLOCATION_FAILURE ||
               failure->code() == CL_OUT_OF_RESOURCES || failure->code() == CL_OUT_OF_HOST_MEMORY;
    return dynamic_cast<const MemoryError*>(&error) != nullptr;
}

const char* error_name(cl_int code) {
#define CELLIST_CASE(name)                                                                         \
    case name:                                                                                     \
        return #name;
    switch (code) {
        CELLIST_CASE(CL_SUCCESS)
        CELLIST_CASE(CL_DEVICE_NOT_FOUND)
        CELLIST_CASE(CL_DEVICE_NOT_AVAILABLE)
        CELLIST_CASE(CL_COMPILER_NOT_AVAILABLE)
        CELLIST_CASE(CL_MEM_OBJECT_ALLOCATION_FAILURE)
        CELLIST_CASE(CL_OUT_OF_RESOURCES)
        CELLIST_CASE(CL_OUT_OF_HOST_MEMORY)
        CELLIST_CASE(CL_PROFILING_INFO_NOT_AVAILABLE)
        CELLIST_CASE(CL_MEM_COPY_OVERLAP)
        CELLIST_CASE(CL_IMAGE_FORMAT_MISMATCH)
        CELLIST_CASE(CL_IMAGE_FORMAT_NOT_SUPPORTED)
        CELLIST_CASE(CL_BUILD_PROGRAM_FAILURE)
        CELLIST_CASE(CL_MAP_FAILURE)
        CELLIST_CASE(CL_MISALIGNED_SUB_BUFFER_OFFSET)
        CELLIST_CASE(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST)
        CELLIST_CASE(CL_COMPILE_PROGRAM_FAILURE)
        CELLIST_CASE(CL_LINKER_NOT_AVAILABLE)
        CELLIST_CASE(CL_LINK_PROGRAM_FAILURE)
        CELLIST_CASE(CL_DEVICE_PARTITION_FAILED)
        CELLIST_CASE(CL_KERNEL_ARG_INFO_NOT_AVAILABLE)
        CELLIST_CASE(CL_INVALID_VALUE)
        CELLIST_CASE(CL_INVALID_DEVICE_TYPE)
        CELLIST_CASE(CL_INVALID_PLATFORM)
        CELLIST_CASE(CL_INVALID_DEVICE)
        CELLIST_CASE(CL_INVALID_CONTEXT)
        CELLIST_CASE(CL_INVALID_QUEUE_PROPERTIES)
        CELLIST_CASE(CL_INVALID_COMMAND_QUEUE)
        CELLIST_CASE(CL_INVALID_HOST_PTR)
        CELLIST_CASE(CL_INVALID_MEM_OBJECT)
        CELLIST_CASE(CL_INVALID_IMAGE_FORMAT_DESCRIPTOR)
        CELLIST_CASE(CL_INVALID_IMAGE_SIZE)
        CELLIST_CASE(CL_INVALID_SAMPLER)
        CELLIST_CASE(CL_INVALID_BINARY)
        CELLIST_CASE(CL_INVALID_BUILD_OPTIONS)
        CELLIST_CASE(CL_INVALID_PROGRAM)
        CELLIST_CASE(CL_INVALID_PROGRAM_EXECUTABLE)
        CELLIST_CASE(CL_INVALID_KERNEL_NAME)
        CELLIST_CASE(CL_INVALID_KERNEL_DEFINITION)
        CELLIST_CASE(CL_INVALID_KERNEL)
        CELLIST_CASE(CL_INVALID_ARG_INDEX)
        CELLIST_CASE(CL_INVALID_ARG_VALUE)
        CELLIST_CASE(CL_INVALID_ARG_SIZE)
        CELLIST_CASE(CL_INVALID_KERNEL_ARGS)
        CELLIST_CASE(CL_INVALID_WORK_DIMENSION)
        CELLIST_CASE(CL_INVALID_WORK_GROUP_SIZE)
        CELLIST_CASE(CL_INVALID_WORK_ITEM_SIZE)
        CELLIST_CASE(CL_INVALID_GLOBAL_OFFSET)
        CELLIST_CASE(CL_INVALID_EVENT_WAIT_LIST)
        CELLIST_CASE(CL_INVALID_EVENT)
        CELLIST_CASE(CL_INVALID_OPERATION)
        CELLIST_CASE(CL_INVALID_GL_OBJECT)
        CELLIST_CASE(CL_INVALID_BUFFER_SIZE)
        CELLIST_CASE(CL_INVALID_MIP_LEVEL)
        CELLIST_CASE(CL_INVALID_GLOBAL_WORK_SIZE)
        CELLIST_CASE(CL_INVALID_PROPERTY)
        CELLIST_CASE(CL_INVALID_IMAGE_DESCRIPTOR)
        CELLIST_CASE(CL_INVALID_COMPILER_OPTIONS)
        CELLIST_CASE(CL_INVALID_LINKER_OPTIONS)
        CELLIST_CASE(CL_INVALID_DEVICE_PARTITION_COUNT)
        case -1001:
            return "CL_PLATFORM_NOT_FOUND_KHR";
        default:
            return "unknown error";
    }
#undef CELLIST_CASE
}

}  // namespace cellist
