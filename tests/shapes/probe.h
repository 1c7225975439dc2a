// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Runs the shape kernels on a device: every primitive has its own tree, every ray names the one it is for.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "device/device.h"
#include "lower/encode.h"
#include "reference/primitive.h"
#include "reference/solver.h"
#include "shared/records.h"

namespace caplet::test {

/// A primitive as the device gets it. The witness is made from the same bits.
reference::Primitive witness_of(const FlatPrimitive& primitive);
FlatPrimitive make_sphere(std::array<float, 3> c, float r);
FlatPrimitive make_capsule(std::array<float, 3> p0, std::array<float, 3> p1, float r);
FlatPrimitive make_tapered(std::array<float, 3> p0, std::array<float, 3> p1, float r0, float r1);
FlatPrimitive make_triangle(std::array<float, 3> v0, std::array<float, 3> v1, std::array<float, 3> v2);
FlatPrimitive make_disk(std::array<float, 3> c, std::array<float, 3> n, float r);

/// `surface` on the device, as the probe kernel writes it.
struct SurfaceOut {
  float p[3], error, ng[3], u, ns[3], v, dpdu[3], pad;
  std::uint32_t geometry, primitive, surface, light, leaving, any, pad0, pad1;
};
static_assert(sizeof(SurfaceOut) == 96);

struct Probed {
  HitRecord hit;
  SurfaceOut surface;  // when hit.slot is not CAPLET_NONE
  bool any;
};
struct Left {
  float origin[3];
  HitRecord hit;
};

/// One primitive a tree, placed by an instance where `object_from_world` and its inverse are given.
struct PlacedPrimitive {
  FlatPrimitive primitive{};
  bool placed = false;
  std::array<float, 12> object_from_world{}, world_from_object{};
};

class Probe {
 public:
  /// `width`: 8 or 1, CAPLET_REAL_WIDTH.
  Probe(const Device& device, int width, const std::vector<PlacedPrimitive>& primitives);
  Probe(const Device& device, int width, const std::vector<FlatPrimitive>& primitives);
  /// which[i]: the primitive of ray i.
  std::vector<Probed> trace(const std::vector<std::uint32_t>& which, const std::vector<RayRecord>& rays) const;
  /// Leaves each surface towards a direction and traces on.
  std::vector<Left> leave(const std::vector<std::uint32_t>& which, const std::vector<Probed>& from,
                          const std::vector<std::array<float, 3>>& directions) const;
  /// Box of primitive i's tree.
  const EncodedTree& tree(std::size_t i) const { return trees_[i]; }
  std::uint32_t flags = 0;      // GeometryRecord.flags of all
  std::vector<float> mesh_uvs;  // two a vertex, vertices 3 i .. 3 i + 2 of primitive i; set before the first call of trace

 private:
  Device device_;
  cl::Kernel trace_, leave_;
  std::vector<EncodedTree> trees_;
  std::vector<float> nodes_, leaves_;
  std::vector<InstanceRecord> instances_;
  std::vector<GeometryRecord> geometries_;
  std::vector<std::uint32_t> primitive_geometry_, mesh_indices_;
  std::vector<std::uint32_t> roots_;
};

RayRecord make_ray(const glm::dvec3& origin, const glm::dvec3& direction);
reference::Ray witness_ray(const RayRecord& ray);

}  // namespace caplet::test
