// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/reading.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "base/atomic_file.h"

namespace caplet {

namespace fs = std::filesystem;

namespace {

constexpr int most_links = 40;  // as in Linux

thread_local std::optional<fs::path> beneath;  // none: any file may be read

}  // namespace

ReadingBeneath::ReadingBeneath(const fs::path& scene)
    : before_(std::exchange(
          beneath, without_links(scene.has_parent_path() ? scene.parent_path() : fs::path(".")))) {}
ReadingBeneath::~ReadingBeneath() { beneath = std::move(before_); }

ReadingAnywhere::ReadingAnywhere() : before_(std::exchange(beneath, std::nullopt)) {}
ReadingAnywhere::~ReadingAnywhere() { beneath = std::move(before_); }

bool may_read(const fs::path& path) {
  if (!beneath) return true;
  const fs::path real = without_links(path);
  return std::mismatch(beneath->begin(), beneath->end(), real.begin(), real.end()).first ==
         beneath->end();
}

void check_may_read(const fs::path& path, const SourceLocation& where) {
  if (may_read(path)) return;
  const SourceLocation here = where.file.empty() ? SourceLocation{path.string()} : where;
  throw InputError(
      here, "'" + path.string() +
                "' is outside of the scene's folder, which --no-outside does not let it read");
}

void begin_reading(const fs::path& path, const SourceLocation& where) {
  check_may_read(path, where);
  note_input(path);
}

bool is_there(const fs::path& path, const SourceLocation& where) {
  check_may_read(path, where);
  std::error_code error;
  return fs::exists(path, error);
}

bool is_file(const fs::path& path, const SourceLocation& where) {
  check_may_read(path, where);
  std::error_code error;
  return fs::is_regular_file(path, error);
}

fs::path without_links(const fs::path& path) {
  std::error_code error;
  fs::path out, left = path.is_absolute() ? path : fs::current_path(error) / path;
  for (int links = 0; !left.empty();) {
    const fs::path name = *left.begin();
    fs::path rest;
    for (auto part = std::next(left.begin()); part != left.end(); ++part) rest /= *part;
    left = std::move(rest);
    if (name == ".." && out.has_relative_path()) {
      out = out.parent_path();
    } else if (name == "/" || (name == ".." && !out.empty())) {
      out = "/";
    } else if (!name.empty() && name != ".") {
      const fs::path here = out / name;
      if (!fs::is_symlink(fs::symlink_status(here, error))) {
        out = here;
        continue;
      }
      if (++links > most_links) return {};
      const fs::path to = fs::read_symlink(here, error);
      left = to / left;
      if (to.is_absolute()) out.clear();
    }
  }
  return out;
}

}  // namespace caplet
