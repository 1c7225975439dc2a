// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is the interface to OpenCL: it chooses a device, holds its context and queue, makes buffers,
// compiles programs with a disk cache, and launches kernels. Every error carries the call, the
// place and, for programs, the build log.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "device/opencl.h"
#include "device/row_masks.h"

namespace caplet {

/// DriverError is an OpenCL call that failed.
class DriverError : public RunError {
 public:
  DriverError(const std::string& message, cl_int code) : RunError(message), code_(code) {}
  cl_int code() const { return code_; }

 private:
  cl_int code_;
};

/// UnknownDevice is thrown if the choice matches no device, or more than one; the message lists the
/// devices.
class UnknownDevice : public InputError {
 public:
  using InputError::InputError;
};

/// NoDevice is thrown if there is no OpenCL device.
class NoDevice : public RunError {
 public:
  using RunError::RunError;
};

struct DeviceInfo {
  int index = 0;  // over all platforms, as Device::choose takes it
  std::string name, vendor, driver, version, platform;
  std::string type;  // "cpu", "gpu", "accelerator", "other"
  unsigned compute_units = 0;
  unsigned native_float_width = 0;  // floats of a vector as the device computes with them
                                    // (CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT)
  std::uint64_t global_bytes = 0, max_allocation_bytes = 0;
  bool bundled = false;  // of the driver that came with this program (bundled.h)
};

/// Returns all OpenCL devices, those of the bundled driver last; it is empty when there is no
/// platform (and never throws for that). It may be called from any thread. Throws RunError in a
/// process that was forked after OpenCL was used, as everything does that needs a device
/// (forked.h).
std::vector<DeviceInfo> list_devices();

/// Encoding is how kernels traverse trees and leaf blocks: eight boxes or primitives at a time in
/// vectors of floats, or one after the other.
enum class Encoding { automatic, wide, single };

/// Reads "automatic", "wide" or "single". Throws InputError with this place for any other text.
Encoding parse_encoding(const std::string& text, const char* place);
std::string name_of(Encoding encoding);

/// Returns what suits a device: wide on CPUs that compute with vectors, single on others: GPUs, and
/// CPUs whose driver runs a work-item in each lane itself.
Encoding natural_encoding(const DeviceInfo& info);

/// Profile is how a device is kept busy: as CPUs are, or as GPUs, with larger batches of work and
/// without the host between their parts.
enum class Profile { cpu, gpu };

/// Returns what the environment variable CAPLET_PROFILE says, "cpu" or "gpu", else what the device
/// is. Throws InputError for any other text.
Profile profile_of(const DeviceInfo& info);

/// Device is a chosen device with its context and in-order queue. Copies share them. All devices of
/// a process that are the same one of PoCL share the context and the compiled programs, which PoCL
/// would otherwise preprocess anew, some 10 ms a program.
class Device {
 public:
  /// Chooses a device. `choice`: "" (a GPU if there is one, else the first device), an index,
  /// "cpu", "gpu", "bundled", or part of a name (case ignored). A device of the bundled driver is
  /// chosen only if none of the machine's matches, or by "bundled" or its index. Throws
  /// UnknownDevice when nothing or more than one name matches, and NoDevice. `encoding` automatic:
  /// what the environment variable CAPLET_ENCODING says, else natural_encoding, or single for a
  /// profile of GPUs.
  static Device choose(const std::string& choice, Encoding encoding = Encoding::automatic);

  /// Chooses several devices: "all" (the bundled one only where the machine has no CPU), or such
  /// choices between commas, none of them twice; errors as choose.
  static std::vector<Device> choose_several(const std::string& choice,
                                            Encoding encoding = Encoding::automatic);

  /// Returns that many devices, each with a share of this one's compute units, as even as possible.
  /// Throws RunError where the driver cannot divide it, or there are fewer units than parts.
  std::vector<Device> split(std::size_t parts) const;

