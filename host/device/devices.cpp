// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <charconv>

#include "device/accounting.h"
#include "device/cl_error.h"
#include "device/device.h"

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

DeviceInfo describe(const cl::Device& device, const std::string& platform) {
  DeviceInfo info;
  info.name = device.getInfo<CL_DEVICE_NAME>();
  info.vendor = device.getInfo<CL_DEVICE_VENDOR>();
  info.driver = device.getInfo<CL_DRIVER_VERSION>();
  info.version = device.getInfo<CL_DEVICE_VERSION>();
  info.platform = platform;
  info.type = type_name(device.getInfo<CL_DEVICE_TYPE>());
  info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  info.global_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  info.max_allocation_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  return info;
}

/// A platform or device that cannot be asked is left out: it could not be used either.
std::vector<Found> find_devices() {
  std::vector<Found> found;
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error&) {
    return found;
  }
  for (const cl::Platform& platform : platforms) {
    try {
      std::vector<cl::Device> devices;
      platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
      const std::string platform_name = platform.getInfo<CL_PLATFORM_NAME>() + " " + platform.getInfo<CL_PLATFORM_VERSION>();
      for (const cl::Device& device : devices) {
        found.push_back({describe(device, platform_name), device});
        found.back().info.index = static_cast<int>(found.size()) - 1;
      }
    } catch (const cl::Error&) {
      continue;
    }
  }
  return found;
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

[[noreturn]] void refuse(const std::string& message, const std::vector<Found>& devices) {
  std::string list;
  for (const Found& found : devices)
    list += fmt::format("{}{} '{}' ({})", list.empty() ? "" : ", ", found.info.index, found.info.name, found.info.type);
  throw InputError(SourceLocation{"--device"}, fmt::format("{}; there is {}", message, list));
}

const Found& first_of_type(const std::vector<Found>& devices, const std::string& type) {
  const auto at = std::find_if(devices.begin(), devices.end(), [&](const Found& found) { return found.info.type == type; });
  if (at == devices.end()) refuse(fmt::format("no device of type '{}'", type), devices);
  return *at;
}

const Found& select(const std::vector<Found>& devices, const std::string& choice) {
  if (devices.empty())
    throw InputError(SourceLocation{"--device"},
                     "no OpenCL device was found; install one, for instance the Debian package pocl-opencl-icd (any CPU)");
  const auto is_gpu = [](const Found& found) { return found.info.type == "gpu"; };
  if (choice.empty()) {
    const auto gpu = std::find_if(devices.begin(), devices.end(), is_gpu);
    return gpu == devices.end() ? devices.front() : *gpu;
  }
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(choice.data(), choice.data() + choice.size(), index);
  if (end == choice.data() + choice.size()) {
    if (error != std::errc() || index >= devices.size()) refuse(fmt::format("no device has the index {}", choice), devices);
    return devices[index];
  }
  const std::string wanted = lower_case(choice);
  if (wanted == "cpu" || wanted == "gpu") return first_of_type(devices, wanted);
  const Found* match = nullptr;
  for (const Found& found : devices) {
    if (lower_case(found.info.name).find(wanted) == std::string::npos) continue;
    if (match) refuse(fmt::format("more than one device has '{}' in its name", choice), devices);
    match = &found;
  }
  if (!match) refuse(fmt::format("no device has '{}' in its name", choice), devices);
  return *match;
}

}  // namespace

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> out;
  for (const Found& found : find_devices()) out.push_back(found.info);
  return out;
}

Device Device::choose(const std::string& choice) {
  const std::vector<Found> devices = find_devices();
  const Found& found = select(devices, choice);
  Device out;
  out.info_ = found.info;
  out.device_ = found.device;
  cl_call("opening the device", found.info.name, [&] {
    out.context_ = cl::Context(found.device);
    out.queue_ = std::make_shared<cl::CommandQueue>(out.context_, found.device);
  });
  out.accounting_ = std::make_shared<Accounting>();
  return out;
}

void Device::finish() const {
  cl_call("waiting for the device", info_.name, [&] { queue_->finish(); });
}

std::uint64_t Device::bytes_allocated() const { return accounting_->alive; }
std::uint64_t Device::bytes_peak() const { return accounting_->peak; }

}  // namespace caplet
