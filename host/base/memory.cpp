// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/memory.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>

namespace caplet {

namespace fs = std::filesystem;

namespace {

/// Returns the number behind `after` in the first line of a file that begins so and has one.
std::optional<std::uint64_t> number_in(const fs::path& file, const std::string& after) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(after)) continue;
    const char* text = line.c_str() + after.size();
    char* end = nullptr;
    const unsigned long long value = std::strtoull(text, &end, 10);
    if (end != text) return value;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::uint64_t> free_memory(const fs::path& root) {
  std::optional<std::uint64_t> out = number_in(root / "proc/meminfo", "MemAvailable:");
  if (out) *out *= 1024;
  const fs::path group = root / "sys/fs/cgroup";
  const auto most = number_in(group / "memory.max", ""),
             used = number_in(group / "memory.current", "");
  if (!most || !used) return out;
  const std::uint64_t left = *most > *used ? *most - *used : 0;
  return out ? std::min(*out, left) : left;
}

}  // namespace caplet
