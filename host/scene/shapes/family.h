// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The functions that each geometry defines in shapes/NAME.h, and helpers for them. For every row of
// geometries.def there are
//
//   std::size_t count_of(const Type&)                       the number of primitives
//   std::size_t surfaces_of(const Type&)                    the number of material slots
//   bool closed(const Type&)                                whether it has an inside, so that csg
//   can combine it Bounds bounds_under(const Type&, const dmat4& m)        exact bounds of its
//   image void check(const Type&, ShapeCheck&)                    reports what cannot be rendered
//   Beyond beyond(const Type&, const dvec3& p)              how far p is outside; `unknown` for
//   open geometries Type drawn(std::type_identity<Type>, Draws&)            a random one, for hard
//   scenes; csg has it in
//                                                           verify/torture.cpp, which draws the
//                                                           operands
//
// which are found by type: a missing one is a compile error. Lengths and points are in the shape's
// own space.
//
// A convex solid may be defined by its surfaces, each of which bounds it by a convex function
// (FacedSolid). It needs no `beyond`, and its reference and the rays that test devices follow from
// these functions:
//
//   double outside(const Type&, int surface, const dvec3& p)    grows no faster than distance; in
//   the solid all are
//                                                               at most 0
//   dvec3 normal_on(const Type&, int surface, const dvec3& p)   the unit outward normal at a point
//   of the surface dvec2 uv_on(const Type&, int surface, const dvec3& p)       docs/shapes.md
//   double tilt_of(const Type&, double moved)                   radians by which its surfaces turn
//   when its points move by `moved`
//
// A geometry of a few numbers may name them as fields (FieldedShape), and then needs no reader of
// its own:
//
//   void fields(Type&, auto& each)                          each.corners("p0", "p1", box.p0,
//   box.p1), ...: see Fields
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <type_traits>

#include "scene/bounds.h"

namespace caplet {

struct Shape;

inline constexpr double full_turn = 6.283185307179586;
/// The greatest coordinate or size in a scene: squares of 1e18, and sums of some, fit a 32-bit
/// float (3.4e38).
inline constexpr double largest_length = 1e18;

/// Bounds how far a point is outside a solid: `least` is a lower bound of the distance; `most` is
/// at most 0 only inside.
struct Beyond {
  double least, most;
  static Beyond exactly(double distance) { return {distance, distance}; }
};
inline constexpr Beyond unknown{-INFINITY, INFINITY};

template <class Vector>
bool is_finite(const Vector& v) {
  for (glm::length_t i = 0; i < v.length(); ++i)
    if (!std::isfinite(v[i])) return false;
  return true;
}

/// Receives the errors that a geometry finds in itself.
class ShapeCheck {
 public:
  virtual ~ShapeCheck() = default;
  virtual void error(const std::string& message) = 0;
  /// Reports an error of a field or parameter: `message` continues after its name.
  virtual void error(std::string_view field, const std::string& message) = 0;
  /// Returns the number of materials.
  virtual std::size_t materials() const = 0;
  /// Checks an operand as a shape of its own.
  virtual void operand(const Shape& shape) = 0;

  /// The value must also be positive as a 32-bit float.
  void positive(double value, const char* what) {
    if (!(static_cast<float>(value) > 0 && std::isfinite(value)))
      error(std::string(what) + " must be positive and finite");
  }
};

/// Draws random numbers for random geometries, whose sizes are about 1, and for thin ones down to
/// 1e-4.
class Draws {
 public:
  virtual ~Draws() = default;
  virtual double uniform(double low, double high) = 0;
  virtual double power(double low, double high) = 0;  // 10 to the power of a uniform number
  virtual std::size_t below(std::size_t n) = 0;
  virtual glm::dvec3 direction() = 0;

  bool one_in(std::size_t n) { return below(n) == 0; }
  /// Returns a number from 0.1 to 1, or in half of the cases from 1e-4 to 1.
  double thin() { return one_in(2) ? uniform(0.1, 1) : power(-4, 0); }
  glm::vec3 point() { return glm::vec3(direction()); }

  double size = 1, angle = 1;  // drawn for every geometry: 0.2 to 1, and 0.5 to 6.2 radians
  int sort = 0;                // below drawn_sorts
};
/// The number of variants of a geometry that are drawn.
template <class Type>
inline constexpr int drawn_sorts = 1;

template <class Type>
concept FacedSolid = requires(const Type& solid, int surface, const glm::dvec3& p) {
  { outside(solid, surface, p) } -> std::same_as<double>;
};

/// The visitor that `fields` is called with.
struct Fields {
  virtual ~Fields() = default;
  /// Visits two opposite corners of a box, in any order; they are returned in ascending order.
  virtual void corners(const char* name0, const char* name1, glm::dvec3& p0, glm::dvec3& p1) = 0;
  /// Visits a positive length; `value` holds its default.
  virtual void positive(const char* name, double& value) = 0;
};
template <class Type>
concept FieldedShape = requires(Type& shape, Fields& each) {
  fields(shape, each);
};

/// Returns the greatest `outside` over all surfaces.
template <FacedSolid Type>
Beyond beyond(const Type& solid, const glm::dvec3& p) {
  double most = -INFINITY;
  for (std::size_t i = 0; i < surfaces_of(solid); ++i)
    most = std::max(most, outside(solid, static_cast<int>(i), p));
  return Beyond::exactly(most);
}

// --- For bounds ---

inline glm::dvec3 transformed(const glm::dmat4& m, const glm::dvec3& p) {
  return glm::dvec3(m * glm::dvec4(p, 1));
}

/// Returns half the extents of the unit ball's image under `a`: the lengths of its rows.
inline glm::dvec3 row_lengths(const glm::dmat3& a) {
  const glm::dmat3 rows = glm::transpose(a);
  return {glm::length(rows[0]), glm::length(rows[1]), glm::length(rows[2])};
}

inline void extend_box(Bounds& bounds, const glm::dvec3& center, const glm::dvec3& half) {
  bounds.extend(center - half);
  bounds.extend(center + half);
}

/// Computes bounds from the greatest value of a.p over the points p of a shape, for each row a of
/// the matrix and its negative.
template <class Greatest>
Bounds bounds_along_rows(const glm::dmat4& m, Greatest greatest) {
  Bounds bounds;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 row(m[0][k], m[1][k], m[2][k]);
    bounds.min[k] = m[3][k] - greatest(-row);
    bounds.max[k] = m[3][k] + greatest(row);
  }
  return bounds;
}

/// Returns the greatest value of a.x cos(phi) + a.y sin(phi) for 0 <= phi <= phi_max.
inline double greatest_across(const glm::dvec3& a, double phi_max) {
  const double summit = std::atan2(a.y, a.x);
  if (phi_max >= full_turn || (summit < 0 ? summit + full_turn : summit) <= phi_max)
    return std::hypot(a.x, a.y);
  return std::max(a.x, a.x * std::cos(phi_max) + a.y * std::sin(phi_max));
}

}  // namespace caplet
