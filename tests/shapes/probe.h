// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Runs the shape kernels on a device: every primitive has its own tree, every ray names the one it
// is for.
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
#include "support/rays.h"

namespace caplet::test {

/// A primitive as the device gets it. The reference is made from the same bits. `leaves`: where
/// polyhedra keep their planes. Not for csg shapes.
reference::Primitive reference_of(const FlatPrimitive& primitive,
                                  const std::vector<float>& leaves = {});
FlatPrimitive make_sphere(std::array<float, 3> c, float r);
FlatPrimitive make_capsule(std::array<float, 3> p0, std::array<float, 3> p1, float r);
FlatPrimitive make_tapered(std::array<float, 3> p0, std::array<float, 3> p1, float r0, float r1);
FlatPrimitive make_triangle(std::array<float, 3> v0, std::array<float, 3> v1,
                            std::array<float, 3> v2);
FlatPrimitive make_disk(std::array<float, 3> c, std::array<float, 3> n, float r);
/// Caps: CAPLET_CAP_...
FlatPrimitive make_cylinder(std::array<float, 3> p0, std::array<float, 3> p1, float r, float cap0,
                            float cap1);
FlatPrimitive make_cone(std::array<float, 3> p0, std::array<float, 3> p1, float r0, float r1,
                        float cap0, float cap1);
FlatPrimitive make_box(std::array<float, 3> min, std::array<float, 3> max);
FlatPrimitive make_partial_sphere(float r, float z_min, float z_max, float phi_max);
FlatPrimitive make_open_cylinder(float r, float z_min, float z_max, float phi_max);
FlatPrimitive make_partial_disk(float height, float r, float inner, float phi_max);
FlatPrimitive make_bilinear(std::array<float, 3> p00, std::array<float, 3> p10,
                            std::array<float, 3> p01, std::array<float, 3> p11);
/// How many values of `data` are lengths or coordinates (and must be scaled with the shape), from
/// the first on (a disk's normal lies among them). Polyhedra and csg shapes: none; their data lie
/// in `leaves`, and so do most of molecular patches.
int length_count(const FlatPrimitive& primitive);
/// How many of them are coordinates, three a point: they move with the shape.
int coordinate_count(const FlatPrimitive& primitive);

/// `surface` on the device, as the probe kernel writes it.
struct SurfaceOut {
  float p[3], error, ng[3], u, ns[3], v, dpdu[3], pad2, dpdv[3], pad3;
  std::uint32_t geometry, primitive, surface, light, leaving, any, pad0, pad1;
};
static_assert(sizeof(SurfaceOut) == 112);

struct Probed {
  HitRecord hit;
  SurfaceOut surface;  // when hit.slot is not CAPLET_NONE
  bool any;
};
struct Left {
  float origin[3];
  HitRecord hit;
};

/// The nearest hit, whether there is one, and all of them.
struct Listed {
  HitRecord nearest;
  bool any;
  std::uint32_t count;         // capacity + 1: there are more
  std::vector<HitRecord> all;  // in order, at most the capacity
};

/// One primitive a tree, placed by an instance where `object_from_world` and its inverse are given.
struct PlacedPrimitive {
  FlatPrimitive primitive{};
  bool placed = false;
  std::array<float, 12> object_from_world{}, world_from_object{};
};

class Probe {
 public:
  /// `width`: 8 or 1, CAPLET_REAL_WIDTH. `leaves`: what polyhedra and csg shapes keep there.
  Probe(const Device& device, int width, const std::vector<PlacedPrimitive>& primitives,
        const std::vector<float>& leaves = {});
  Probe(const Device& device, int width, const std::vector<FlatPrimitive>& primitives,
        const std::vector<float>& leaves = {});
  /// which[i]: the primitive of ray i.
  std::vector<Probed> trace(const std::vector<std::uint32_t>& which,
                            const std::vector<RayRecord>& rays) const;
  std::vector<Listed> list(const std::vector<std::uint32_t>& which,
                           const std::vector<RayRecord>& rays, std::uint32_t capacity) const;
  /// Leaves each surface towards a direction and traces on.
  std::vector<Left> leave(const std::vector<std::uint32_t>& which, const std::vector<Probed>& from,
                          const std::vector<std::array<float, 3>>& directions) const;
  /// Box of primitive i's tree.
  const EncodedTree& tree(std::size_t i) const { return trees_[i]; }
  std::uint32_t flags = 0;      // GeometryRecord.flags of all
  std::vector<float> mesh_uvs;  // two a vertex, vertices 4 i .. 4 i + 3 of primitive i; set before
                                // the first call of trace

 private:
  Device device_;
  int width_;
  cl::Kernel trace_, leave_, list_;
  std::vector<EncodedTree> trees_;
  std::vector<float> nodes_, leaves_;
  std::vector<InstanceRecord> instances_;
  std::vector<GeometryRecord> geometries_;
  std::vector<std::uint32_t> primitive_geometry_, mesh_indices_;
  std::vector<std::uint32_t> roots_;
};

reference::Ray reference_ray(const RayRecord& ray);

}  // namespace caplet::test
