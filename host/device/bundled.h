// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is the OpenCL driver that comes with a portable installation (docs/portable.md): a PoCL with
// its own compiler, linker and cache, for machines that have no driver. The ICD loader does not
// know it. It is loaded beside the loader's platforms, after them, so the machine's own drivers are
// found as they are without it. Its platform works through the loader's functions, because these
// call the functions that the platform itself points to (cl_khr_icd).
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "device/opencl.h"

namespace caplet {

struct BundledDriver {
  std::filesystem::path folder;   // "pocl"; empty: there is none
  std::filesystem::path library;  // what has clIcdGetPlatformIDsKHR
  std::filesystem::path linker;   // the folder with a program "ld"

  explicit operator bool() const { return !folder.empty(); }
};

/// Returns the driver of an installation: the folder `pocl` beside `file`, a program or library, or
/// beside its folder. The variable CAPLET_BUNDLED_DRIVER names another folder; if that has no
/// driver (0), there is none. `variable` returns an environment variable, empty when it is not set.
/// Nothing is loaded.
BundledDriver bundled_driver(const std::filesystem::path& file,
                             const std::function<std::string(const std::string&)>& variable);

/// Returns the driver of this program or library, in this environment.
BundledDriver bundled_driver();

/// The name of its platform ends with this, so that pictures, caches and lists tell it from another
/// PoCL of the same version.
extern const char* const bundled_mark;

/// Returns its platforms: one, or none where it cannot be loaded. Loads it at the first call.
std::vector<cl::Platform> bundled_platforms();

/// Returns its devices. PoCL reads its environment at the first query, which is this one: it gets
/// Caplet's own cache folder, the level of this processor, and no plugins of the machine's hwloc.
/// The environment is afterwards as before. Throws cl::Error.
std::vector<cl::Device> bundled_devices(const cl::Platform& platform);

/// Returns where it keeps compiled kernels: $POCL_CACHE_DIR, else "pocl" in Caplet's cache folder;
/// empty where there is none.
std::filesystem::path bundled_cache_folder(
    const std::function<std::string(const std::string&)>& variable);
/// Returns where this process's PoCL, the bundled one or the machine's, keeps compiled kernels.
std::filesystem::path used_cache_folder(bool is_bundled);

/// PoCL's compiled functions are bundled for some kinds of processors only. Where PoCL would choose
/// functions that are not bundled, this returns the value of POCL_KERNELLIB_NAME; it is empty if
/// PoCL's own choice is bundled.
std::string bundled_level(bool has_avx2, bool has_avx);

/// Puts its linker before all others in PATH, where PoCL's compiler looks for `ld`. Call this
/// before it compiles a kernel. Later calls do nothing.
void use_bundled_linker();

/// Returns `path`, a list of folders between colons, with `folder` as its first; it is unchanged if
/// it is that already.
std::string with_first(const std::string& path, const std::filesystem::path& folder);

}  // namespace caplet
