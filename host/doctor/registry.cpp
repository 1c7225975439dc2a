// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "doctor/registry.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace caplet::doctor {

namespace fs = std::filesystem;

const char* const install_a_driver =
    "sudo apt-get install pocl-opencl-icd (any CPU), or the driver of your GPU with its OpenCL "
    "package";

namespace {

Driver from_file(const Surroundings& machine, const fs::path& file) {
  Driver out{file.string(), "", ""};
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    out.problem = error || !fs::exists(file) ? "does not exist" : "is not a file";
    return out;
  }
  std::ifstream in(file);
  if (!machine.may(file, R_OK) || !in) {
    out.problem = "cannot be read";
    return out;
  }
  std::getline(in, out.library);
  if (out.library.empty()) out.problem = "names no library in its first line";
  if (out.library.find_last_of(" \t\r") + 1 == out.library.size() && !out.library.empty())
    out.problem = "has a blank or a carriage return behind the library's name";
  return out;
}

void read_folder(const Surroundings& machine, const fs::path& folder, Registry& to) {
  to.place = folder.string();
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (!fs::exists(status)) {
    to.problem = "does not exist";
  } else if (!fs::is_directory(status)) {
    to.problem = "is not a folder";
  } else if (fs::directory_iterator entries(folder, error);
             error || !machine.may(folder, R_OK | X_OK)) {
    to.problem = "cannot be read";
  } else {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : entries)
      if (entry.path().extension() == ".icd") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) to.drivers.push_back(from_file(machine, file));
    if (files.empty()) to.problem = "holds no .icd file";
  }
}

Registry as_ocl_icd(const Surroundings& machine) {
  Registry out;
  const std::string named = machine.variable("OCL_ICD_VENDORS"),
                    path = machine.variable("OPENCL_VENDOR_PATH");
  const fs::path folder = path.empty() ? machine.root / "etc/OpenCL/vendors" : fs::path(path);
  out.variable = !named.empty() ? "OCL_ICD_VENDORS" : !path.empty() ? "OPENCL_VENDOR_PATH" : "";
  std::error_code error;
  if (named.empty()) {
    read_folder(machine, folder, out);
  } else if (fs::is_directory(named, error)) {
    read_folder(machine, named, out);
  } else if (named.size() > 4 && named.ends_with(".icd")) {
    const bool beside = named.find('/') == std::string::npos && fs::exists(folder / named, error);
    out.place = beside ? (folder / named).string() : named;
    out.drivers.push_back(from_file(machine, out.place));
  } else {
    out.place = named;
    out.drivers.push_back({"OCL_ICD_VENDORS", named, ""});
  }
  return out;
}

Registry as_khronos(const Surroundings& machine) {
  Registry out;
  const std::string named = machine.variable("OCL_ICD_VENDORS");
  out.variable = named.empty() ? "" : "OCL_ICD_VENDORS";
  read_folder(machine, named.empty() ? machine.root / "etc/OpenCL/vendors" : fs::path(named), out);
  std::string list = machine.variable("OCL_ICD_FILENAMES");
  if (!list.empty()) out.problem.clear();
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(':'), list.size());
    out.drivers.push_back({"OCL_ICD_FILENAMES", list.substr(0, end), ""});
    list.erase(0, end + 1);
  }
  return out;
}

}  // namespace

Registry read_registry(const Surroundings& machine, const Loader& loader) {
  return loader.is_ocl_icd() ? as_ocl_icd(machine) : as_khronos(machine);
}

Findings check_registry(const Registry& registry, bool has_bundled) {
  Findings out;
  const std::string about =
      registry.variable.empty() ? registry.place : registry.variable + "=" + registry.place;
  if (!registry.problem.empty()) {
    const std::string fix =
        registry.problem == "cannot be read" ? fmt::format("sudo chmod a+rX '{}'", registry.place)
        : registry.variable.empty()
            ? install_a_driver
            : fmt::format("unset {}, or {}", registry.variable, install_a_driver);
    out.push_back({has_bundled ? State::note : State::wrong, about,
                   fmt::format("no OpenCL driver is registered: the {} {}{}",
                               registry.problem == "is not a folder" ? "path" : "folder",
                               registry.problem, has_bundled ? "; the bundled one is used" : ""),
                   fix});
  } else {
    out.push_back({State::ok, about,
                   fmt::format("{} driver{} registered here", registry.drivers.size(),
                               registry.drivers.size() == 1 ? "" : "s"),
                   ""});
  }
  for (const Driver& driver : registry.drivers) {
    if (driver.problem.empty()) continue;
    const std::string fix =
        driver.problem == "cannot be read" ? fmt::format("sudo chmod a+r '{}'", driver.from)
        : driver.problem == "does not exist"
            ? fmt::format("unset {}", registry.variable)
            : "write the name of the driver's library, and nothing else, into its first line";
    out.push_back({State::wrong, driver.from, "this file " + driver.problem, fix});
  }
  return out;
}

std::vector<std::pair<std::string, std::string>> only(const std::string& library,
                                                      const Loader& loader) {
  // ocl-icd takes the library itself in this variable; Khronos's adds the library to a folder, here
  // one that does not exist.
  if (loader.is_ocl_icd()) return {{"OCL_ICD_VENDORS", library}};
  return {{"OCL_ICD_FILENAMES", library}, {"OCL_ICD_VENDORS", "/nonexistent"}};
}

std::string only_text(const std::string& library, const Loader& loader) {
  std::string out;
  for (const auto& [name, value] : only(library, loader))
    out += fmt::format("{}{}={}", out.empty() ? "" : " ", name, value);
  return out;
}

}  // namespace caplet::doctor
