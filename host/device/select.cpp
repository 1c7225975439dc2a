// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "device/select.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "base/spelling.h"

namespace caplet {

namespace {

using Devices = std::vector<DeviceInfo>;

[[noreturn]] void refuse(const std::string& message, const Devices& devices) {
  std::string list;
  for (const DeviceInfo& info : devices)
    list += fmt::format("{}{} '{}' ({}{})", list.empty() ? "" : ", ", info.index, info.name,
                        info.type, info.bundled ? ", bundled" : "");
  throw UnknownDevice(fmt::format("{}; the devices are {}", message, list));
}

/// Returns devices.size() when there is none.
std::size_t first_of_type(const Devices& devices, const std::string& type) {
  const auto at = std::find_if(devices.begin(), devices.end(),
                               [&](const DeviceInfo& info) { return info.type == type; });
  return static_cast<std::size_t>(at - devices.begin());
}

/// Returns the devices with a name: those whose whole name it is if there is one, else those with
/// it as a part; the machine's devices if there is one.
std::vector<std::size_t> matches_of(const Devices& devices, const std::string& wanted) {
  for (const bool bundled : {false, true}) {
    std::vector<std::size_t> whole, part;
    for (std::size_t i = 0; i < devices.size(); ++i) {
      if (devices[i].bundled != bundled) continue;
      const std::string name = lower_case(devices[i].name);
      if (name == wanted) whole.push_back(i);
      if (name.find(wanted) != std::string::npos) part.push_back(i);
    }
    if (!part.empty()) return whole.empty() ? part : whole;
  }
  return {};
}

bool has_processor(const Devices& devices) {
  return std::ranges::any_of(
      devices, [](const DeviceInfo& info) { return !info.bundled && info.type == "cpu"; });
}

std::size_t by_name(const Devices& devices, const std::string& choice) {
  const std::vector<std::size_t> matches = matches_of(devices, lower_case(choice));
  if (matches.empty()) refuse(fmt::format("no device has '{}' in its name", choice), devices);
  if (matches.size() > 1)
    refuse(fmt::format("more than one device has '{}' in its name", choice), devices);
  return matches.front();
}

}  // namespace

std::size_t select_device(const Devices& devices, const std::string& choice) {
  if (devices.empty())
    throw NoDevice(
        "no OpenCL device was found; install one, for instance the Debian package pocl-opencl-icd "
        "(any CPU)");
  if (choice.empty()) return first_of_type(devices, "gpu") % devices.size();
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(choice.data(), choice.data() + choice.size(), index);
  if (end == choice.data() + choice.size()) {
    if (error != std::errc() || index >= devices.size())
      refuse(fmt::format("no device has the index {}", choice), devices);
    return index;
  }
  const std::string type = lower_case(choice);
  if (type == "bundled") {
    const auto at =
        std::ranges::find_if(devices, [](const DeviceInfo& info) { return info.bundled; });
    if (at == devices.end()) refuse("no OpenCL driver came with this program", devices);
    return static_cast<std::size_t>(at - devices.begin());
  }
  if (type != "cpu" && type != "gpu") return by_name(devices, choice);
  const std::size_t first = first_of_type(devices, type);
  if (first == devices.size()) refuse(fmt::format("no device of type '{}'", type), devices);
  return first;
}

std::vector<std::size_t> select_devices(const Devices& devices, const std::string& choice) {
  std::vector<std::size_t> out;
  if (lower_case(choice) == "all" && !devices.empty()) {
    // The bundled driver's device is the same processor again.
    const bool has_cpu = has_processor(devices);
    for (std::size_t i = 0; i < devices.size(); ++i)
      if (!devices[i].bundled || !has_cpu) out.push_back(i);
    return out;
  }
  // A name may have a comma in it.
  const auto named = [&] {
    return std::ranges::any_of(devices, [&](const DeviceInfo& info) {
      return lower_case(info.name).find(lower_case(choice)) != std::string::npos;
    });
  };
  if (choice.find(',') == std::string::npos || named()) return {select_device(devices, choice)};
  for (std::string_view rest = choice;;) {
    const std::size_t comma = rest.find(',');
    const std::string one(rest.substr(0, comma));
    if (one.empty())
      throw UnknownDevice(fmt::format("'{}' is no list of devices, like 0,1", choice));
    const std::size_t index = select_device(devices, one);
    if (std::ranges::find(out, index) != out.end())
      refuse(fmt::format("device {} is named twice in '{}'", index, choice), devices);
    out.push_back(index);
    if (comma == std::string_view::npos) return out;
    rest.remove_prefix(comma + 1);
  }
}

std::optional<std::vector<std::size_t>> select_machine_devices(const Devices& machine,
                                                               const std::string& choice,
                                                               bool several) {
  if (machine.empty() || (several && lower_case(choice) == "all" && !has_processor(machine)))
    return std::nullopt;
  try {
    return several ? select_devices(machine, choice) : std::vector{select_device(machine, choice)};
  } catch (const UnknownDevice&) {
    return std::nullopt;
  }
}

}  // namespace caplet
