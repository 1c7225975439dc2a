// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// An OpenCL layer (cl_layer.h) that makes any driver behave as bad ones do: README.md lists the
// forms, which the environment variable HOSTILE chooses. It uses nothing of Caplet.
#define CL_TARGET_OPENCL_VERSION 300
#define CL_USE_DEPRECATED_OPENCL_1_2_APIS
#include <CL/cl.h>
#include <CL/cl_icd.h>
#include <CL/cl_layer.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace {

using Dispatch = cl_icd_dispatch;

// --- What was asked for ---

double number_of(const std::string& key, const std::string& text) {
  char* end = nullptr;
  double value = std::strtod(text.c_str(), &end);
  if (*end == 'K')
    value *= 1024, ++end;
  else if (*end == 'M')
    value *= 1048576, ++end;
  else if (*end == 'G')
    value *= 1073741824, ++end;
  if (end == text.c_str() || *end != 0 || !(value >= 0)) {
    std::cerr << "HOSTILE: " << key << "=" << text << ": a number from 0, with K, M or G\n";
    std::_Exit(64);
  }
  return value;
}

/// The forms. A member that is empty or zero changes nothing.
struct Forms {
  double block = 0, memory = 0;                // bytes
  bool lazy = false;                           // memory is missed at the first use
  double watchdog = 0, late = 0, compile = 0;  // seconds
  double group = 0, local = 0, width = 0, align = 0;
  bool no_images = false, garbage = false;
  bool fragile = false;  // what runs at the exit after a failed call aborts
  double rate = 0;       // share of calls that fail
  double at = 0;         // the one call that fails, from 1
  double from = 0;       // the first of those that fail, from 1
  double lose = 0;       // the call at which the device is lost, from 1
  double lane = 0;       // share of work-items with a wrong result
  double seed = 1;
  std::set<std::string> calls;  // those that may fail; empty: all
  std::string crash, hang;      // a call
  std::string report;           // a file

  explicit Forms(const char* text) {
    if (!text) return;
    const std::map<std::string, double*> numbers = {
        {"block", &block}, {"memory", &memory},   {"watchdog", &watchdog},
        {"late", &late},   {"compile", &compile}, {"group", &group},
        {"local", &local}, {"width", &width},     {"align", &align},
        {"rate", &rate},   {"at", &at},           {"from", &from},
        {"lose", &lose},   {"lane", &lane},       {"seed", &seed}};
    const std::map<std::string, bool*> flags = {
        {"lazy", &lazy}, {"no_images", &no_images}, {"garbage", &garbage}, {"fragile", &fragile}};
    const std::map<std::string, std::string*> names = {
        {"crash", &crash}, {"hang", &hang}, {"report", &report}};
    std::istringstream words(text);
    for (std::string word; words >> word;) {
      const std::size_t equal = word.find('=');
      const std::string key = word.substr(0, equal);
      const std::string value = equal == std::string::npos ? "" : word.substr(equal + 1);
      if (const auto number = numbers.find(key); number != numbers.end()) {
        *number->second = number_of(key, value);
      } else if (const auto flag = flags.find(key); flag != flags.end()) {
        *flag->second = true;
      } else if (const auto name = names.find(key); name != names.end()) {
        *name->second = value;
      } else if (key == "calls") {
        std::istringstream list(value);
        for (std::string call; std::getline(list, call, ',');) calls.insert(call);
      } else {
        std::cerr << "HOSTILE: no form is named \"" << key << "\"\n";
        std::_Exit(64);
      }
    }
  }
};

const Forms& forms() {
  static const Forms all(std::getenv("HOSTILE"));
  return all;
}

// --- What has happened ---

struct Held {
  std::size_t bytes = 0;
  bool read_only = false;
};

/// State is shared by all threads and never destroyed, since calls may come while the process ends.
struct State {
  Dispatch target{}, layer{};
  std::mutex mutex;  // guards what follows
  std::map<cl_mem, Held> buffers;
  std::map<cl_kernel, std::map<cl_uint, cl_mem>> arguments;
  std::mt19937_64 random{static_cast<std::uint64_t>(forms().seed)};
  std::map<std::string_view, std::size_t> made;  // how often each call was made
  std::size_t bytes = 0, calls = 0, faults = 0;
  bool lost = false;
  std::string first;  // the first fault: "clCreateBuffer -4"

