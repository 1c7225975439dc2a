// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet devices`: the OpenCL devices there are.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "device/device.h"
#include "report/device_json.h"

namespace caplet::cli {

namespace {

void print_json(const std::vector<DeviceInfo>& devices) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const DeviceInfo& device : devices) out.push_back(report::device_json(device));
  fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

void print_table(const std::vector<DeviceInfo>& devices) {
  if (devices.empty())
    fmt::print(stderr, "caplet: no OpenCL device (on Debian: apt-get install pocl-opencl-icd; `caplet doctor` tells more)\n");
  for (const DeviceInfo& device : devices)
    fmt::print("{}  {}  {}  ({}, {} compute units, {:.1f} GiB, {})\n", device.index, device.type, device.name, device.platform,
               device.compute_units, static_cast<double>(device.global_bytes) / (1 << 30), device.driver);
}

}  // namespace

void add_devices(CLI::App& app) {
  CLI::App* command = app.add_subcommand("devices", "List the OpenCL devices, as --device takes them");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Print a JSON array for machines");
  command->callback([json] {
    const std::vector<DeviceInfo> devices = list_devices();
    *json ? print_json(devices) : print_table(devices);
  });
}

}  // namespace caplet::cli
