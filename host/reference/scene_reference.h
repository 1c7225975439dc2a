// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// SceneReference is the reference implementation of a whole scene. It tests every ray against every
// primitive, without a tree: primitives are only skipped in groups whose common ball the ray
// misses. Primitives stay in their object space; rays are transformed there by matrices inverted in
// double, not normalised, so that t is the same in all spaces.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "reference/solver.h"
#include "scene/scene.h"

namespace caplet::reference {

struct SceneHit {
  double t = 0;
  bool leaving = false;
  std::uint32_t instance = 0;   // index into Scene::instances; no_instance: a shape of the world
  std::uint32_t object = 0;     // index into Scene::objects; meaningless for shapes of the world
  std::uint32_t shape = 0;      // index into Scene::shapes, or the object's shapes
  std::uint32_t primitive = 0;  // capsule or triangle within the shape
  std::uint32_t surface = 0;    // of the shape
  std::uint32_t material = 0;   // of that surface, index into Scene::materials
  double surface_margin = 0;    // of solids: as Crossing's, in the shape's space
  std::size_t index = 0;        // of the primitive among all, instances expanded
};
inline constexpr std::uint32_t no_instance = 0xffffffffu;

class SceneReference {
 public:
  explicit SceneReference(const Scene& scene);
  /// Returns the nearest hit with t_min < t < t_max over all primitives; the first in scene order
  /// among equals.
  std::optional<SceneHit> closest(const Ray& ray) const;
  /// Returns every crossing with t_min < t < t_max in order; at the same t those that leave come
  /// first, then the first in scene order. There are no more than `limit`.
  std::vector<SceneHit> all(const Ray& ray,
                            std::size_t limit = std::numeric_limits<std::size_t>::max()) const;
  /// Does the same, and returns the indices of all primitives whose balls the line goes through.
  std::vector<SceneHit> all(const Ray& ray, std::vector<std::uint32_t>& near) const;
  /// Returns the unit normal in the world at a point on (or within 1e-7 of its size from) the
  /// primitive of a hit: outward of solids, by winding or as given of open shapes, turned by
  /// ReverseOrientation. It uses differences of the implicit function over 1e-6 of the primitive's
  /// size, so it has no meaning that close to an edge.
  glm::dvec3 normal(const SceneHit& hit, const glm::dvec3& point) const;
  /// Returns (u, v) at a point of the world on (or next to) the surface of a hit of a ray in this
  /// direction: uv_at of the point in the primitive's own space, interpolated in the uvs of meshes
  /// that have some.
  glm::dvec2 uv(const SceneHit& hit, const glm::dvec3& point, const glm::dvec3& direction) const;
  /// Does closest() for many rays, in parallel.
  std::vector<std::optional<SceneHit>> closest(std::span<const Ray> rays) const;
  std::size_t size() const { return placed_.size(); }

  /// PlacedPrimitive is a primitive of the scene, instances expanded. References last as long as
  /// the reference.
  struct PlacedPrimitive {
    const Primitive& primitive;
    const Ball& ball;  // object space
    const glm::dmat4& object_from_world;
    const SceneHit& identity;  // instance, object, shape, primitive, index
  };
  PlacedPrimitive placed(std::size_t index) const;
  /// Returns the material of a primitive's surface: an index into Scene::materials.
  std::uint32_t material(std::size_t index, std::uint32_t surface) const;
  bool is_reversed(std::size_t index) const {
    return placed_.at(index).reversed;
  }  // by ReverseOrientation
  /// Returns the primitive's index from the numbers of SceneHit; none when there is no such
  /// primitive.
  std::optional<std::size_t> index_of(std::uint32_t instance, std::uint32_t shape,
                                      std::uint32_t primitive) const;

 private:
  struct Placed {
    Primitive primitive;
    Ball ball;  // of the primitive, object space
    SceneHit identity;
    std::uint32_t space;  // index into object_from_world_ and surface_materials_
    bool sees_entering = true, sees_leaving = true, reversed = false;
    bool turned = false;  // a mesh's face whose normals are against its winding
    bool leaves(const Crossing& crossing) const { return crossing.leaving != turned; }
    bool sees(const Crossing& crossing) const {
      return leaves(crossing) ? sees_leaving : sees_entering;
    }
  };
  struct Group {
    Ball ball;                 // of its primitives' balls, world space
    std::uint32_t begin, end;  // in grouped_
  };
  template <class Visit>
  void visit_touched(const Ray& ray, const Visit& visit) const;
  void add(const Shape& shape, const glm::dmat4& world_from_shape, const SceneHit& identity);
  void group(std::uint32_t begin, std::uint32_t end, const glm::dmat4& world_from_shape);
  std::vector<Placed> placed_;
  std::vector<std::uint32_t> grouped_;  // indices into placed_
  std::vector<Group> groups_;
  std::vector<std::size_t> shape_begin_;  // first primitive of each shape of the world
  std::vector<std::vector<std::size_t>> instance_begin_;  // and of each shape of each instance
  std::vector<glm::dmat4> object_from_world_;
  std::vector<std::vector<std::uint32_t>> surface_materials_;  // empty: the same on all
  std::vector<std::vector<std::array<glm::dvec2, 4>>>
      corner_uvs_;  // by space and primitive; empty: the mesh has none
};

}  // namespace caplet::reference