  double uniform() { return std::uniform_real_distribution<double>(0, 1)(random); }
};
State& state() {
  static State* const all = new State;
  return *all;
}

void write_report() {  // with the mutex held
  State& all = state();
  if (forms().report.empty()) return;
  std::ofstream out(forms().report);
  out << "calls " << all.calls << "\nfaults " << all.faults << "\nfirst " << all.first << "\nleft "
      << all.buffers.size() << "\n";
  for (const auto& [call, count] : all.made) out << call << ' ' << count << '\n';
}

void write_last_report() {
  const std::lock_guard lock(state().mutex);
  write_report();
  if (forms().fragile && state().faults > 0) std::abort();
}

cl_int note(std::string_view call, cl_int code) {  // with the mutex held
  State& all = state();
  if (all.faults++ == 0) all.first = std::string(call) + " " + std::to_string(code);
  write_report();  // the process may not come to its end
  return code;
}

/// Returns the error that this call shall give, or CL_SUCCESS. `call` lives as long as the process.
cl_int fault(std::string_view call, std::initializer_list<cl_int> codes) {
  State& all = state();
  const std::lock_guard lock(all.mutex);
  ++all.calls;
  ++all.made[call];
  if (all.lost) return note(call, CL_OUT_OF_RESOURCES);
  if (forms().lose > 0 && static_cast<double>(all.calls) >= forms().lose) {
    all.lost = true;
    return note(call, CL_OUT_OF_RESOURCES);
  }
  if (call == forms().crash) std::abort();
  if (call == forms().hang) std::this_thread::sleep_for(std::chrono::hours(1));
  if (!forms().calls.empty() && !forms().calls.contains(std::string(call))) {
    --all.calls;
    return CL_SUCCESS;
  }
  const auto number = static_cast<double>(all.calls);
  const bool is_chosen = number == forms().at || (forms().from > 0 && number >= forms().from);
  if (!is_chosen && !(forms().rate > 0 && all.uniform() < forms().rate)) return CL_SUCCESS;
  const auto choice = static_cast<std::size_t>(all.uniform() * static_cast<double>(codes.size()));
  return note(call, codes.begin()[choice]);
}

// --- Calls that may fail, and otherwise are the driver's ---

/// The text of a call's name as a template's argument.
template <std::size_t n>
struct Name {
  char text[n];
  constexpr Name(const char (&from)[n]) { std::copy(from, from + n, text); }
};

template <Name name, auto member, class Function, cl_int... codes>
struct May;
// Calls that return their error.
template <Name name, auto member, class... Arguments, cl_int... codes>
struct May<name, member, cl_int(CL_API_CALL*)(Arguments...), codes...> {
  static cl_int CL_API_CALL call(Arguments... arguments) {
    if (const cl_int code = fault(name.text, {codes...})) return code;
    return (state().target.*member)(arguments...);
  }
};
// Calls that return an object; the error goes through the last argument.
template <class First, class... Rest>
auto last_of(First first, Rest... rest) {
  if constexpr (sizeof...(rest) == 0)
    return first;
  else
    return last_of(rest...);
}
template <Name name, auto member, class Object, class... Arguments, cl_int... codes>
struct May<name, member, Object*(CL_API_CALL*)(Arguments...), codes...> {
  static Object* CL_API_CALL call(Arguments... arguments) {
    if (const cl_int code = fault(name.text, {codes...})) {
      if (cl_int* const out = last_of(arguments...)) *out = code;
      return nullptr;
    }
    return (state().target.*member)(arguments...);
  }
};

