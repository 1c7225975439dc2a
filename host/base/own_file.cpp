// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/own_file.h"

#include <dlfcn.h>

#include <system_error>

namespace caplet {

namespace fs = std::filesystem;

fs::path own_file() {
  Dl_info info{};
  if (::dladdr(reinterpret_cast<void*>(&own_file), &info) == 0 || info.dli_fname == nullptr) return {};
  std::error_code error;
  const fs::path named = info.dli_fname;
  // The name of a program is that which it was called by.
  const fs::path found = fs::exists(named, error) && named.has_parent_path() ? named : fs::path("/proc/self/exe");
  const fs::path file = fs::canonical(found, error);
  return error ? fs::path() : file;
}

}  // namespace caplet
