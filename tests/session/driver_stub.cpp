// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "driver_stub.h"

#include <dlfcn.h>

#include <atomic>
#include <condition_variable>
#include <mutex>

namespace caplet::test {

namespace {

struct State {
  std::mutex mutex;
  std::condition_variable released;
  cl_command_queue queue = nullptr;  // null: nothing is broken
  Fault fault = Fault::launch_fails;
  int first = 0, calls = 0, hanging = 0;
};

State& state() {
  static State* made = new State;  // threads that hang may outlive everything
  return *made;
}

/// Whether the call goes wrong.
bool goes_wrong(cl_command_queue queue, Fault fails, Fault hangs) {
  State& s = state();
  std::unique_lock lock(s.mutex);
  if (queue != s.queue || (s.fault != fails && s.fault != hangs) || s.calls++ < s.first)
    return false;
  if (s.fault == hangs) {
    ++s.hanging;
    s.released.wait(lock, [&] { return s.queue != queue; });
    --s.hanging;
    s.released.notify_all();
  }
  return true;
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

BrokenDriver::BrokenDriver(const Device& device, Fault fault, int first) {
  State& s = state();
  const std::lock_guard lock(s.mutex);
  s.queue = device.queue()();
  s.fault = fault;
  s.first = first;
  s.calls = 0;
}

BrokenDriver::~BrokenDriver() {
  State& s = state();
  std::unique_lock lock(s.mutex);
  s.queue = nullptr;
  s.released.notify_all();
  s.released.wait(lock, [&] { return s.hanging == 0; });
}

int BrokenDriver::calls() const {
  const std::lock_guard lock(state().mutex);
  return state().calls;
}

}  // namespace caplet::test

extern "C" cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel,
                                         cl_uint dimensions, const size_t* offset,
                                         const size_t* global, const size_t* local, cl_uint waits,
                                         const cl_event* wait_list, cl_event* event) {
  using caplet::test::Fault;
  if (caplet::test::goes_wrong(queue, Fault::launch_fails, Fault::launch_hangs))
    return CL_OUT_OF_RESOURCES;
  static auto* const real =
      caplet::test::next<decltype(clEnqueueNDRangeKernel)>("clEnqueueNDRangeKernel");
  return real(queue, kernel, dimensions, offset, global, local, waits, wait_list, event);
}

extern "C" cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking,
                                      size_t offset, size_t bytes, void* to, cl_uint waits,
                                      const cl_event* wait_list, cl_event* event) {
  using caplet::test::Fault;
  if (caplet::test::goes_wrong(queue, Fault::read_fails, Fault::read_hangs))
    return CL_OUT_OF_RESOURCES;
  static auto* const real =
      caplet::test::next<decltype(clEnqueueReadBuffer)>("clEnqueueReadBuffer");
  return real(queue, buffer, blocking, offset, bytes, to, waits, wait_list, event);
}
