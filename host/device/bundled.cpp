// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "device/bundled.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <mutex>
#include <optional>
#include <system_error>

#include "base/environment.h"
#include "base/log.h"
#include "base/own_file.h"
#include "device/cache.h"
#include "device/pocl_needs.h"

namespace caplet {

namespace fs = std::filesystem;

const char* const bundled_mark = ", bundled with Caplet";

namespace {

// PoCL looks for its headers and built-in functions in ../../share/pocl of its library's folder,
// and for its devices in the folder pocl beside the library.
constexpr const char* library_in_folder = "lib/caplet/libpocl-caplet.so.2";

/// Sets an environment variable for as long as the object lives.
class ScopedVariable {
 public:
  ScopedVariable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    ::setenv(name, value.c_str(), 1);
  }
  ~ScopedVariable() {
    if (before_)
      ::setenv(name_, before_->c_str(), 1);
    else
      ::unsetenv(name_);
  }
  ScopedVariable(const ScopedVariable&) = delete;
  ScopedVariable& operator=(const ScopedVariable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

std::vector<cl::Platform> load_platforms() {
  const BundledDriver driver = bundled_driver();
  if (!driver) return {};
  void* const library = ::dlopen(driver.library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* const why = ::dlerror();
    log::warn("the bundled OpenCL driver cannot be loaded: {}", why ? why : "unknown error");
    return {};
  }
  // This follows cl_khr_icd: drivers return their platforms by this function, and return its
  // address by a function that they export.
  using Address = void*(CL_API_CALL*)(const char*);
  using Platforms = cl_int(CL_API_CALL*)(cl_uint, cl_platform_id*, cl_uint*);
  const auto address = reinterpret_cast<Address>(::dlsym(library, "clGetExtensionFunctionAddress"));
  const auto ask =
      reinterpret_cast<Platforms>(address ? address("clIcdGetPlatformIDsKHR") : nullptr);
  cl_platform_id id = nullptr;
  if (ask == nullptr || ask(1, &id, nullptr) != CL_SUCCESS || id == nullptr) return {};
  return {cl::Platform(id)};
}

}  // namespace

BundledDriver bundled_driver(const fs::path& file,
                             const std::function<std::string(const std::string&)>& variable) {
  const std::string named = variable("CAPLET_BUNDLED_DRIVER");
  const fs::path beside = file.parent_path();
  std::vector<fs::path> folders;
  if (!named.empty())
    folders = {named};
  else if (!file.empty())
    folders = {beside / "pocl", beside.parent_path() / "pocl"};
  std::error_code error;
  for (const fs::path& folder : folders)
    if (fs::is_regular_file(folder / library_in_folder, error))
      return {folder, folder / library_in_folder, folder / "bin"};
  return {};
}

BundledDriver bundled_driver() { return bundled_driver(own_file(), environment_variable); }

std::vector<cl::Platform> bundled_platforms() {
  static const std::vector<cl::Platform> platforms = load_platforms();
  return platforms;
}

std::vector<cl::Device> bundled_devices(const cl::Platform& platform) {
  const fs::path cache = bundled_cache_folder(environment_variable);
  std::optional<ScopedVariable> own_cache;
  if (!cache.empty() && why_unwritable(cache).empty())
    own_cache.emplace("POCL_CACHE_DIR", cache.string());
  std::optional<ScopedVariable> level;
  if (const std::string name =
          bundled_level(__builtin_cpu_supports("avx2") != 0, __builtin_cpu_supports("avx") != 0);
      !name.empty() && environment_variable("POCL_KERNELLIB_NAME").empty())
    level.emplace("POCL_KERNELLIB_NAME", name);
  // Plugins are built for the machine's hwloc, which may have another version.
  const ScopedVariable no_plugins("HWLOC_PLUGINS_PATH", bundled_driver().folder.string());
  std::vector<cl::Device> devices;
  cl::Platform(platform).getDevices(CL_DEVICE_TYPE_ALL, &devices);
  return devices;
}

fs::path bundled_cache_folder(const std::function<std::string(const std::string&)>& variable) {
  if (const std::string named = variable("POCL_CACHE_DIR"); !named.empty()) return named;
  const fs::path folder = cache_folder();
  return folder.empty() ? folder : folder / "pocl";
}

fs::path used_cache_folder(bool is_bundled) {
  return is_bundled ? bundled_cache_folder(environment_variable)
                    : pocl_cache_folder(environment_variable);
}

std::string bundled_level(bool has_avx2, bool has_avx) {
  if (has_avx2) return {};  // PoCL chooses avx2 or avx512
  return has_avx ? "avx" : "sse2";
}

std::string with_first(const std::string& path, const fs::path& folder) {
  const std::string first = folder.string();
  if (path.empty()) return first;
  return path == first || path.starts_with(first + ":") ? path : first + ":" + path;
}

void use_bundled_linker() {
  static std::once_flag once;
  std::call_once(once, [] {
    const BundledDriver driver = bundled_driver();
    if (driver)
      ::setenv("PATH", with_first(environment_variable("PATH"), driver.linker).c_str(), 1);
  });
}

}  // namespace caplet
