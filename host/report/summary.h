// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What `info` and `--stats` tell about a scene and a run.
#pragma once

#include <nlohmann/json.hpp>

#include "device/device.h"
#include "lower/flat_scene.h"
#include "render/render.h"
#include "scene/scene.h"

namespace caplet::report {

/// Bytes of the scene model's arrays (images shared between lights counted once).
std::uint64_t model_bytes(const Scene& scene);
/// Number of light sources: emissive primitives (instances expanded) and the other lights.
std::uint64_t light_count(const FlatScene& flat);
/// The most memory the process ever held, in bytes.
std::uint64_t peak_process_bytes();

/// primitives, bounds, materials, lights, bytes, bvh (docs/cli.md).
nlohmann::ordered_json scene_summary(const Scene& scene, const FlatScene& flat);

struct RunSeconds {
  double load = 0, build = 0, compile = 0, render = 0, write = 0, total = 0;
};

/// seconds, samples_per_pixel, rays, device, peak_bytes and more (docs/cli.md).
nlohmann::ordered_json run_summary(const RunSeconds& seconds, const RenderResult& result);

/// Text of a JSON value for people's terminals and files; bytes that are no UTF-8 are replaced.
std::string to_text(const nlohmann::ordered_json& json);

}  // namespace caplet::report
