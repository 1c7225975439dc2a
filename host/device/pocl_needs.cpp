// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "device/pocl_needs.h"

#include <fmt/format.h>
#include <sched.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>

#include "base/environment.h"
#include "base/log.h"
#include "base/threads.h"

namespace caplet {

namespace fs = std::filesystem;

namespace {

std::string told;  // of the cache folder; written by prepare_for_pocl alone

void replace_cache() {
  const fs::path folder = pocl_cache_folder(environment_variable);
  if (folder.empty()) return;  // PoCL has a temporary one then
  const std::string why = why_unwritable(folder);
  if (why.empty()) return;
  const std::string said =
      fmt::format("PoCL's cache folder {} cannot be used ({})", folder.string(), why);
  std::error_code error;
  const fs::path temporary = fs::temp_directory_path(error);
  const auto own = error ? std::nullopt : private_folder(temporary);
  if (!own) {  // PoCL will offer no device that could say so
    log::warn(
        "{}, nor can a temporary one be made: PoCL does not work so (POCL_CACHE_DIR names another "
        "folder)",
        said);
    return;
  }
  ::setenv("POCL_CACHE_DIR", (*own / "pocl").c_str(), 1);
  told = fmt::format(
      "{}: compiled kernels are in {}, until that goes (POCL_CACHE_DIR names another folder)", said,
      (*own / "pocl").string());
}

void replace_topology() {
  constexpr const char* by_hand[] = {"HWLOC_SYNTHETIC", "HWLOC_XMLFILE", "HWLOC_FSROOT"};
  if (tells_of_processors("/sys") ||
      std::ranges::any_of(by_hand, [](const char* name) { return std::getenv(name) != nullptr; }))
    return;
  cpu_set_t usable;
  CPU_ZERO(&usable);
  const int processors =
      ::sched_getaffinity(0, sizeof usable, &usable) == 0 ? std::max(1, CPU_COUNT(&usable)) : 1;
  const long long memory =
      static_cast<long long>(::sysconf(_SC_PHYS_PAGES)) * ::sysconf(_SC_PAGESIZE);
  log::warn(
      "/sys/devices/system/cpu is not there: PoCL finds neither processors nor memory without it, "
      "and is told of {} and {} MB; "
      "mount /sys (in a container: do not leave it out)",
      processors, memory / 1'000'000);
  // See https://www.open-mpi.org/projects/hwloc/doc/ "Synthetic topologies".
  ::setenv("HWLOC_SYNTHETIC",
           fmt::format("pack:1 [numa(memory={})] core:{} pu:1", memory, processors).c_str(), 1);
}

void limit_device() {
  // PoCL before and since 5.
  if (const unsigned most = thread_limit(); most > 0)
    for (const char* name : {"POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT"})
      ::setenv(name, std::to_string(most).c_str(), 1);
}

}  // namespace

void prepare_for_pocl() {
  static std::once_flag once;
  std::call_once(once, [] {
    replace_cache();
    replace_topology();
    limit_device();
  });
}

void tell_of_pocl_cache() {
  static std::atomic<bool> is_told = false;
  if (!told.empty() && !is_told.exchange(true)) log::warn("{}", told);
}

fs::path pocl_cache_folder(const std::function<std::string(const std::string&)>& variable) {
  if (const std::string named = variable("POCL_CACHE_DIR"); !named.empty()) return named;
  if (const std::string base = variable("XDG_CACHE_HOME"); !base.empty())
    return fs::path(base) / "pocl/kcache";
  if (const std::string home = variable("HOME"); !home.empty())
    return fs::path(home) / ".cache/pocl/kcache";
  return {};
}

std::string why_unwritable(const fs::path& folder) {
  std::error_code error;
  fs::path there = folder;
  while (!there.empty() && there.has_relative_path() &&
         fs::symlink_status(there, error).type() == fs::file_type::not_found)
    there = there.parent_path();
  if (there.empty()) there = ".";
  if (!fs::is_directory(there, error)) return fmt::format("{} is not a folder", there.string());
  std::string probe = (there / ".caplet-XXXXXX").string();
  if (!::mkdtemp(probe.data())) return fmt::format("{}: {}", there.string(), std::strerror(errno));
  ::rmdir(probe.c_str());
  return {};
}

std::optional<fs::path> private_folder(const fs::path& temporary) {
  const fs::path folder = temporary / fmt::format("caplet-{}", ::geteuid());
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) return {};
  struct stat status {};
  // A folder in /tmp may be somebody else's, who would then choose the code that runs here.
  if (::lstat(folder.c_str(), &status) != 0 || !S_ISDIR(status.st_mode)) return {};
  if (status.st_uid != ::geteuid() || (status.st_mode & 077) != 0 ||
      !why_unwritable(folder).empty())
    return {};
  return folder;
}

bool tells_of_processors(const fs::path& sys) {
  std::error_code error;
  return fs::is_directory(sys / "devices/system/cpu", error);
}

}  // namespace caplet
