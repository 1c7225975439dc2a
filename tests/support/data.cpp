// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "support/data.h"

#include <unistd.h>

#include <cstdlib>
#include <string_view>
#include <system_error>

namespace caplet::test {

namespace fs = std::filesystem;

fs::path source_folder() {
  const char* const named = std::getenv("CAPLET_SOURCE");
  return named && *named ? named : CAPLET_SOURCE_DIR;
}

fs::path data_folder() {
  if (const char* named = std::getenv("CAPLET_DATA"); named && fs::is_directory(named))
    return named;
  const fs::path beside = source_folder() / ".." / "shared" / "data";
  return fs::is_directory(beside) ? fs::weakly_canonical(beside) : fs::path();
}

bool data_required() {
  const char* value = std::getenv("CAPLET_REQUIRE_DATA");
  return value && *value && std::string_view(value) != "0";
}

fs::path temporary_folder() {
  struct Folder {
    fs::path path = fs::temp_directory_path() / ("caplet-test-" + std::to_string(::getpid()));
    int count = 0;
    ~Folder() {
      std::error_code ignored;
      fs::remove_all(path, ignored);
    }
  };
  static Folder folder;
  const fs::path fresh = folder.path / std::to_string(folder.count++);
  fs::create_directories(fresh);
  return fresh;
}

}  // namespace caplet::test
