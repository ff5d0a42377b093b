// SPDX-License-Identifier: MIT
#pragma once
// Includes the OpenCL C++ bindings with the settings that cellist needs: exceptions, and interfaces
// up to OpenCL 3.0. Include this header instead of <CL/opencl.hpp>, or set the same macros first.

#if defined(CL_HPP_) && !defined(CL_HPP_ENABLE_EXCEPTIONS)
#error "cellist needs CL_HPP_ENABLE_EXCEPTIONS: include <cellist/opencl.hpp> before <CL/opencl.hpp>"
#endif

#ifndef CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_ENABLE_EXCEPTIONS
#endif
#ifndef CL_HPP_TARGET_OPENCL_VERSION
#define CL_HPP_TARGET_OPENCL_VERSION 300
#endif
#ifndef CL_HPP_MINIMUM_OPENCL_VERSION
#define CL_HPP_MINIMUM_OPENCL_VERSION 200
#endif

#include <CL/opencl.hpp>
