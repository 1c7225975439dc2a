// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>

namespace caplet {

/// Returns the bytes that processes may still take: of the machine, and of this process's control
/// group (cgroup v2) where it has a limit. Empty if Linux does not say. `root` holds proc and sys.
std::optional<std::uint64_t> free_memory(const std::filesystem::path& root = "/");

/// Gives the whole pages of these bytes, which nobody reads again, back to the system, where that
/// is possible (Linux). They are zeros then. The memory stays allocated.
void release_pages(const void* begin, std::size_t bytes);

}  // namespace caplet