  const DeviceInfo& info() const { return info_; }
  bool is_cpu() const { return info_.type == "cpu"; }
  /// Returns wide or single.
  Encoding encoding() const { return encoding_; }
  Profile profile() const { return profile_; }
  /// PoCL compiles a kernel when it is first launched, again for each local size and for wide grids
  /// (launch_items), and keeps the results on disk itself.
  bool is_pocl() const { return is_pocl(info_); }
  const cl::Context& context() const { return context_; }
  const cl::Device& handle() const { return device_; }
  cl::CommandQueue& queue() const { return *queue_; }
  void finish() const;
  /// These are the bytes of buffers alive now, and the most there ever were.
  std::uint64_t bytes_allocated() const;
  std::uint64_t bytes_peak() const;

 private:
  friend class RawBuffer;
  static bool is_pocl(const DeviceInfo& info) {
    return info.platform.starts_with("Portable Computing Language");
  }
  struct Accounting;
  struct Shared;
  class Programs;
  friend class Program;
  static std::vector<Device> chosen(const std::string& choice, Encoding encoding, bool several);
  static Device open(const cl::Device& device, const DeviceInfo& info, Encoding encoding,
                     const Shared& shared);
  static Shared share_of(const cl::Device& device, const DeviceInfo& info);
  DeviceInfo info_;
  Encoding encoding_ = Encoding::single;
  Profile profile_ = Profile::cpu;
  cl::Device device_;
  cl::Context context_;
  std::shared_ptr<cl::CommandQueue> queue_;
  std::shared_ptr<Accounting> accounting_;
  std::shared_ptr<Programs> programs_;
};

/// RawBuffer is an untyped buffer; use Buffer<T> below. Empty sizes are allocated as 16 bytes,
/// since OpenCL has no empty buffers.
class RawBuffer {
 public:
  RawBuffer() = default;
  /// Throws RunError when the device lacks the memory ("needs N bytes, the device allows M").
  RawBuffer(const Device& device, std::size_t bytes, bool read_only, const void* contents);
  /// Is memory of this process where it lies, which a CPU reads. `keeper` lives until the driver
  /// does not need the memory any more. It does not count as memory of the device. Throws RunError
  /// when it is more than the device allows in one buffer.
  RawBuffer(const Device& device, std::span<const std::byte> memory,
            std::shared_ptr<const void> keeper);
  void read(void* to, std::size_t offset, std::size_t bytes) const;     // blocking
  void write(const void* from, std::size_t offset, std::size_t bytes);  // blocking
  void clear();  // zeros, in the order of the queue
  std::size_t bytes() const { return bytes_; }
  const cl::Buffer& handle() const { return buffer_; }

 private:
  Device device_;
  cl::Buffer buffer_;
  std::size_t bytes_ = 0;
  std::shared_ptr<void> accounted_;
};

template <class T>
class Buffer : public RawBuffer {
 public:
  Buffer() = default;
  Buffer(const Device& device, std::size_t count)
      : RawBuffer(device, count * sizeof(T), false, nullptr) {}
  Buffer(const Device& device, std::span<const T> contents)
      : RawBuffer(device, contents.size_bytes(), true, contents.data()) {}
  Buffer(const Device& device, std::span<const T> memory, std::shared_ptr<const void> keeper)
      : RawBuffer(device, std::as_bytes(memory), std::move(keeper)) {}
  std::size_t size() const { return bytes() / sizeof(T); }
  std::vector<T> read() const {
    std::vector<T> out(size());
    RawBuffer::read(out.data(), 0, bytes());
    return out;
  }
  void write(std::span<const T> values) { RawBuffer::write(values.data(), 0, values.size_bytes()); }
};

/// Returns the flattened text of kernels/stages/<name>.cl, or of kernels/<name> when the name has a
/// '/', embedded at build with #line marks. When the environment variable CAPLET_KERNELS names a
/// folder, the file is read and flattened from there instead. Throws std::logic_error for unknown
/// names.
std::string kernel_source(std::string_view name);

/// Returns `text` with its `#include "path"` lines resolved like those of kernel_source (paths from
/// kernels/), for a program that has these rows of the lists: it has the text of no others. Throws
/// std::logic_error for a file that does not exist.
std::string flatten_kernels(const std::string& text, const RowMasks& rows = {});

enum class BinaryCache {
  automatic,  // not on PoCL, which caches by itself and would compile every kernel twice to hand
              // out a binary
  always
};

/// Program is a compiled program: one kernel file, one set of options. Copies of a device compile
/// one once. Its binary is cached on disk by device, driver, source hash and options (folder:
/// $CAPLET_CACHE, else $XDG_CACHE_HOME/caplet, else ~/.cache/caplet; an unusable cache is never an
/// error). Compiling that takes noticeable time is logged.
class Program {
 public:
  /// Compiles a kernel file with `options` like "-DCAPLET_REAL_WIDTH=8". "-cl-std=CL1.2" is always
  /// added. Throws RunError with the build log.
  Program(const Device& device, const std::string& name, const std::string& options);
  /// Compiles a text that is not embedded (tests, the probe).
  static Program from_source(const Device& device, const std::string& name,
                             const std::string& source, const std::string& options,
                             BinaryCache cache = BinaryCache::automatic);
  cl::Kernel kernel(const std::string& name) const;
  /// Makes PoCL compile the kernel for launches in groups of `local` (launch_items) now rather than
  /// at its first launch, by one with null buffers and zero scalars: the kernel must do nothing
  /// when its count is 0. Does nothing on other platforms. Returns the seconds it took, which
  /// build_seconds() then includes.
  double prepare(const std::string& kernel_name, std::size_t local);
  double build_seconds() const { return build_seconds_; }
  /// Returns whether it came from Caplet's own cache.
  bool from_cache() const { return from_cache_; }
  /// Returns whether it was built for PoCL with kernels/math/builtins.cl in place of PoCL's header.
  bool own_declarations() const { return own_declarations_; }

