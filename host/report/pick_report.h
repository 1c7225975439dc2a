// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reports of `pick` on one ray, for people and for programs (docs/pick.md).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "shared/records.h"

namespace caplet::report {

/// A crossing found by the reference (host/reference).
struct ReferenceCrossing {
  double t = 0;
  std::string name;          // the shape's name
  std::uint32_t object = 0;  // number in the object-id layer
  std::uint32_t primitive = 0, surface = 0, material = 0;
  bool entering = false;
  glm::dvec3 point{0};
};

struct PickReport {
  std::optional<std::array<int, 2>> pixel;
  RayRecord ray{};
  std::string device;
  bool all = false;                   // all crossings were requested, not only the nearest
  std::vector<PickRecord> crossings;  // in order
  std::optional<std::vector<ReferenceCrossing>> reference;
};

/// Returns the reference's crossings of the same ray, in the device's floats. Time and memory grow
/// with the primitives of the scene.
std::vector<ReferenceCrossing> reference_crossings(const Scene& scene, const RayRecord& ray,
                                                   bool all);

std::string plain_text(const PickReport& report, const Scene& scene);
std::string json_text(const PickReport& report, const Scene& scene);

}  // namespace caplet::report
