// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The machine's files, variables and limits. Tests replace them by a tree of their own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace caplet::doctor {

struct Surroundings {
  std::filesystem::path root = "/";  // the parent of dev, etc, proc and sys
  std::function<std::string(const std::string& name)> variable;          // empty when it is not set
  std::function<bool(const std::filesystem::path& path, int mode)> may;  // as access(2)
  std::function<std::string(const std::filesystem::path& path)>
      group;  // the owning group; empty: unknown
  std::function<std::optional<std::uint64_t>(const std::filesystem::path& folder)>
      free_bytes;  // of its file system
  std::string user;
  std::optional<std::uint64_t> address_space;  // RLIMIT_AS in bytes
};

/// Returns the surroundings of this machine.
Surroundings this_machine();

}  // namespace caplet::doctor
