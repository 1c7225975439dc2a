// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The files that Include and Import name.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "import/detail/gzip_file.h"
#include "import/detail/pbrt/builder.h"

namespace caplet::pbrt {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t deepest_include = 64;
// These limits stop files that include each other many times; real scenes stay far below.
constexpr std::size_t most_included_files = 1 << 16;
constexpr std::size_t most_included_again = std::size_t{1}
                                            << 28;  // bytes of files that were read before

std::string canonical_path(const std::string& file) {
  std::error_code ignored;
  return fs::weakly_canonical(file, ignored).string();
}

}  // namespace

Includes::Includes(const std::string& main_file, Diagnostics& diagnostics)
    : main_file_(main_file), diagnostics_(diagnostics) {
  open_files_.push_back({main_file, canonical_path(main_file)});
}

void Includes::begin(const Statement& at, const Word& name) {
  std::string file = resolve_file(name.text, name.where, main_file_),
              canonical = canonical_path(file);
  const auto same = std::ranges::find(open_files_, canonical, &OpenFile::canonical);
  if (same != open_files_.end()) {
    std::string chain;
    for (auto it = same; it != open_files_.end(); ++it) chain += it->name + " includes ";
    throw SyntaxError{name.where, "recursive " + std::string(at.directive) + " of " + file + ": " +
                                      chain + same->name};
  }
  if (open_files_.size() >= deepest_include)
    throw SyntaxError{name.where,
                      "more than " + std::to_string(deepest_include) + " files within each other"};
  if (++included_files_ > most_included_files) {
    diagnostics_.error(name.where, "more than " + std::to_string(most_included_files) +
                                       " files are included, one within the other");
    diagnostics_.finish();
  }
  open_files_.push_back({std::move(file), std::move(canonical)});
}

void Includes::read(const Word& name, const ParseText& parse) {
  const std::string file = open_files_.back().name;
  std::optional<std::string> text;
  try {
    text = read_text(file, name.where);
  } catch (const InputError& problem) {
    add_errors(problem, name.where, diagnostics_);
  }
  if (text && !files_read_.insert(open_files_.back().canonical).second)
    included_again_ += text->size();
  if (included_again_ > most_included_again) {
    diagnostics_.error(name.where,
                       "the same files are included over and over: more than 256 MiB of text that "
                       "was read before");
    diagnostics_.finish();
  }
  if (text) parse(file, std::move(*text));
  open_files_.pop_back();
}

}  // namespace caplet::pbrt
