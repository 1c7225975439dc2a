// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/import.h"

#include <algorithm>
#include <cctype>
#include <system_error>

#include "import/look.h"

namespace caplet {

namespace fs = std::filesystem;

namespace {

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

const Format& format_of(const fs::path& path) {
  const std::string name = lower_case(path.filename().string());
  std::string known;
  for (const Format& format : formats())
    for (const std::string& extension : format.extensions) {
      if (name.size() > extension.size() && name.ends_with(extension)) return format;
      known += (known.empty() ? "" : ", ") + extension;
    }
  throw InputError({path.string()}, "no known scene format (known: " + known + ")");
}

void check_readable(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw InputError({path.string()}, "no such file");
  if (status.type() == fs::file_type::none) throw InputError({path.string()}, "cannot be read (" + error.message() + ")");
  if (fs::is_directory(status)) throw InputError({path.string()}, "is a folder, not a file");
  if (!fs::is_regular_file(status)) throw InputError({path.string()}, "is no regular file");
  if (fs::file_size(path, error) == 0 && !error) throw InputError({path.string()}, "the file is empty");
}

bool is_look(const std::string& name) {
  const auto found = std::ranges::find(import_option_rows(), name, &ImportOptionRow::name);
  return found != import_option_rows().end() && found->is_look;
}

void check_known(const ImportOptions& options, const Format& format) {
  for (const auto& [name, value] : options.values()) {
    if (is_look(name)) continue;
    if (std::ranges::find(format.options, name) != format.options.end()) continue;
    std::string who;
    for (const Format& other : formats())
      if (std::ranges::find(other.options, name) != other.options.end()) who += (who.empty() ? "" : ", ") + other.name;
    throw InputError({"--" + name},
                     "says nothing to files of the format " + format.name + (who.empty() ? "" : " (it does to: " + who + ")"));
  }
}

}  // namespace

Scene import_scene(const fs::path& path, const ImageReader& images, const ImportOptions& options) {
  check_readable(path);
  const Format& format = format_of(path);
  check_known(options, format);
  Scene scene = format.import(path, images, options);
  const bool is_turned = std::ranges::find(format.options, "up") != format.options.end();
  apply_look(scene, images, options, is_turned);
  Diagnostics diagnostics;
  validate(scene, diagnostics);
  diagnostics.finish();
  return scene;
}

}  // namespace caplet