// Each call that may fail, with errors that drivers give.
#define HOSTILE_CALLS(CALL)                                                                      \
  CALL(clGetPlatformInfo, CL_OUT_OF_HOST_MEMORY)                                                 \
  CALL(clGetDeviceIDs, CL_DEVICE_NOT_FOUND, CL_OUT_OF_HOST_MEMORY)                               \
  CALL(clGetDeviceInfo, CL_OUT_OF_RESOURCES, CL_INVALID_VALUE)                                   \
  CALL(clCreateContext, CL_DEVICE_NOT_AVAILABLE, CL_OUT_OF_HOST_MEMORY)                          \
  CALL(clCreateCommandQueue, CL_OUT_OF_RESOURCES, CL_OUT_OF_HOST_MEMORY)                         \
  CALL(clCreateCommandQueueWithProperties, CL_OUT_OF_RESOURCES, CL_OUT_OF_HOST_MEMORY)           \
  CALL(clCreateBuffer, CL_MEM_OBJECT_ALLOCATION_FAILURE, CL_OUT_OF_HOST_MEMORY)                  \
  CALL(clCreateProgramWithSource, CL_OUT_OF_HOST_MEMORY)                                         \
  CALL(clCreateProgramWithBinary, CL_INVALID_BINARY, CL_OUT_OF_HOST_MEMORY)                      \
  CALL(clBuildProgram, CL_BUILD_PROGRAM_FAILURE, CL_OUT_OF_RESOURCES, CL_COMPILER_NOT_AVAILABLE) \
  CALL(clCompileProgram, CL_COMPILE_PROGRAM_FAILURE, CL_OUT_OF_RESOURCES)                        \
  CALL(clLinkProgram, CL_LINK_PROGRAM_FAILURE, CL_OUT_OF_RESOURCES)                              \
  CALL(clGetProgramInfo, CL_OUT_OF_HOST_MEMORY)                                                  \
  CALL(clCreateKernel, CL_OUT_OF_RESOURCES, CL_INVALID_PROGRAM_EXECUTABLE)                       \
  CALL(clSetKernelArg, CL_OUT_OF_RESOURCES)                                                      \
  CALL(clGetKernelInfo, CL_OUT_OF_HOST_MEMORY)                                                   \
  CALL(clGetKernelWorkGroupInfo, CL_OUT_OF_RESOURCES)                                            \
  CALL(clEnqueueNDRangeKernel, CL_OUT_OF_RESOURCES, CL_MEM_OBJECT_ALLOCATION_FAILURE)            \
  CALL(clEnqueueReadBuffer, CL_OUT_OF_RESOURCES, CL_MEM_OBJECT_ALLOCATION_FAILURE)               \
  CALL(clEnqueueWriteBuffer, CL_OUT_OF_RESOURCES, CL_MEM_OBJECT_ALLOCATION_FAILURE)              \
  CALL(clEnqueueCopyBuffer, CL_OUT_OF_RESOURCES, CL_MEM_OBJECT_ALLOCATION_FAILURE)               \
  CALL(clEnqueueFillBuffer, CL_OUT_OF_RESOURCES, CL_MEM_OBJECT_ALLOCATION_FAILURE)               \
  CALL(clEnqueueMapBuffer, CL_MAP_FAILURE, CL_OUT_OF_RESOURCES)                                  \
  CALL(clEnqueueUnmapMemObject, CL_OUT_OF_RESOURCES)                                             \
  CALL(clWaitForEvents, CL_OUT_OF_RESOURCES, CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST)       \
  CALL(clFlush, CL_OUT_OF_RESOURCES)                                                             \
  CALL(clFinish, CL_OUT_OF_RESOURCES, CL_OUT_OF_HOST_MEMORY)

#define HOSTILE_MAY(name, ...) \
  using may_##name = May<#name, &Dispatch::name, decltype(Dispatch::name), __VA_ARGS__>;
HOSTILE_CALLS(HOSTILE_MAY)
#undef HOSTILE_MAY

// --- Limits ---

