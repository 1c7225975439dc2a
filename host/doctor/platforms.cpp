// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "doctor/platforms.h"

#include <dlfcn.h>

#include <array>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "base/log.h"
#include "base/utf8.h"
#include "device/bundled.h"
#include "device/cl_error.h"
#include "device/describe.h"

namespace caplet {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeviceInfo, index, name, vendor, driver, version, platform, type,
                                   compute_units, native_float_width, global_bytes,
                                   max_allocation_bytes, bundled)
}

namespace caplet::doctor {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeviceFacts, info, available, compiler, little_endian, profile)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlatformFacts, name, vendor, version, devices_error, devices)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Loader, name, vendor, version)

namespace {

using Json = nlohmann::json;

void set(const Variables& variables) {
  for (const auto& [name, value] : variables) ::setenv(name.c_str(), value.c_str(), 1);
}

DeviceFacts facts_of(const cl::Device& device, const FoundPlatform& platform) {
  DeviceFacts out;
  out.info = describe(device, platform_name(platform));
  out.info.bundled = platform.bundled;
  out.available = device.getInfo<CL_DEVICE_AVAILABLE>() != CL_FALSE;
  out.compiler = device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>() != CL_FALSE;
  out.little_endian = device.getInfo<CL_DEVICE_ENDIAN_LITTLE>() != CL_FALSE;
  out.profile = device.getInfo<CL_DEVICE_PROFILE>();
  return out;
}

/// Indices are those of list_devices(): if a query to a platform fails, its devices before the
/// failure still count.
std::vector<PlatformFacts> platforms_here(Drivers drivers) {
  std::vector<PlatformFacts> out;
  int index = 0;
  for (const FoundPlatform& platform : find_platforms(drivers)) {
    PlatformFacts& facts = out.emplace_back();
    try {
      facts.name = platform.platform.getInfo<CL_PLATFORM_NAME>();
      facts.vendor = platform.platform.getInfo<CL_PLATFORM_VENDOR>();
      facts.version =
          platform.platform.getInfo<CL_PLATFORM_VERSION>() + (platform.bundled ? bundled_mark : "");
      for (const cl::Device& device : devices_of(platform)) {
        DeviceFacts found = facts_of(device, platform);
        found.info.index = index++;
        facts.devices.push_back(found);
      }
    } catch (const cl::Error& error) {
      facts.devices_error = std::string(error.what()) + ": " + cl_error_name(error.err());
    }
  }
  return out;
}

Answer read_answer(ChildEnd end) {
  Answer out;
  if (end.finished) {
    const Json json = Json::parse(end.answer);
    if (json.is_string())
      out.load_error = json.get<std::string>();
    else
      out.platforms = json.get<std::vector<PlatformFacts>>();
  }
  out.end = std::move(end);
  return out;
}

}  // namespace

bool Answer::has_devices() const {
  for (const PlatformFacts& platform : platforms)
    if (!platform.devices.empty()) return true;
  return false;
}

Loader ask_loader() {
  constexpr double seconds = 20;
  const ChildEnd end = in_child(
      [] {
        // With these, neither kind of loader finds (and loads) a driver.
        set({{"OCL_ICD_VENDORS", "/nonexistent/none"}, {"OCL_ICD_FILENAMES", ""}});
        using Ask = cl_int(CL_API_CALL*)(cl_uint, std::size_t, void*, std::size_t*);
        // These are CL_ICDL_VERSION, CL_ICDL_NAME, CL_ICDL_VENDOR of the extension cl_loader_info.
        constexpr cl_uint version = 2, name = 3, vendor = 4;
        // The function is looked up because the headers mark it as deprecated, although loaders use
        // it for their own extensions.
        using Address = void*(CL_API_CALL*)(const char*);
        const auto address =
            reinterpret_cast<Address>(::dlsym(RTLD_DEFAULT, "clGetExtensionFunctionAddress"));
        const auto ask =
            reinterpret_cast<Ask>(address ? address("clGetICDLoaderInfoOCLICD") : nullptr);
        const auto text = [&](cl_uint what) {
          std::array<char, 256> out{};
          if (!ask || ask(what, out.size() - 1, out.data(), nullptr) != CL_SUCCESS)
            return std::string();
          return std::string(out.data());
        };
        return json_dump(Json(Loader{text(name), text(vendor), text(version)}));
      },
      seconds);
  return end.finished ? Json::parse(end.answer).get<Loader>() : Loader();
}

Answer ask_driver(const Driver& driver, const Loader& loader, double seconds) {
  return read_answer(in_child(
      [&] {
        if (!::dlopen(driver.library.c_str(), RTLD_LAZY | RTLD_LOCAL)) {
          const char* error = ::dlerror();
          return json_dump(Json(error ? error : "unknown error"));
        }
        set(only(driver.library, loader));
        return json_dump(Json(platforms_here(Drivers::machine)));
      },
      seconds));
}

Answer ask_all(const Variables& variables, double seconds) {
  return read_answer(in_child(
      [&] {
        set(variables);
        return json_dump(Json(platforms_here(Drivers::all)));
      },
      seconds));
}

Answer ask_bundled(double seconds) {
  return read_answer(in_child(
      [] {
        if (!::dlopen(bundled_driver().library.c_str(), RTLD_LAZY | RTLD_LOCAL)) {
          const char* error = ::dlerror();
          return json_dump(Json(error ? error : "unknown error"));
        }
        return json_dump(Json(platforms_here(Drivers::bundled)));
      },
      seconds));
}

bool can_load(const std::string& library, double seconds) {
  return in_child([&] { return ::dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL) ? "yes" : ""; },
                  seconds)
             .answer == "yes";
}

ChildEnd test_device(int index, const Variables& variables,
                     const std::function<void(const Device&)>& test, double seconds) {
  return in_child(
      [&] {
        set(variables);
        set({{"CAPLET_SELF_TEST", "1"}});
        log::set_quiet(true);
        test(Device::choose(std::to_string(index)));
        return std::string();
      },
      seconds);
}

}  // namespace caplet::doctor
