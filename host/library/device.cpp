// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "caplet/device.h"

#include "device/compilers.h"
#include "device/forked.h"
#include "library/detail/inside.h"

namespace caplet::v0 {

DeviceInfo to_public(const caplet::DeviceInfo& info) {
  return {info.index,    info.name, info.vendor,        info.driver,       info.version,
          info.platform, info.type, info.compute_units, info.global_bytes, info.bundled};
}

void check_process() {
  if (forked_after_opencl()) begin_opencl();
}

void set_program(const std::string& path) { set_compiler_program(path); }

std::vector<DeviceInfo> devices() {
  std::vector<DeviceInfo> out;
  for (const caplet::DeviceInfo& info : list_devices()) out.push_back(to_public(info));
  return out;
}

Device::Device(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
Device::Device(const Device&) = default;
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(const Device&) = default;
Device& Device::operator=(Device&&) noexcept = default;
Device::~Device() = default;

const DeviceInfo& Device::info() const { return data_->info; }

Device choose_device(const std::string& choice) {
  caplet::Device device = caplet::Device::choose(choice);
  DeviceInfo info = to_public(device.info());
  return Inside::device(std::move(device), std::move(info));
}

std::vector<Device> choose_devices(const std::string& choice) {
  std::vector<Device> out;
  for (caplet::Device& device : caplet::Device::choose_several(choice)) {
    DeviceInfo info = to_public(device.info());
    out.push_back(Inside::device(std::move(device), std::move(info)));
  }
  return out;
}

}  // namespace caplet::v0
