// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file includes OpenCL's C++ classes. Where this process was forked after OpenCL was used,
// their destructors release nothing (forked.h).
#pragma once

#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/opencl.h>

#include "device/forked.h"

namespace caplet {

/// Calls `release` unless this process was forked after OpenCL was used.
template <class Object>
cl_int give_back(cl_int(CL_API_CALL* release)(Object), Object object) {
  return forked_after_opencl() ? CL_SUCCESS : release(object);
}

}  // namespace caplet

// The classes call these functions by their names, and there is no other way to change that. A
// macro does not expand within itself.
#define clReleaseCommandQueue(object) caplet::give_back(clReleaseCommandQueue, object)
#define clReleaseContext(object) caplet::give_back(clReleaseContext, object)
#define clReleaseDevice(object) caplet::give_back(clReleaseDevice, object)
#define clReleaseEvent(object) caplet::give_back(clReleaseEvent, object)
#define clReleaseKernel(object) caplet::give_back(clReleaseKernel, object)
#define clReleaseMemObject(object) caplet::give_back(clReleaseMemObject, object)
#define clReleaseProgram(object) caplet::give_back(clReleaseProgram, object)
#define clReleaseSampler(object) caplet::give_back(clReleaseSampler, object)
#include <CL/opencl.hpp>
#undef clReleaseCommandQueue
#undef clReleaseContext
#undef clReleaseDevice
#undef clReleaseEvent
#undef clReleaseKernel
#undef clReleaseMemObject
#undef clReleaseProgram
#undef clReleaseSampler
