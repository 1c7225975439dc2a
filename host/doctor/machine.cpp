// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "doctor/detail/machine.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "base/memory.h"
#include "device/bundled.h"
#include "device/pocl_needs.h"

namespace caplet::doctor {

namespace fs = std::filesystem;

namespace {

// With PoCL 3.1 on four cores, a picture of one capsule took 236 MB of memory.
constexpr std::uint64_t least_memory = std::uint64_t{256} << 20;
// On that machine no device was found with an address space of 500 MB; a render hung with 1 GB, and
// finished with 1.5 GB.
constexpr std::uint64_t least_address_space = 1500ull * 1000 * 1000;
// The kernels of one render took 1.1 MB of both caches with PoCL 3.1, so this has room for some
// fifty versions of them.
constexpr std::uint64_t least_cache_space = std::uint64_t{64} << 20;

std::string megabytes(std::uint64_t bytes) {
  return fmt::format("{:.1f} MB", static_cast<double>(bytes) * 1e-6);
}

std::vector<fs::path> nodes(const Surroundings& machine) {
  std::vector<fs::path> out;
  std::error_code error;
  const auto take = [&](const fs::path& folder, const auto& wanted) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
      if (wanted(entry.path().filename().string())) out.push_back(entry.path());
  };
  take(machine.root / "dev", [](const std::string& name) {
    const bool numbered = name.starts_with("nvidia") && name.size() > 6 &&
                          name.find_first_not_of("0123456789", 6) == std::string::npos;
    return name == "kfd" || name == "nvidiactl" || name == "nvidia-uvm" || numbered;
  });
  take(machine.root / "dev/dri",
       [](const std::string& name) { return name.starts_with("renderD"); });
  std::sort(out.begin(), out.end());
  return out;
}

/// Returns why no file can be written in the folder (which may not exist yet); empty: files can be
/// written.
std::string unwritable(const Surroundings& machine, const fs::path& folder) {
  std::error_code error;
  fs::path there = folder;
  while (!fs::exists(fs::status(there, error)) && there.has_relative_path()) {
    there = there.parent_path();
  }
  if (!fs::is_directory(there, error)) return fmt::format("{} is not a folder", there.string());
  if (!machine.may(there, W_OK | X_OK))
    return fmt::format("{} cannot be written by {}", there.string(), machine.user);
  const auto free = machine.free_bytes(there);
  if (free && *free < least_cache_space)
    return fmt::format("its file system has {} free, {} may be needed", megabytes(*free),
                       megabytes(least_cache_space));
  return {};
}

struct Content {
  std::uint64_t files = 0, bytes = 0;
};

Content content(const fs::path& folder) {
  Content out;
  std::error_code error;
  for (fs::recursive_directory_iterator
           at(folder, fs::directory_options::skip_permission_denied, error),
       end;
       !error && at != end; at.increment(error)) {
    std::error_code gone;
    if (!at->is_regular_file(gone)) continue;
    const std::uintmax_t bytes = at->file_size(gone);
    if (gone) continue;
    ++out.files;
    out.bytes += bytes;
  }
  return out;
}

Finding check_folder(const Surroundings& machine, const std::string& about, const fs::path& folder,
                     const std::string& variable, const std::string& loss) {
  if (const std::string why = unwritable(machine, folder); !why.empty())
    return {State::wrong, about,
            fmt::format("{} cannot be used: {}; {}", folder.string(), why, loss),
            fmt::format("export {}=FOLDER, one that can be written and has room", variable)};
  const Content held = content(folder);
  return {State::ok, about,
          fmt::format("{}: {} files, {}", folder.string(), held.files, megabytes(held.bytes)), ""};
}

}  // namespace

bool has_nvidia(const Surroundings& machine) {
  std::error_code error;
  for (const char* sign : {"proc/driver/nvidia/version", "dev/nvidiactl", "dev/nvidia0"})
    if (fs::exists(machine.root / sign, error)) return true;
  return false;
}

Findings check_permissions(const Surroundings& machine) {
  Findings out;
  const std::vector<fs::path> found = nodes(machine);
  for (const fs::path& node : found) {
    if (machine.may(node, R_OK | W_OK)) continue;
    std::string group = machine.group(node);
    if (group.empty() || group == "root") group = "render,video";
    out.push_back({State::wrong, node.string(),
                   fmt::format("{} may not read and write this GPU's node", machine.user),
                   fmt::format("sudo usermod -aG {} {} (then log in again)", group, machine.user)});
  }
  if (out.empty() && !found.empty())
    out.push_back({State::ok, "permissions",
                   fmt::format("{} may use the {} GPU nodes in /dev", machine.user, found.size()),
                   ""});
  return out;
}