 private:
  Program() = default;
  Device device_;
  std::string name_;
  cl::Program program_;
  double build_seconds_ = 0;
  bool from_cache_ = false;
  bool own_declarations_ = false;
};

namespace detail {
void set_argument(const Device& device, cl::Kernel& kernel, cl_uint index, const void* value,
                  std::size_t bytes);

template <class Value>
void set_argument(const Device& device, cl::Kernel& kernel, cl_uint index, const Value& value) {
  if constexpr (std::is_base_of_v<RawBuffer, Value>) {
    const cl_mem memory = value.handle()();
    set_argument(device, kernel, index, &memory, sizeof(cl_mem));
  } else {
    static_assert(std::is_arithmetic_v<Value>, "kernels take buffers and scalars");
    set_argument(device, kernel, index, &value, sizeof(value));
  }
}
}  // namespace detail

/// Sets the kernel's arguments 0, 1, ... from buffers and scalars (cl_uint, cl_float...). Throws
/// RunError naming kernel and argument.
template <class... Values>
void set_arguments(const Device& device, cl::Kernel& kernel, const Values&... values) {
  cl_uint index = 0;
  (detail::set_argument(device, kernel, index++, values), ...);
}

/// Enqueues `kernel` over `count` work-items (rounded up to `local`; the kernel checks its index).
/// Throws RunError naming the kernel.
void launch(const Device& device, const cl::Kernel& kernel, std::size_t count, std::size_t local);

/// Enqueues a kernel of kernels/stages/items.cl over work-items `first` to `first` + `count`, a few
/// more than asked for. PoCL gets them in rows, so that it compiles a kernel once for all counts.
/// Throws RunError naming the kernel.
void launch_items(const Device& device, const cl::Kernel& kernel, std::size_t count,
                  std::size_t local, std::size_t first = 0);

/// Returns the most work-items of a group, up to `wanted`, in halves of it, with which the device
/// can run the kernel.
std::size_t local_size_for(const Device& device, const cl::Kernel& kernel, std::size_t wanted);

/// Enqueues a kernel whose work-items share `count` items equally (kernels/stages/items.cl), in
/// groups of one: as many as keep the device's units busy to the end. Throws RunError naming the
/// kernel.
void launch_shares(const Device& device, const cl::Kernel& kernel, std::size_t count);

/// Compiles and runs a small kernel that checks arithmetic, vload8, clz, atomics and the record
/// layout on this device; once per device and driver (remembered in the cache). The environment
/// variable CAPLET_SELF_TEST leaves it out (0) or forces it (1). Throws RunError that says what is
/// wrong.
void self_test(const Device& device);

}  // namespace caplet
