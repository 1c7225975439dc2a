// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Loaded before the OpenCL library: CAPLET_TEST_LAUNCHES="QUEUE FIRST fail|hang" makes launches on the queue of that number, counted
// as they are made from 0, fail or hang from launch number FIRST on.
#define _GNU_SOURCE
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static _Atomic(cl_command_queue) broken;
static atomic_int queues, launches;
static int number = -1, first;
static char fault[8];

__attribute__((constructor)) static void read_environment(void) {
  const char* text = getenv("CAPLET_TEST_LAUNCHES");
  if (!text || sscanf(text, "%d %d %7s", &number, &first, fault) != 3) number = -1;
}

cl_command_queue clCreateCommandQueue(cl_context context, cl_device_id device, cl_command_queue_properties properties,
                                      cl_int* error) {
  cl_command_queue (*real)(cl_context, cl_device_id, cl_command_queue_properties, cl_int*) = dlsym(RTLD_NEXT, "clCreateCommandQueue");
  const cl_command_queue queue = real(context, device, properties, error);
  if (atomic_fetch_add(&queues, 1) == number) broken = queue;
  return queue;
}

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t* offset, const size_t* global,
                              const size_t* local, cl_uint waits, const cl_event* wait_list, cl_event* event) {
  cl_int (*real)(cl_command_queue, cl_kernel, cl_uint, const size_t*, const size_t*, const size_t*, cl_uint, const cl_event*,
                 cl_event*) = dlsym(RTLD_NEXT, "clEnqueueNDRangeKernel");
  if (number >= 0 && queue == broken && atomic_fetch_add(&launches, 1) >= first) {
    while (strcmp(fault, "hang") == 0) pause();
    return CL_OUT_OF_RESOURCES;
  }
  return real(queue, kernel, dimensions, offset, global, local, waits, wait_list, event);
}
