// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Turns OpenCL's errors into RunError with the call, the error's name, the place and the device.
#pragma once

#include <string>

#include "device/device.h"

namespace caplet {

/// Returns "CL_INVALID_VALUE" for -30; "error -12345" for a code without a name.
std::string cl_error_name(cl_int code);

[[noreturn]] void throw_cl_error(const cl::Error& error, const std::string& place,
                                 const std::string& device_name);

/// Returns whether a call to a driver has failed in this process. Its threads may still work on
/// what was asked before, and use static objects: a program then ends without their destructors.
bool any_driver_error();

/// Calls `function`; a cl::Error becomes a RunError "PLACE: CALL: NAME (device 'DEVICE')".
template <class Function>
auto cl_call(const std::string& place, const std::string& device_name, Function&& function) {
  begin_opencl();
  try {
    return function();
  } catch (const cl::Error& error) {
    throw_cl_error(error, place, device_name);
  }
}

}  // namespace caplet
