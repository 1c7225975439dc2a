// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/memory.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>

#ifdef __linux__
#include <sys/mman.h>
#include <unistd.h>
#endif

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

#ifdef __linux__

void release_pages(const void* begin, std::size_t bytes) {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto from = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t first = (from + page - 1) / page * page, end = (from + bytes) / page * page;
  if (end > first) madvise(reinterpret_cast<void*>(first), end - first, MADV_DONTNEED);
}

#else

void release_pages(const void*, std::size_t) {}

#endif

}  // namespace caplet
