// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Random csg shapes and rays, and what a device's hit list says checked against the reference's
// values along the ray.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "list_tracer.h"
#include "reference/primitive.h"
#include "scene/scene.h"

namespace caplet::test {

using Operation = CsgShape::Operation;

/// A closed solid or csg shape of the model, as an operand.
std::shared_ptr<const Shape> operand(decltype(Shape::geometry) geometry,
                                     const glm::dmat4& placed = glm::dmat4(1));
Shape csg_shape(Operation operation, std::vector<std::shared_ptr<const Shape>> operands,
                const glm::dmat4& placed = glm::dmat4(1));

/// The reference of a closed shape, its transform included.
reference::Primitive reference_of_shape(const Shape& shape);
/// A shape's solids with their transforms, in the order of their surfaces.
struct PlacedSolid {
  const Shape* shape;
  glm::dmat4 world_from_solid;
};
std::vector<PlacedSolid> solids_of(const Shape& shape, const glm::dmat4& parent = glm::dmat4(1));

/// One scene of one shape; of an empty one with a grain of sand far away, for a scene has to hold
/// something.
FlatScene flat_scene(const Shape& shape);
FlatScene flat_scene(std::vector<Shape> shapes);

class CsgMaker {
 public:
  explicit CsgMaker(std::uint32_t seed) : random_(seed) {}
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  glm::dvec3 direction();
  glm::dvec3 point(double reach) {
    return reach * glm::dvec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
  }
  /// Turned and moved; `affine`: also scaled by 0.5 to 2 along each axis, every other one mirrored.
  glm::dmat4 placement(double reach, bool affine);
  /// A solid of any kind, of size about 1 around the origin.
  std::shared_ptr<const Shape> solid(bool affine);
  /// Nested `depth` deep, at most `most` solids.
  std::shared_ptr<const Shape> csg(int depth, int most, bool affine);
  /// Rays from inside, outside, far away, along the axes and through the region where the solids
  /// meet.
  std::vector<RayRecord> rays(const Shape& shape, int count);

 private:
  std::mt19937 random_;
};

/// Bound on how far a shape's surfaces may be displaced in the device's answer for rays from an
/// origin (docs/numerics.md, "CSG"), world.
class CsgBound {
 public:
  explicit CsgBound(const Shape& shape);
  double operator()(const glm::dvec3& origin) const;

 private:
  glm::dvec3 center_;
  double fixed_;
};

/// What is wrong with the list of one ray, empty if nothing: crossings must be in order, enter and
/// leave in turn, lie on the named surface, and between them the reference's value must have the
/// right sign wherever it is further from 0 than the bound; the surface points must lie on the
/// shape with normals that point out of it.
std::string csg_disagreement(const Shape& shape, const reference::Primitive& reference,
                             const CsgBound& allowed, const RayRecord& ray, const RayList& list);

}  // namespace caplet::test
