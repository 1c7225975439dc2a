// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What a machine offers beside OpenCL: files, variables, limits. Tests put a tree of their own in its place.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace caplet::doctor {

struct Surroundings {
  std::filesystem::path root = "/";                                      // in front of dev, etc, proc and sys
  std::function<std::string(const std::string& name)> variable;          // empty when it is not set
  std::function<bool(const std::filesystem::path& path, int mode)> may;  // as access(2)
  std::function<std::string(const std::filesystem::path& path)> group;   // that owns the file; empty: unknown
  std::function<std::optional<std::uint64_t>(const std::filesystem::path& folder)> free_bytes;  // of its file system
  std::string user;
  std::optional<std::uint64_t> address_space;  // RLIMIT_AS in bytes
};

/// This machine's.
Surroundings this_machine();

}  // namespace caplet::doctor
