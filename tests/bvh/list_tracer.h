// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Hit lists of a lowered scene on a device, with the surface of each crossing and the nearest hit
// beside them.
#pragma once

#include <glm/vec3.hpp>
#include <map>
#include <span>
#include <vector>

#include "device/device.h"
#include "lower/lower.h"
#include "shared/records.h"
#include "support/rays.h"
#include "support/test_device.h"

namespace caplet::test {

/// `Surface` on the device, as the kernel writes it.
struct CrossingSurface {
  float p[3], error, ng[3];
  std::uint32_t material;
};
static_assert(sizeof(CrossingSurface) == 32);

struct RayList {
  HitRecord closest;  // of trace_closest
  bool any;           // of trace_any
  bool overflow;      // more than the capacity
  std::vector<HitRecord> hits;
  std::vector<CrossingSurface> surfaces;  // of each hit
};

bool is_leaving(const HitRecord& hit);
std::uint32_t surface_number(const HitRecord& hit);

class ListTracer {
 public:
  /// `width`: CAPLET_REAL_WIDTH, 8 or 1.
  ListTracer(const Device& device, int width);
  std::vector<RayList> trace(const FlatScene& scene, std::span<const RayRecord> rays,
                             std::uint32_t capacity) const;

 private:
  Device device_;
  int width_;
  mutable std::map<int, cl::Kernel> kernels_;  // by FlatScene::leaf_kind_bits
};

/// The one of the test program, on test_device(); compiled once a width.
const ListTracer& list_tracer(int width = test_width());

}  // namespace caplet::test
