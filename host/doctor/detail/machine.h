// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Checks of the machine without OpenCL: GPU nodes and their permissions, memory, cache folders.
#pragma once

#include <filesystem>

#include "doctor/platforms.h"
#include "doctor/registry.h"

namespace caplet::doctor {

/// Returns whether the kernel module of NVIDIA's driver is loaded.
bool has_nvidia(const Surroundings& machine);

/// Reports GPU nodes in /dev that this user may not open.
Findings check_permissions(const Surroundings& machine);

/// Reports an NVIDIA GPU without a registered OpenCL driver. `loadable`: libnvidia-opencl.so.1 can
/// be loaded.
Findings check_nvidia(const Surroundings& machine, const Registry& registry, const Loader& loader,
                      bool loadable);

/// Reports a GPU node of AMD or Intel where no platform offers a GPU.
Findings check_unused_gpus(const Surroundings& machine,
                           const std::vector<PlatformFacts>& platforms);

/// Reports the free memory of the host, within the limits of its control group, and the address
/// space (ulimit -v).
Findings check_memory(const Surroundings& machine);

/// Reports the place and size of Caplet's cache, and whether it is writable.
Findings check_cache(const Surroundings& machine, const std::filesystem::path& folder);

/// Tells of OpenCL layers, which stand between programs and drivers.
Findings check_layers(const Surroundings& machine);
/// Reports a missing /sys, as in some containers, without which PoCL ends the process.
Findings check_sys(const Surroundings& machine);

/// Reports PoCL's cache: $POCL_CACHE_DIR, else $XDG_CACHE_HOME/pocl/kcache, else
/// $HOME/.cache/pocl/kcache, else in /tmp.
Findings check_pocl_cache(const Surroundings& machine);
/// Reports the cache of the driver that came with this program.
Findings check_bundled_cache(const Surroundings& machine);

}  // namespace caplet::doctor
