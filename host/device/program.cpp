// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "base/check.h"
#include "base/clock.h"
#include "base/log.h"
#include "device/cache.h"
#include "device/cl_error.h"
#include "device/detail/embedded.h"
#include "device/detail/programs.h"
#include "device/device.h"

namespace caplet {

namespace {

using Binary = std::vector<unsigned char>;

constexpr double noticeable_seconds = 0.5;
const std::string standard = "-cl-std=CL1.2";

/// Makes a program from a cached binary; returns nothing when the driver refuses it.
std::optional<cl::Program> from_binary(const Device& device, const Binary& binary,
                                       const std::string& options) {
  try {
    cl::Program program(device.context(), {device.handle()}, {binary});
    program.build({device.handle()}, options.c_str());
    return program;
  } catch (const cl::Error&) {
    return std::nullopt;
  }
}

/// Returns what the driver says of a build that failed. Drivers that are out of memory or lost may
/// refuse this too, and that must not hide the error of the build.
std::string build_log(const Device& device, const cl::Program& program) {
  std::size_t bytes = 0;
  const auto ask = [&](std::size_t size, char* text) {
    return clGetProgramBuildInfo(program(), device.handle()(), CL_PROGRAM_BUILD_LOG, size, text,
                                 &bytes) == CL_SUCCESS;
  };
  if (!ask(0, nullptr)) return "the driver gives no build log";
  std::string log(bytes, '\0');
  if (!ask(bytes, log.data())) return "the driver gives no build log";
  while (!log.empty() && log.back() == '\0') log.pop_back();
  return log.empty() ? "the build log is empty" : "the build log says:\n" + log;
}

/// Builds `source`, which `out` becomes. Returns the driver's log where it is an error, else
/// nothing.
std::optional<std::string> build(const Device& device, const std::string& name,
                                 const std::string& source, const std::string& options,
                                 cl::Program& out) {
  const std::string& device_name = device.info().name;
  out = cl_call(fmt::format("program '{}'", name), device_name,
                [&] { return cl::Program(device.context(), source); });
  const cl_device_id handle = device.handle()();
  const cl_int code = clBuildProgram(out(), 1, &handle, options.c_str(), nullptr, nullptr);
  if (code == CL_SUCCESS) return std::nullopt;
  return fmt::format("program '{}': clBuildProgram: {} (device '{}', options '{}'); {}", name,
                     cl_error_name(code), device_name, options, build_log(device, out));
}

/// Builds `source` for PoCL with the declarations of kernels/math/builtins.cl in place of those of
/// PoCL's own header, which this macro leaves out. PoCL preprocesses a program before it looks into
/// its cache, 28 ms with the 18,000 declarations of its header and 10 ms with these. Returns
/// whether it was built.
bool build_with_own_declarations(const Device& device, const std::string& name,
                                 const std::string& source, const std::string& options,
                                 cl::Program& out) {
  const std::string declared = builtin_declarations() + "\n#line 1\n" + source;
  return !build(device, name, declared, options + " -D_OPENCL_H_", out);
}

/// Returns the device's binary; it is empty when the driver returns none.
Binary binary_of(const cl::Program& program) {
  try {
    const std::vector<Binary> binaries = program.getInfo<CL_PROGRAM_BINARIES>();
    return binaries.empty() ? Binary() : binaries.front();
  } catch (const cl::Error&) {
    return {};
  }
}

std::string kernel_name(const Device& device, const cl::Kernel& kernel) {
  return cl_call("a kernel's name", device.info().name,
                 [&] { return kernel.getInfo<CL_KERNEL_FUNCTION_NAME>(); });
}

/// Sets null for pointers, zero for scalars and vectors. Which is which is found by trying: the
/// query of argument types needs an option that would change the program.
void set_null_arguments(const Device& device, cl::Kernel& kernel) {
  const cl_uint count = cl_call("a kernel's arguments", device.info().name,
                                [&] { return kernel.getInfo<CL_KERNEL_NUM_ARGS>(); });
  constexpr unsigned char zeros[128] = {};
  for (cl_uint i = 0; i < count; ++i) {
    cl_int code = clSetKernelArg(kernel(), i, sizeof(cl_mem), nullptr);
    for (std::size_t bytes = 1; code != CL_SUCCESS && bytes <= sizeof(zeros); bytes *= 2)
      code = clSetKernelArg(kernel(), i, bytes, zeros);
    if (code != CL_SUCCESS)
      throw RunError(fmt::format("argument {} of kernel '{}' cannot be zero: clSetKernelArg: {}", i,
                                 kernel_name(device, kernel), cl_error_name(code)));
  }
}

}  // namespace

std::string cache_key(const DeviceInfo& info, const std::string& options,
                      const std::string& source) {
  std::string key = "program";
  for (const std::string* part :
       {&info.name, &info.driver, &info.version, &info.platform, &options, &source}) {
    key += '\0';
    key += *part;
  }
  return key;
}

std::optional<Device::Programs::Compiled> Device::Programs::find(const Key& key) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(key);
  if (found == entries_.end()) return std::nullopt;
  found->second.last_use = ++uses_;
  return found->second.compiled;
}

