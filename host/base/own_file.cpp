// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/own_file.h"

#include <dlfcn.h>
#include <link.h>

#include <system_error>

namespace caplet {

namespace fs = std::filesystem;

fs::path own_file() {
  Dl_info info{};
  link_map* map = nullptr;
  if (::dladdr1(reinterpret_cast<void*>(&own_file), &info, reinterpret_cast<void**>(&map),
                RTLD_DL_LINKMAP) == 0 ||
      map == nullptr)
    return {};
  // The program's own map has no name, and dladdr gives the name that it was called by, which may
  // be another file's.
  const fs::path found = *map->l_name != '\0' ? fs::path(map->l_name) : fs::path("/proc/self/exe");
  std::error_code error;
  const fs::path file = fs::canonical(found, error);
  return error ? fs::path() : file;
}

}  // namespace caplet