Findings check_nvidia(const Surroundings& machine, const Registry& registry, const Loader& loader,
                      bool loadable) {
  if (!has_nvidia(machine)) return {};
  for (const Driver& driver : registry.drivers)
    if (driver.library.find("nvidia") != std::string::npos) return {};
  const std::string library = "libnvidia-opencl.so.1";
  const std::string what =
      "the GPU's kernel driver is here, but its OpenCL driver is not registered";
  if (!loadable)
    return {{State::wrong, "NVIDIA", what + fmt::format(", and {} is missing", library),
             "install the OpenCL library of the same driver version (in a container, start it with "
             "NVIDIA_DRIVER_CAPABILITIES=compute,utility)"}};
  // Containers may lack the file: https://github.com/NVIDIA/nvidia-container-toolkit/issues/682
  if (!registry.variable.empty())
    return {
        {State::note, "NVIDIA", fmt::format("{}: {} leaves it out", what, registry.variable), ""}};
  return {
      {State::wrong, "NVIDIA", what,
       fmt::format(
           "echo {} | sudo tee /etc/OpenCL/vendors/nvidia.icd (or for one command: {} caplet ...)",
           library, only_text(library, loader))}};
}

Findings check_unused_gpus(const Surroundings& machine,
                           const std::vector<PlatformFacts>& platforms) {
  for (const PlatformFacts& platform : platforms)
    for (const DeviceFacts& device : platform.devices)
      if (device.info.type == "gpu") return {};
  Findings out;
  for (const fs::path& node : nodes(machine)) {
    std::ifstream in(machine.root / "sys/class/drm" / node.filename() / "device/vendor");
    std::string vendor;
    in >> vendor;  // PCI's vendor id
    if (vendor == "0x1002")
      out.push_back({State::note, node.string(), "a GPU of AMD, which no OpenCL platform offers",
                     "install ROCm's OpenCL, or sudo apt-get install mesa-opencl-icd"});
    if (vendor == "0x8086")
      out.push_back({State::note, node.string(), "a GPU of Intel, which no OpenCL platform offers",
                     "sudo apt-get install intel-opencl-icd"});
  }
  return out;
}

Findings check_memory(const Surroundings& machine) {
  Findings out;
  if (const auto free = free_memory(machine.root)) {
    if (*free < least_memory)
      out.push_back({State::wrong, "memory",
                     fmt::format("{} are free, and the smallest render takes {}", megabytes(*free),
                                 megabytes(least_memory)),
                     "end other programs, or give the container more memory"});
    else
      out.push_back({State::ok, "memory", fmt::format("{} are free", megabytes(*free)), ""});
  }
  if (machine.address_space) {
    const bool enough = *machine.address_space >= least_address_space;
    out.push_back(
        {enough ? State::note : State::wrong, "memory",
         fmt::format(
             "the address space is limited to {}{}", megabytes(*machine.address_space),
             enough ? "" : fmt::format(", and PoCL needs {}", megabytes(least_address_space))),
         enough ? "" : "ulimit -v unlimited"});
  }
  return out;
}

Findings check_cache(const Surroundings& machine, const fs::path& folder) {
  const std::string loss = "kernels are compiled, and devices tested, again at every start";
  if (folder.empty())
    return {
        {State::wrong, "cache",
         "CAPLET_CACHE, XDG_CACHE_HOME and HOME are not set: there is no folder for it; " + loss,
         "export CAPLET_CACHE=FOLDER"}};
  return {check_folder(machine, "cache", folder, "CAPLET_CACHE", loss)};
}

Findings check_pocl_cache(const Surroundings& machine) {
  const fs::path folder = pocl_cache_folder(machine.variable);
  if (folder.empty()) return {};
  return {check_folder(
      machine, "PoCL's cache", folder, "POCL_CACHE_DIR",
      "PoCL offers no device then or cannot compile; Caplet gives it a temporary folder")};
}

Findings check_bundled_cache(const Surroundings& machine) {
  const fs::path folder = bundled_cache_folder(machine.variable);
  if (folder.empty()) return {};
  return {check_folder(machine, "the bundled driver's cache", folder, "CAPLET_CACHE",
                       "it uses PoCL's then")};
}

Findings check_layers(const Surroundings& machine) {
  const std::string layers = machine.variable("OPENCL_LAYERS");
  if (layers.empty()) return {};
  return {{State::note, "OPENCL_LAYERS", "every call to a driver goes through " + layers,
           "unset OPENCL_LAYERS, where this is not meant"}};
}

Findings check_sys(const Surroundings& machine) {
  if (tells_of_processors(machine.root / "sys")) return {};
  return {{State::note, (machine.root / "sys").string(),
           "devices/system/cpu is not there: PoCL finds neither processors nor memory without it, "
           "and ends programs (\"Not enough "
           "memory to run on this device\"); Caplet tells it of them, other programs do not",
           "sudo mount -t sysfs sysfs /sys, or a container that has it"}};
}

}  // namespace caplet::doctor
