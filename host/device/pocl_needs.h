// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// PoCL needs a cache folder that it can write; without it, PoCL offers no device or cannot compile.
// It also needs what /sys says of processors and memory; without it, PoCL ends the process ("Not
// enough memory to run on this device").
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace caplet {

/// Call this before the first OpenCL call of a process; later calls do nothing. Sets environment
/// variables where something is missing: POCL_CACHE_DIR to a temporary folder of this user,
/// HWLOC_SYNTHETIC to the processors and the memory that the kernel reports; and
/// POCL_MAX_PTHREAD_COUNT and POCL_CPU_MAX_CU_COUNT to thread_limit(), where there is one. Warns of
/// a missing /sys, which every PoCL needs.
void prepare_for_pocl();

/// Warns, once, of PoCL's own cache folder where another one takes its place. Call this when PoCL
/// is used.
void tell_of_pocl_cache();

/// Returns where PoCL keeps compiled kernels: $POCL_CACHE_DIR, else $XDG_CACHE_HOME/pocl/kcache,
/// else $HOME/.cache/pocl/kcache; empty when none of them is set. `variable` returns an environment
/// variable, empty when it is not set.
std::filesystem::path pocl_cache_folder(
    const std::function<std::string(const std::string&)>& variable);

/// Returns why no folder or file can be made at that place; it is empty if one can. Leaves nothing
/// behind.
std::string why_unwritable(const std::filesystem::path& folder);

/// Returns a folder of this user alone in `temporary`, the same for all processes; none where
/// somebody else has taken its name.
std::optional<std::filesystem::path> private_folder(const std::filesystem::path& temporary);

/// Returns whether `sys` lists processors.
bool tells_of_processors(const std::filesystem::path& sys);

}  // namespace caplet