void Device::Programs::add(const Key& key, const Compiled& compiled) {
  const std::lock_guard lock(mutex_);
  entries_.insert_or_assign(key, Entry{compiled, ++uses_});
  if (entries_.size() <= most) return;
  entries_.erase(std::ranges::min_element(entries_, {},
                                          [](const auto& entry) { return entry.second.last_use; }));
}

Program::Program(const Device& device, const std::string& name, const std::string& options)
    : Program(from_source(device, name, kernel_source(name), options)) {}

Program Program::from_source(const Device& device, const std::string& name,
                             const std::string& source, const std::string& options,
                             BinaryCache cache) {
  begin_opencl();
  const auto start = Clock::now();
  const std::string all_options =
      options.empty() ? standard : fmt::format("{} {}", standard, options);
  const bool keeps_binary = cache == BinaryCache::always || !device.is_pocl();
  const std::string key = keeps_binary ? cache_key(device.info(), options, source) : "";
  Program out;
  out.device_ = device;
  out.name_ = name;
  const std::pair shared_key(all_options, source);
  const bool shares = cache == BinaryCache::automatic && device.programs_;
  if (shares)
    if (const auto found = device.programs_->find(shared_key)) {
      out.program_ = found->program;
      out.own_declarations_ = found->own_declarations;
      out.build_seconds_ = seconds_since(start);
      return out;
    }
  if (const std::optional<Binary> binary =
          keeps_binary ? cache_load(key, "program") : std::nullopt) {
    if (std::optional<cl::Program> program = from_binary(device, *binary, all_options)) {
      out.program_ = std::move(*program);
      out.from_cache_ = true;
    }
  }
  if (!out.from_cache_) {
    out.own_declarations_ =
        device.is_pocl() &&
        build_with_own_declarations(device, name, source, all_options, out.program_);
    if (!out.own_declarations_)
      if (const auto error = build(device, name, source, all_options, out.program_))
        throw RunError(*error);
    if (keeps_binary)
      if (const Binary binary = binary_of(out.program_); !binary.empty())
        cache_store(key, "program", binary);
  }
  if (shares) device.programs_->add(shared_key, {out.program_, out.own_declarations_});
  out.build_seconds_ = seconds_since(start);
  if (!out.from_cache_ && out.build_seconds_ >= noticeable_seconds)
    log::info("compiled {} for {} in {:.1f} s", name, device.info().name, out.build_seconds_);
  return out;
}

double Program::prepare(const std::string& kernel_name, std::size_t local) {
  if (!device_.is_pocl()) return 0;
  const auto start = Clock::now();
  cl::Kernel prepared = kernel(kernel_name);
  set_null_arguments(device_, prepared);
  launch(device_, prepared, 1, local);
  device_.finish();
  const double seconds = seconds_since(start);
  build_seconds_ += seconds;
  if (seconds >= noticeable_seconds)
    log::info("compiled {} for {} in groups of {} in {:.1f} s", kernel_name, device_.info().name,
              local, seconds);
  return seconds;
}