cl_int CL_API_CALL device_info(cl_device_id device, cl_device_info what, std::size_t size,
                               void* value, std::size_t* size_ret) {
  const cl_int code = may_clGetDeviceInfo::call(device, what, size, value, size_ret);
  if (code != CL_SUCCESS || !value) return code;
  const auto at_most = [&]<class Number>(double limit, Number) {
    Number number;
    std::memcpy(&number, value, sizeof number);
    if (limit > 0 && static_cast<double>(number) > limit) number = static_cast<Number>(limit);
    std::memcpy(value, &number, sizeof number);
  };
  switch (what) {
    case CL_DEVICE_MAX_MEM_ALLOC_SIZE:
      at_most(forms().block, cl_ulong{});
      break;
    case CL_DEVICE_GLOBAL_MEM_SIZE:
      at_most(forms().lazy ? 0 : forms().memory, cl_ulong{});
      break;
    case CL_DEVICE_MAX_WORK_GROUP_SIZE:
      at_most(forms().group, std::size_t{});
      break;
    case CL_DEVICE_MAX_WORK_ITEM_SIZES:
      for (std::size_t i = 0; forms().group > 0 && i < size / sizeof(std::size_t); ++i) {
        auto& extent = static_cast<std::size_t*>(value)[i];
        extent = std::min(extent, static_cast<std::size_t>(forms().group));
      }
      break;
    case CL_DEVICE_LOCAL_MEM_SIZE:
      at_most(forms().local, cl_ulong{});
      break;
    case CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT:
    case CL_DEVICE_PREFERRED_VECTOR_WIDTH_FLOAT:
      at_most(forms().width, cl_uint{});
      break;
    case CL_DEVICE_MEM_BASE_ADDR_ALIGN:
      if (forms().align > 0) {
        const auto bits = static_cast<cl_uint>(8 * forms().align);
        std::memcpy(value, &bits, sizeof bits);
      }
      break;
    case CL_DEVICE_IMAGE_SUPPORT:
      if (forms().no_images) std::memset(value, 0, sizeof(cl_bool));
      break;
    default:
      break;
  }
  return code;
}

cl_int CL_API_CALL kernel_group_info(cl_kernel kernel, cl_device_id device,
                                     cl_kernel_work_group_info what, std::size_t size, void* value,
                                     std::size_t* size_ret) {
  const cl_int code =
      may_clGetKernelWorkGroupInfo::call(kernel, device, what, size, value, size_ret);
  if (code == CL_SUCCESS && value && what == CL_KERNEL_WORK_GROUP_SIZE && forms().group > 0) {
    auto& group = *static_cast<std::size_t*>(value);
    group = std::min(group, static_cast<std::size_t>(forms().group));
  }
  return code;
}

// --- Memory ---

cl_mem CL_API_CALL create_buffer(cl_context context, cl_mem_flags flags, std::size_t size,
                                 void* contents, cl_int* out) {
  State& all = state();
  const auto refuse = [&](cl_int code) -> cl_mem {
    if (out) *out = code;
    return nullptr;
  };
  {
    const std::lock_guard lock(all.mutex);
    const auto bytes = static_cast<double>(size);
    if (forms().block > 0 && bytes > forms().block)
      return refuse(note("clCreateBuffer", CL_INVALID_BUFFER_SIZE));
    if (forms().memory > 0 && !forms().lazy &&
        static_cast<double>(all.bytes) + bytes > forms().memory)
      return refuse(note("clCreateBuffer", CL_MEM_OBJECT_ALLOCATION_FAILURE));
  }
  std::vector<unsigned char> filled;
  if (forms().garbage && !contents && !(flags & (CL_MEM_USE_HOST_PTR | CL_MEM_COPY_HOST_PTR))) {
    filled.assign(size, 0xff);  // floats that are no numbers, the largest integers
    flags |= CL_MEM_COPY_HOST_PTR;
    contents = filled.data();
  }
  const cl_mem buffer = may_clCreateBuffer::call(context, flags, size, contents, out);
  if (buffer) {
    const std::lock_guard lock(all.mutex);
    all.buffers[buffer] = {size, (flags & CL_MEM_READ_ONLY) != 0};
    all.bytes += size;
  }
  return buffer;
}

cl_int CL_API_CALL release_memory(cl_mem buffer) {
  State& all = state();
  cl_uint references = 0;
  all.target.clGetMemObjectInfo(buffer, CL_MEM_REFERENCE_COUNT, sizeof references, &references,
                                nullptr);
  if (references == 1) {
    const std::lock_guard lock(all.mutex);
    if (const auto held = all.buffers.find(buffer); held != all.buffers.end()) {
      all.bytes -= held->second.bytes;
      all.buffers.erase(held);
    }
  }
  return all.target.clReleaseMemObject(buffer);
}

