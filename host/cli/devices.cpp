// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet devices`: lists the OpenCL devices and their speed.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/clock.h"
#include "base/utf8.h"
#include "cli/commands.h"
#include "cli/description.h"
#include "cli/trial.h"
#include "device/device.h"
#include "lower/lower.h"
#include "present/present.h"
#include "render/session.h"
#include "report/device_json.h"

namespace caplet::cli {

namespace {

/// Returns a scene of 4,096 capsules in studio light.
Scene measured_scene() {
  CapsulesShape capsules;
  for (int i = 0; i < 4096; ++i) {
    const int row = i / 16, layer = i / 256;
    const float x = static_cast<float>(i % 16), y = static_cast<float>(row % 16),
                z = static_cast<float>(layer);
    capsules.p0.emplace_back(x - 0.3f, y - 0.2f, z);
    capsules.p1.emplace_back(x + 0.3f, y + 0.2f, z);
    capsules.radius0.push_back(0.15f);
  }
  Scene scene;
  scene.materials.emplace_back();
  Shape shape;
  shape.geometry = std::move(capsules);
  scene.shapes.push_back(std::move(shape));
  scene.view.film.width = 512;
  scene.view.film.height = 288;
  add_presentation(scene);
  return scene;
}

/// Returns the rays per second, of all kinds, in a render of one second. Throws RunError.
double measured_speed(int index) {
  const Scene scene = measured_scene();
  const FlatScene flat = lower(scene);
  const Device device = Device::choose(std::to_string(index));
  try_device_apart(device, {.shapes = flat.shapes, .render = true});
  Session session(flat, lower_view(scene), {device}, {});
  const auto all = [&] {
    const RayCounts rays = session.rays();
    return static_cast<double>(rays.camera + rays.bounce + rays.shadow);
  };
  session.render(1);  // excludes the work of the first pass
  const double before = all();
  const Clock::time_point start = Clock::now();
  session.render(1u << 24, {}, 1.0);
  return (all() - before) / seconds_since(start);
}

struct Listed {
  DeviceInfo info;
  double rays_a_second = 0;
  std::string why_not;  // why it could not be measured
};

std::vector<Listed> list(bool measure) {
  std::vector<Listed> out;
  for (const DeviceInfo& info : list_devices()) {
    Listed& listed = out.emplace_back(Listed{info, 0, ""});
    if (!measure) continue;
    try {
      listed.rays_a_second = measured_speed(info.index);
    } catch (const RunError& error) {
      listed.why_not = error.what();
    }
  }
  return out;
}

void print_devices_json(const std::vector<Listed>& devices, bool measured) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const Listed& device : devices) {
    out.push_back(report::device_json(device.info));
    if (device.why_not.empty() && measured) out.back()["rays_per_second"] = device.rays_a_second;
    if (!device.why_not.empty()) out.back()["not_measured"] = device.why_not;
  }
  fmt::print("{}\n", json_dump(out, 2));
}

void print_table(const std::vector<Listed>& devices, bool measured) {
  if (devices.empty())
    fmt::print(stderr,
               "caplet: no OpenCL device (on Debian: apt-get install pocl-opencl-icd; `caplet "
               "doctor` tells more)\n");
  for (const auto& [device, rays_a_second, why_not] : devices) {
    const std::string speed = !measured ? ""
                              : why_not.empty()
                                  ? fmt::format(", {:.3g} Mrays/s", rays_a_second * 1e-6)
                                  : ", not measured: " + why_not;
    fmt::print("{}  {}  {}  ({}, {} compute units, {:.1f} GiB, {}){}\n", device.index, device.type,
               device.name, device.platform, device.compute_units,
               static_cast<double>(device.global_bytes) / (1 << 30), device.driver, speed);
  }
}

}  // namespace

void add_devices(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("devices", "List the OpenCL devices, as --device takes them");
  const auto json = std::make_shared<bool>(false), measure = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Print a JSON array for machines");
  command->add_flag(
      "--measure", *measure,
      "Also how many rays a second each traces in a render, which takes seconds a device");
  command->footer(footer_with({"caplet devices --measure"}));
  command->callback([json, measure] {
    const std::vector<Listed> devices = list(*measure);
    *json ? print_devices_json(devices, *measure) : print_table(devices, *measure);
  });
}

}  // namespace caplet::cli
