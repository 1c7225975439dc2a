// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds and loads the module of image files.
#include "film/detail/image_module.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <system_error>

#include "base/error.h"
#include "base/own_file.h"

namespace caplet::image_files {

namespace fs = std::filesystem;

namespace {

constexpr const char* file_name = "caplet_images.so";

struct Loaded {
  const Module* module = nullptr;
  std::string why;
};

Loaded load_from(const fs::path& path) {
  void* const library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return {nullptr, ::dlerror()};
  using Entry = const Module* (*)();
  const auto entry = reinterpret_cast<Entry>(::dlsym(library, "caplet_image_module"));
  const Module* const module = entry ? entry() : nullptr;
  if (module == nullptr || module->version != Module::current)
    return {nullptr, fmt::format("{} is of another version", path.string())};
  return {module, {}};
}

/// Looks beside the program or library that this code is in, where an installation has modules, and
/// where the build made it.
Loaded load() {
  const fs::path folder = own_file().parent_path();
  const std::array<fs::path, 4> folders = {
      folder, folder / "caplet", folder / CAPLET_MODULES_FROM_PROGRAM, CAPLET_MODULES_OF_BUILD};
  std::error_code error;
  for (const fs::path& from : folders)
    if (const fs::path path = from / file_name; fs::exists(path, error)) return load_from(path);
  return {nullptr, fmt::format("{} is neither in {} nor in {}", file_name, folder.string(),
                               (folder / CAPLET_MODULES_FROM_PROGRAM).lexically_normal().string())};
}

}  // namespace

bool available() { return true; }

const Module& module_for(const fs::path& path) {
  static const Loaded loaded = load();
  if (loaded.module == nullptr)
    throw RunError(fmt::format(
        "{}: images other than EXR and PNG need OpenImageIO, which cannot be loaded: {}",
        path.string(), loaded.why));
  return *loaded.module;
}

}  // namespace caplet::image_files