/// Returns whether the buffers together are more than a lazy driver has.
cl_int missing_memory(std::string_view call) {
  State& all = state();
  const std::lock_guard lock(all.mutex);
  if (!forms().lazy || static_cast<double>(all.bytes) <= forms().memory) return CL_SUCCESS;
  return note(call, CL_MEM_OBJECT_ALLOCATION_FAILURE);
}

// --- Kernels ---

cl_int CL_API_CALL build_program(cl_program program, cl_uint count, const cl_device_id* devices,
                                 const char* options, void(CL_CALLBACK* done)(cl_program, void*),
                                 void* data) {
  std::this_thread::sleep_for(std::chrono::duration<double>(forms().compile));
  return may_clBuildProgram::call(program, count, devices, options, done, data);
}

cl_int CL_API_CALL set_argument(cl_kernel kernel, cl_uint index, std::size_t size,
                                const void* value) {
  if (forms().lane > 0) {
    State& all = state();
    const std::lock_guard lock(all.mutex);
    cl_mem buffer = nullptr;
    if (size == sizeof buffer && value) std::memcpy(&buffer, value, sizeof buffer);
    auto& arguments = all.arguments[kernel];
    if (all.buffers.contains(buffer))
      arguments[index] = buffer;
    else
      arguments.erase(index);
  }
  return may_clSetKernelArg::call(kernel, index, size, value);
}

/// Flips a bit of a word in a buffer that the kernel may have written, once for as many work-items
/// as the rate says.
void spoil(cl_command_queue queue, cl_kernel kernel, double items) {
  State& all = state();
  std::vector<std::pair<cl_mem, std::size_t>> places;
  unsigned bit = 0;
  {
    const std::lock_guard lock(all.mutex);
    if (all.uniform() >= items * forms().lane) return;
    for (const auto& [index, buffer] : all.arguments[kernel]) {
      const auto held = all.buffers.find(buffer);
      if (held == all.buffers.end() || held->second.read_only || held->second.bytes < 4) continue;
      const auto words = static_cast<double>(held->second.bytes / 4);
      places.emplace_back(buffer, 4 * static_cast<std::size_t>(all.uniform() * words));
    }
    if (places.empty()) return;
    std::swap(places.front(),
              places[static_cast<std::size_t>(all.uniform() * static_cast<double>(places.size()))]);
    bit = static_cast<unsigned>(all.uniform() * 32);
    note("lane", 0);
  }
  cl_uint word = 0;
  const auto [buffer, offset] = places.front();
  all.target.clEnqueueReadBuffer(queue, buffer, CL_TRUE, offset, 4, &word, 0, nullptr, nullptr);
  word ^= 1u << bit;
  all.target.clEnqueueWriteBuffer(queue, buffer, CL_TRUE, offset, 4, &word, 0, nullptr, nullptr);
}

/// Opens its event some time later, from a thread of its own.
cl_event late_event(cl_command_queue queue) {
  State& all = state();
  cl_context context = nullptr;
  all.target.clGetCommandQueueInfo(queue, CL_QUEUE_CONTEXT, sizeof context, &context, nullptr);
  cl_int code = CL_SUCCESS;
  const cl_event gate = all.target.clCreateUserEvent(context, &code);
  if (code != CL_SUCCESS) return nullptr;
  double share = 0;
  {
    const std::lock_guard lock(all.mutex);
    share = all.uniform();
  }
  all.target.clRetainEvent(gate);
  std::thread([gate, share, &all] {
    std::this_thread::sleep_for(std::chrono::duration<double>(forms().late * share));
    all.target.clSetUserEventStatus(gate, CL_COMPLETE);
    all.target.clReleaseEvent(gate);
  }).detach();
  return gate;
}

