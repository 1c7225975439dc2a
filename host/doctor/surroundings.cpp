// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "doctor/surroundings.h"

#include <grp.h>
#include <pwd.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/environment.h"

namespace caplet::doctor {

namespace fs = std::filesystem;

Surroundings this_machine() {
  Surroundings out;
  out.variable = environment_variable;
  out.may = [](const fs::path& path, int mode) { return ::access(path.c_str(), mode) == 0; };
  out.group = [](const fs::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return std::string();
    const group* found = ::getgrgid(status.st_gid);
    return std::string(found ? found->gr_name : "");
  };
  out.free_bytes = [](const fs::path& folder) -> std::optional<std::uint64_t> {
    std::error_code error;
    const fs::space_info space = fs::space(folder, error);
    if (error) return std::nullopt;
    return space.available;
  };
  const passwd* user = ::getpwuid(::getuid());
  out.user = user ? user->pw_name : std::to_string(::getuid());
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    out.address_space = limit.rlim_cur;
  return out;
}

}  // namespace caplet::doctor
