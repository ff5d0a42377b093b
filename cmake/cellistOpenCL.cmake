# SPDX-License-Identifier: MIT
# Finds what cellist needs of OpenCL: the loader, the C headers and the C++ header CL/opencl.hpp.
#
# Defines the target OpenCL::OpenCL and sets cellist_opencl_missing: empty when all is found,
# otherwise one sentence that says what is missing and which Debian package has it. The build and
# the installed package share this file, so that both look in the same places.
set(cellist_opencl_missing "")

# GLOBAL: a project that adds cellist as a subdirectory links OpenCL::OpenCL through it.
find_package(OpenCL QUIET GLOBAL)
find_path(CELLIST_OPENCL_HPP_DIR CL/opencl.hpp
    HINTS ${OpenCL_INCLUDE_DIRS}
    DOC "Directory that holds CL/opencl.hpp")
mark_as_advanced(CELLIST_OPENCL_HPP_DIR)

if(NOT OpenCL_FOUND)
    string(CONCAT cellist_opencl_missing
        "no OpenCL loader and C headers found. Install ocl-icd-opencl-dev and opencl-headers "
        "(Debian, Ubuntu), or set OpenCL_LIBRARY and OpenCL_INCLUDE_DIR.")
elseif(NOT CELLIST_OPENCL_HPP_DIR)
    string(CONCAT cellist_opencl_missing
        "no CL/opencl.hpp found. Install opencl-clhpp-headers (Debian, Ubuntu), or set "
        "CELLIST_OPENCL_HPP_DIR to the directory that holds CL/opencl.hpp.")
elseif(NOT CELLIST_OPENCL_HPP_DIR IN_LIST OpenCL_INCLUDE_DIRS)
    target_include_directories(OpenCL::OpenCL INTERFACE "${CELLIST_OPENCL_HPP_DIR}")
endif()