cl::Kernel Program::kernel(const std::string& name) const {
  return cl_call(fmt::format("kernel '{}' of program '{}'", name, name_), device_.info().name,
                 [&] { return cl::Kernel(program_, name.c_str()); });
}

void detail::set_argument(const Device& device, cl::Kernel& kernel, cl_uint index,
                          const void* value, std::size_t bytes) {
  const cl_int code = clSetKernelArg(kernel(), index, bytes, value);
  if (code != CL_SUCCESS)
    throw_cl_error(cl::Error(code, "clSetKernelArg"),
                   fmt::format("argument {} of kernel '{}'", index, kernel_name(device, kernel)),
                   device.info().name);
}

namespace {

void enqueue(const Device& device, const cl::Kernel& kernel, std::size_t count,
             const cl::NDRange& first, const cl::NDRange& global, const cl::NDRange& local) {
  const std::string& device_name = device.info().name;
  const std::string name = cl_call("a kernel's name", device_name,
                                   [&] { return kernel.getInfo<CL_KERNEL_FUNCTION_NAME>(); });
  cl_call(
      fmt::format("kernel '{}' over {} work-items in groups of {}", name, count, local.get()[0]),
      device_name, [&] { device.queue().enqueueNDRangeKernel(kernel, first, global, local); });
}

/// Returns the least multiple of `unit` that is not below `count`.
std::size_t rounded_up(std::size_t count, std::size_t unit) {
  return (count + unit - 1) / unit * unit;
}

}  // namespace

void launch(const Device& device, const cl::Kernel& kernel, std::size_t count, std::size_t local) {
  if (count == 0) return;
  CHECK_LT_(std::size_t{0}, local);
  enqueue(device, kernel, count, cl::NullRange, cl::NDRange(rounded_up(count, local)),
          cl::NDRange(local));
}

void launch_items(const Device& device, const cl::Kernel& kernel, std::size_t count,
                  std::size_t local, std::size_t first) {
  // PoCL compiles a kernel anew for grids that are 65,536 or more work-items wide.
  constexpr std::size_t most_in_a_row = 32768;
  if (count == 0) return;
  CHECK_LT_(std::size_t{0}, local);
  const std::size_t rows = device.is_pocl() ? (count - 1) / most_in_a_row + 1 : 1,
                    width = rounded_up((count - 1) / rows + 1, local);
  if (rows == 1)
    enqueue(device, kernel, count, first > 0 ? cl::NDRange(first) : cl::NullRange,
            cl::NDRange(width), cl::NDRange(local));
  else
    enqueue(device, kernel, count, first > 0 ? cl::NDRange(first, 0) : cl::NullRange,
            cl::NDRange(width, rows), cl::NDRange(local, 1));
}

std::size_t local_size_for(const Device& device, const cl::Kernel& kernel, std::size_t wanted) {
  const std::size_t most = cl_call("a kernel's work-group size", device.info().name, [&] {
    return kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device.handle());
  });
  while (wanted > 1 && wanted > most) wanted /= 2;
  return wanted;
}

namespace {

/// Returns the number of work-items that share `count` items.
std::size_t share_count(const Device& device, std::size_t count) {
  // A share is long enough to keep a pool of rays full, and short enough that units which finish
  // early find other shares.
  constexpr std::size_t most_items = 1024, least_items = 128, shares_a_unit = 8;
  const std::size_t wanted =
      std::max(count / most_items, std::size_t{device.info().compute_units} * shares_a_unit);
  return std::max<std::size_t>(1, std::min(wanted, count / least_items));
}

}  // namespace

void launch_shares(const Device& device, const cl::Kernel& kernel, std::size_t count) {
  if (count > 0) launch_items(device, kernel, share_count(device, count), 1);
}

}  // namespace caplet
