// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Findings about the machine: GPU nodes and who may use them, memory, cache folders. No OpenCL call.
#pragma once

#include <filesystem>

#include "doctor/platforms.h"
#include "doctor/registry.h"

namespace caplet::doctor {

/// Whether the kernel module of NVIDIA's driver is there.
bool has_nvidia(const Surroundings& machine);

/// GPU nodes in /dev that this user may not open.
Findings check_permissions(const Surroundings& machine);

/// An NVIDIA GPU without a registered OpenCL driver. `loadable`: whether libnvidia-opencl.so.1 can be loaded.
Findings check_nvidia(const Surroundings& machine, const Registry& registry, const Loader& loader, bool loadable);

/// A GPU node of AMD or Intel where no platform offers a GPU.
Findings check_unused_gpus(const Surroundings& machine, const std::vector<PlatformFacts>& platforms);

/// Free memory of the host, within the limits of its control group, and the address space (ulimit -v).
Findings check_memory(const Surroundings& machine);

/// Caplet's cache: where, how much, and whether it can be written.
Findings check_cache(const Surroundings& machine, const std::filesystem::path& folder);

/// A missing /sys, as containers may have it, without which PoCL ends the process.
Findings check_sys(const Surroundings& machine);

/// PoCL's cache. $POCL_CACHE_DIR, else $XDG_CACHE_HOME/pocl/kcache, else $HOME/.cache/pocl/kcache; without any PoCL uses /tmp.
Findings check_pocl_cache(const Surroundings& machine);
/// That of the driver that came with this program.
Findings check_bundled_cache(const Surroundings& machine);

}  // namespace caplet::doctor