cl_int CL_API_CALL launch(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                          const std::size_t* offset, const std::size_t* global,
                          const std::size_t* local, cl_uint count, const cl_event* events,
                          cl_event* event) {
  State& all = state();
  double items = 1, group = 1;
  for (cl_uint i = 0; i < dimensions; ++i) {
    items *= static_cast<double>(global[i]);
    if (local) group *= static_cast<double>(local[i]);
  }
  if (forms().group > 0 && group > forms().group) {
    const std::lock_guard lock(all.mutex);
    return note("clEnqueueNDRangeKernel", CL_INVALID_WORK_GROUP_SIZE);
  }
  if (const cl_int code = missing_memory("clEnqueueNDRangeKernel")) return code;
  std::vector<cl_event> after(events, events + count);
  cl_event gate = nullptr;
  if (forms().late > 0 && (gate = late_event(queue))) after.push_back(gate);
  const auto start = std::chrono::steady_clock::now();
  const cl_int code = may_clEnqueueNDRangeKernel::call(
      queue, kernel, dimensions, offset, global, local, static_cast<cl_uint>(after.size()),
      after.empty() ? nullptr : after.data(), event);
  if (gate) all.target.clReleaseEvent(gate);
  if (code != CL_SUCCESS) return code;
  if (forms().watchdog > 0) {
    all.target.clFinish(queue);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    if (took.count() > forms().watchdog) {
      const std::lock_guard lock(all.mutex);
      all.lost = true;
      note("watchdog", CL_OUT_OF_RESOURCES);
    }
  }
  if (forms().lane > 0) {
    all.target.clFinish(queue);
    spoil(queue, kernel, items);
  }
  return code;
}

cl_int CL_API_CALL write_buffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking,
                                std::size_t offset, std::size_t size, const void* from,
                                cl_uint count, const cl_event* events, cl_event* event) {
  if (const cl_int code = missing_memory("clEnqueueWriteBuffer")) return code;
  return may_clEnqueueWriteBuffer::call(queue, buffer, blocking, offset, size, from, count, events,
                                        event);
}

cl_int CL_API_CALL fill_buffer(cl_command_queue queue, cl_mem buffer, const void* pattern,
                               std::size_t pattern_size, std::size_t offset, std::size_t size,
                               cl_uint count, const cl_event* events, cl_event* event) {
  if (const cl_int code = missing_memory("clEnqueueFillBuffer")) return code;
  return may_clEnqueueFillBuffer::call(queue, buffer, pattern, pattern_size, offset, size, count,
                                       events, event);
}

}  // namespace

// --- The layer's two functions ---

extern "C" {

CL_API_ENTRY cl_int CL_API_CALL clGetLayerInfo(cl_layer_info what, std::size_t size, void* value,
                                               std::size_t* size_ret) {
  const cl_layer_api_version version = CL_LAYER_API_VERSION_100;
  const char name[] = "hostile";
  const void* from = &version;
  std::size_t bytes = sizeof version;
  if (what == CL_LAYER_NAME)
    from = name, bytes = sizeof name;
  else if (what != CL_LAYER_API_VERSION)
    return CL_INVALID_VALUE;
  if (value && size < bytes) return CL_INVALID_VALUE;
  if (value) std::memcpy(value, from, bytes);
  if (size_ret) *size_ret = bytes;
  return CL_SUCCESS;
}

CL_API_ENTRY cl_int CL_API_CALL clInitLayer(cl_uint count, const cl_icd_dispatch* target,
                                            cl_uint* count_ret, const cl_icd_dispatch** layer) {
  if (!target || !count_ret || !layer || count < sizeof(Dispatch) / sizeof(void*))
    return CL_INVALID_VALUE;
  State& all = state();
  all.target = *target;
  all.layer = *target;
#define HOSTILE_SET(name, ...) all.layer.name = may_##name::call;
  HOSTILE_CALLS(HOSTILE_SET)
#undef HOSTILE_SET
  all.layer.clGetDeviceInfo = device_info;
  all.layer.clGetKernelWorkGroupInfo = kernel_group_info;
  all.layer.clCreateBuffer = create_buffer;
  all.layer.clReleaseMemObject = release_memory;
  all.layer.clBuildProgram = build_program;
  all.layer.clSetKernelArg = set_argument;
  all.layer.clEnqueueNDRangeKernel = launch;
  all.layer.clEnqueueWriteBuffer = write_buffer;
  all.layer.clEnqueueFillBuffer = fill_buffer;
  std::atexit(write_last_report);
  *layer = &all.layer;
  *count_ret = sizeof(Dispatch) / sizeof(void*);
  return CL_SUCCESS;
}

}  // extern "C"
