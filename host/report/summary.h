// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Summaries of a scene and a run for `info` and `--stats`.
#pragma once

#include <nlohmann/json.hpp>

#include "device/device.h"
#include "lower/flat_scene.h"
#include "render/render.h"
#include "scene/scene.h"

namespace caplet::report {

/// Returns the bytes of the scene model's arrays (images shared between lights counted once).
std::uint64_t model_bytes(const Scene& scene);
/// Counts light sources: emissive primitives (instances expanded) and the other lights.
std::uint64_t light_count(const FlatScene& flat);
/// Returns the peak memory of the process in bytes.
std::uint64_t peak_process_bytes();

/// Returns primitives, bounds, materials, lights, bytes, bvh (docs/cli.md).
nlohmann::ordered_json scene_summary(const Scene& scene, const FlatScene& flat);
/// Replaces what a summary says of the lowered scene: lights, bytes on devices and the tree.
void tell_lowered(nlohmann::ordered_json& summary, const FlatScene& flat);

struct RunSeconds {
  double load = 0, build = 0, compile = 0, render = 0, denoise = 0, write = 0, total = 0;
};

/// Returns seconds, samples_per_pixel, rays, device, peak_bytes and more (docs/cli.md).
nlohmann::ordered_json run_summary(const RunSeconds& seconds, const RenderResult& result);

/// Returns a JSON value as text for terminals and files; invalid UTF-8 is replaced.
std::string to_text(const nlohmann::ordered_json& json);

}  // namespace caplet::report
