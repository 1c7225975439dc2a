// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <mutex>
#include <optional>

#include "base/check.h"
#include "device/bundled.h"
#include "device/cl_error.h"
#include "device/describe.h"
#include "device/detail/accounting.h"
#include "device/detail/programs.h"
#include "device/device.h"
#include "device/pocl_needs.h"
#include "device/select.h"

namespace caplet {

namespace {

struct Found {
  DeviceInfo info;
  cl::Device device;
};

std::string type_name(cl_device_type type) {
  if (type & CL_DEVICE_TYPE_CPU) return "cpu";
  if (type & CL_DEVICE_TYPE_GPU) return "gpu";
  if (type & CL_DEVICE_TYPE_ACCELERATOR) return "accelerator";
  return "other";
}

/// PoCL 3.1 sets its devices up at the first query. A thread that queries meanwhile is told that
/// there are none.
std::mutex first_use;

/// A platform or device that cannot be queried is left out: it could not be used either.
std::vector<Found> find_devices(Drivers drivers) {
  begin_opencl();
  const std::lock_guard lock(first_use);
  std::vector<Found> found;
  for (const FoundPlatform& platform : find_platforms(drivers)) {
    try {
      const std::string named = platform_name(platform);
      for (const cl::Device& device : devices_of(platform)) {
        found.push_back({describe(device, named), device});
        found.back().info.index = static_cast<int>(found.size()) - 1;
        found.back().info.bundled = platform.bundled;
      }
    } catch (const cl::Error&) {
      continue;
    }
  }
  return found;
}

std::vector<DeviceInfo> infos_of(const std::vector<Found>& devices) {
  std::vector<DeviceInfo> out;
  out.reserve(devices.size());
  for (const Found& found : devices) out.push_back(found.info);
  return out;
}

}  // namespace

std::vector<FoundPlatform> find_platforms(Drivers drivers) {
  prepare_for_pocl();
  std::vector<FoundPlatform> out;
  if (drivers != Drivers::bundled) {
    std::vector<cl::Platform> platforms;
    try {
      cl::Platform::get(&platforms);
    } catch (const cl::Error&) {
      platforms.clear();  // the loader finds no driver
    }
    for (const cl::Platform& platform : platforms) out.push_back({platform, false});
  }
  if (drivers != Drivers::machine)
    for (const cl::Platform& platform : bundled_platforms()) out.push_back({platform, true});
  return out;
}

std::vector<cl::Device> devices_of(const FoundPlatform& platform) {
  if (platform.bundled) return bundled_devices(platform.platform);
  std::vector<cl::Device> devices;
  platform.platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
  return devices;
}

std::string platform_name(const FoundPlatform& found) {
  return found.platform.getInfo<CL_PLATFORM_NAME>() + " " +
         found.platform.getInfo<CL_PLATFORM_VERSION>() + (found.bundled ? bundled_mark : "");
}

DeviceInfo describe(const cl::Device& device, const std::string& platform) {
  DeviceInfo info;
  info.name = device.getInfo<CL_DEVICE_NAME>();
  info.vendor = device.getInfo<CL_DEVICE_VENDOR>();
  info.driver = device.getInfo<CL_DRIVER_VERSION>();
  info.version = device.getInfo<CL_DEVICE_VERSION>();
  info.platform = platform;
  info.type = type_name(device.getInfo<CL_DEVICE_TYPE>());
  info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  info.native_float_width = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
  info.global_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  info.max_allocation_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  return info;
}

std::vector<DeviceInfo> list_devices() { return infos_of(find_devices(Drivers::all)); }

Encoding natural_encoding(const DeviceInfo& info) {
  return info.type == "cpu" && info.native_float_width > 1 ? Encoding::wide : Encoding::single;
}

Profile profile_of(const DeviceInfo& info) {
  constexpr const char* variable = "CAPLET_PROFILE";
  const char* named = std::getenv(variable);
  const std::string text = named ? named : "";
  if (text == "cpu" || text == "gpu") return text == "cpu" ? Profile::cpu : Profile::gpu;
  if (!text.empty()) throw InputError(SourceLocation{variable}, "'" + text + "' is not cpu or gpu");
  return info.type == "cpu" ? Profile::cpu : Profile::gpu;
}

Encoding parse_encoding(const std::string& text, const char* place) {
  for (const Encoding encoding : {Encoding::automatic, Encoding::wide, Encoding::single})
    if (text == name_of(encoding)) return encoding;
  throw InputError(SourceLocation{place}, "'" + text + "' is not automatic, wide or single");
}

std::string name_of(Encoding encoding) {
  return encoding == Encoding::wide     ? "wide"
         : encoding == Encoding::single ? "single"
                                        : "automatic";
}

Device Device::choose(const std::string& choice, Encoding encoding) {
  return chosen(choice, encoding, false).front();
}

std::vector<Device> Device::choose_several(const std::string& choice, Encoding encoding) {
  return chosen(choice, encoding, true);
}

std::vector<Device> Device::chosen(const std::string& choice, Encoding encoding, bool several) {
  constexpr const char* variable = "CAPLET_ENCODING";
  if (const char* named = std::getenv(variable); encoding == Encoding::automatic && named && *named)
    encoding = parse_encoding(named, variable);
  // The bundled driver is loaded only where the choice may name it.
  std::vector<Found> devices = find_devices(Drivers::machine);
  std::optional<std::vector<std::size_t>> selected =
      select_machine_devices(infos_of(devices), choice, several);
  if (!selected) {
    devices = find_devices(Drivers::all);
    const std::vector<DeviceInfo> infos = infos_of(devices);
    selected = several ? select_devices(infos, choice) : std::vector{select_device(infos, choice)};
  }
  std::vector<Device> out;
  for (const std::size_t index : *selected) {
    const Found& found = devices[index];
    const Encoding natural =
        profile_of(found.info) == Profile::gpu ? Encoding::single : natural_encoding(found.info);
    out.push_back(open(found.device, found.info,
                       encoding == Encoding::automatic ? natural : encoding,
                       share_of(found.device, found.info)));
  }
  return out;
}

Device::Shared Device::share_of(const cl::Device& device, const DeviceInfo& info) {
  const auto opened = [&] {
    return cl_call("opening the device", info.name, [&] {
      return Shared{cl::Context(device), std::make_shared<Programs>()};
    });
  };
  // Other drivers compile in moments, and an error may end all that a context of theirs can do.
  if (!is_pocl(info)) return opened();
  static std::mutex mutex;
  // It is never destroyed, since PoCL may be unloaded before it would be.
  static auto& contexts = *new std::map<cl_device_id, Shared>;
  const std::lock_guard lock(mutex);
  const auto found = contexts.find(device());
  return found != contexts.end() ? found->second
                                 : contexts.emplace(device(), opened()).first->second;
}

Device Device::open(const cl::Device& device, const DeviceInfo& info, Encoding encoding,
                    const Shared& shared) {
  Device out;
  out.info_ = info;
  out.encoding_ = encoding;
  out.profile_ = profile_of(info);
  out.device_ = device;
  cl_call("opening the device", info.name, [&] {
    out.context_ = shared.context;
    out.queue_ = std::make_shared<cl::CommandQueue>(out.context_, device);
  });
  out.accounting_ = std::make_shared<Accounting>();
  out.programs_ = shared.programs;
  if (out.is_pocl()) tell_of_pocl_cache();
  if (info.bundled) use_bundled_linker();
  return out;
}

std::vector<Device> Device::split(std::size_t parts) const {
  CHECK_LT_(std::size_t{0}, parts);
  const std::size_t units = info_.compute_units;
  if (units < parts)
    throw RunError(fmt::format("device '{}' has {} compute units and cannot be divided into {}",
                               info_.name, units, parts));
  std::vector<cl_device_partition_property> properties{CL_DEVICE_PARTITION_BY_COUNTS};
  for (std::size_t i = 0; i < parts; ++i)
    properties.push_back(
        static_cast<cl_device_partition_property>(units / parts + (i < units % parts ? 1 : 0)));
  properties.insert(properties.end(), {CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0});
  std::vector<cl::Device> devices;
  cl_call("dividing the device", info_.name,
          [&] { cl::Device(device_).createSubDevices(properties.data(), &devices); });
  std::vector<Device> out;
  for (const cl::Device& device : devices) {
    DeviceInfo info = info_;
    info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    const Shared own{cl::Context(device), std::make_shared<Programs>()};
    out.push_back(open(device, info, encoding_, own));
  }
  return out;
}

void Device::finish() const {
  cl_call("waiting for the device", info_.name, [&] { queue_->finish(); });
}

std::uint64_t Device::bytes_allocated() const { return accounting_->alive; }
std::uint64_t Device::bytes_peak() const { return accounting_->peak; }

}  // namespace caplet
