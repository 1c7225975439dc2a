// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts half-spaces to faces: a box that contains the whole solid is cut by one plane after the
// other.
#include "scene/shapes/polyhedron.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

namespace caplet {

namespace {

using glm::dvec3;

constexpr std::size_t box_side = std::numeric_limits<std::size_t>::max();

struct Plane {
  dvec3 normal;   // unit, outward
  double offset;  // normal . x <= offset inside
};

struct Face {
  std::size_t plane;  // box_side: a face of the initial box
  std::vector<dvec3> corners;
};

bool same_point(const dvec3& a, const dvec3& b, double tolerance) {
  return glm::length(a - b) <= tolerance;
}

/// A convex body, stored as its faces.
class Body {
 public:
  /// Starts with a cube of half size `half` around the origin.
  explicit Body(double half) : tolerance_(half * 0x1p-46) {
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-half, half}) {
        Face face{box_side, {}};
        for (int i = 0; i < 4; ++i) {
          dvec3 x;
          x[axis] = side;
          x[(axis + 1) % 3] = i == 0 || i == 3 ? -half : half;
          x[(axis + 2) % 3] = i < 2 ? -half : half;
          face.corners.push_back(x);
        }
        faces_.push_back(face);
      }
  }

  /// Keeps the part below the plane. Returns false when nothing is left, or, up to rounding, only
  /// points in the plane.
  bool cut(const Plane& plane, std::size_t number) {
    // Coordinates are within `half`, rounded to 2^-53 of it; a few operations on them are within
    // 2^-46.
    const auto above = [&](const dvec3& x) { return glm::dot(plane.normal, x) - plane.offset; };
    double highest = -HUGE_VAL, lowest = HUGE_VAL;
    for (const Face& face : faces_)
      for (const dvec3& x : face.corners) {
        highest = std::max(highest, above(x));
        lowest = std::min(lowest, above(x));
      }
    if (!(lowest < -tolerance_)) return false;
    if (highest <= tolerance_) return true;
    std::vector<dvec3> rim;
    bool repeated = false;
    for (Face& face : faces_) {
      std::vector<dvec3> kept;
      std::size_t in_plane = 0;
      for (std::size_t i = 0; i < face.corners.size(); ++i) {
        const dvec3 &a = face.corners[i], &b = face.corners[(i + 1) % face.corners.size()];
        const double above_a = above(a), above_b = above(b);
        if (above_a <= tolerance_) {
          kept.push_back(a);
          if (above_a >= -tolerance_) {
            rim.push_back(a);
            ++in_plane;
          }
        }
        if ((above_a > tolerance_ && above_b < -tolerance_) ||
            (above_a < -tolerance_ && above_b > tolerance_)) {
          const dvec3 x = a + (above_a / (above_a - above_b)) * (b - a);
          kept.push_back(x);
          rim.push_back(x);
        }
      }
      repeated |= in_plane >= 3 && in_plane == face.corners.size();
      face.corners = std::move(kept);
    }
    std::erase_if(faces_, [](const Face& face) { return face.corners.size() < 3; });
    if (!repeated) close(plane, number, rim);
    return true;
  }

  std::vector<Face> faces_;

 private:
  /// Adds the new face: the corners in its plane, in order.
  void close(const Plane& plane, std::size_t number, std::vector<dvec3>& rim) {
    const dvec3 center =
        std::accumulate(rim.begin(), rim.end(), dvec3(0)) / std::max(1.0, double(rim.size()));
    const dvec3 s = glm::normalize(
        glm::cross(plane.normal, std::abs(plane.normal.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    const dvec3 t = glm::cross(plane.normal, s);
    std::vector<std::pair<double, dvec3>> around;
    around.reserve(rim.size());
    for (const dvec3& x : rim)
      around.emplace_back(std::atan2(glm::dot(x - center, t), glm::dot(x - center, s)), x);
    std::ranges::sort(around, {}, &std::pair<double, dvec3>::first);
    Face face{number, {}};
    for (const auto& [angle, x] : around)
      if (face.corners.empty() || !same_point(face.corners.back(), x, 4 * tolerance_))
        face.corners.push_back(x);
    while (face.corners.size() > 1 &&
           same_point(face.corners.front(), face.corners.back(), 4 * tolerance_))
      face.corners.pop_back();
    if (face.corners.size() >= 3) faces_.push_back(face);
  }

  double tolerance_;
};

}  // namespace

std::vector<std::vector<dvec3>> polyhedron_faces(const PolyhedronShape& polyhedron,
                                                 std::size_t* bad_plane) {
  const std::size_t n = polyhedron.points.size();
  const auto blame = [&](std::size_t plane) {
    if (bad_plane) *bad_plane = plane;
    return std::vector<std::vector<dvec3>>{};
  };
  if (n == 0) return blame(0);
  dvec3 center = polyhedron.points[0];
  double size = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double length = glm::length(polyhedron.normals[i]);
    if (!(length > 0 && length < HUGE_VAL && std::isfinite(glm::length(polyhedron.points[i]))))
      return blame(i);
    size = std::max(size, glm::length(polyhedron.points[i] - center));
  }
  if (size == 0) size = 1;  // all planes through one point: a cone or nothing

  // The second pass starts from a box that fits, because rounding errors grow with the box that is
  // cut.
  double half = 1e6 * size;
  for (int pass = 0; pass < 2; ++pass) {
    Body body(half);
    for (std::size_t i = 0; i < n; ++i) {
      const dvec3 normal = glm::normalize(polyhedron.normals[i]);
      if (!body.cut({normal, glm::dot(normal, polyhedron.points[i] - center)}, i)) return blame(i);
    }
    Bounds bounds;
    bool endless = false;
    std::size_t first_endless = 0;
    std::vector<std::vector<dvec3>> faces(n);
    for (const Face& face : body.faces_) {
      endless |= face.plane == box_side;
      for (const dvec3& x : face.corners) bounds.extend(x);
      if (face.plane == box_side) continue;
      for (const dvec3& x : face.corners) faces[face.plane].push_back(center + x);
    }
    if (endless) {
      // An unbounded face reaches the box.
      while (first_endless + 1 < n &&
             std::ranges::none_of(faces[first_endless], [&](const dvec3& x) {
               const dvec3 a = glm::abs(x - center);
               return std::max({a.x, a.y, a.z}) >= half * (1 - 1e-9);
             }))
        ++first_endless;
      return blame(first_endless);
    }
    if (pass == 1) return faces;
    center += 0.5 * (bounds.min + bounds.max);
    half = glm::length(bounds.max - bounds.min);
  }
  return {};
}

std::vector<dvec3> polyhedron_corners(const PolyhedronShape& polyhedron, std::size_t* bad_plane) {
  const std::vector<std::vector<dvec3>> faces = polyhedron_faces(polyhedron, bad_plane);
  Bounds bounds;
  for (const auto& face : faces)
    for (const dvec3& x : face) bounds.extend(x);
  // Each face has its own copy of a corner. Copies differ by rounding, and more so where faces meet
  // at small angles.
  const double tolerance = 1e-9 * glm::length(bounds.max - bounds.min);
  std::vector<dvec3> corners;
  for (const auto& face : faces)
    for (const dvec3& x : face)
      if (std::ranges::none_of(corners,
                               [&](const dvec3& y) { return same_point(x, y, tolerance); }))
        corners.push_back(x);
  return corners;
}

Bounds bounds_under(const PolyhedronShape& polyhedron, const glm::dmat4& m) {
  Bounds bounds;
  for (const dvec3& corner : polyhedron_corners(polyhedron)) bounds.extend(transformed(m, corner));
  return bounds;
}

void check(const PolyhedronShape& polyhedron, ShapeCheck& report) {
  const std::size_t planes = polyhedron.points.size();
  if (polyhedron.normals.size() != planes)
    return report.error("the polyhedron has another number of normals than of points");
  if (planes == 0) return report.error("the polyhedron has no planes");
  if (planes > max_polyhedron_planes)
    return report.error("the polyhedron has " + std::to_string(planes) + " planes, more than " +
                        std::to_string(max_polyhedron_planes));
  double reach = 0;  // greatest distance of a point from the first
  for (std::size_t i = 0; i < planes; ++i) {
    const auto plane = [i] { return "plane " + std::to_string(i) + " of the polyhedron "; };
    if (!is_finite(polyhedron.points[i]) || !is_finite(polyhedron.normals[i]))
      return report.error(plane() + "is not finite");
    if (!(glm::length(polyhedron.normals[i]) > 0))
      return report.error(plane() + "has no normal: it is zero");
    reach = std::max(reach, glm::length(polyhedron.points[i] - polyhedron.points[0]));
  }
  std::size_t bad = 0;
  if (!polyhedron_corners(polyhedron, &bad).empty()) return;
  // Cut by a distant box, an unbounded polyhedron has corners; one without an inside still has
  // none.
  PolyhedronShape boxed = polyhedron;
  for (int side = 0; side < 6; ++side) {
    dvec3 n(0);
    n[side / 2] = side % 2 ? 1 : -1;
    boxed.points.push_back(polyhedron.points[0] + (reach > 0 ? 1e3 * reach : 1) * n);
    boxed.normals.push_back(n);
  }
  const bool unbounded = !polyhedron_corners(boxed).empty();
  report.error(std::string("the polyhedron ") + (unbounded ? "has no bounds" : "has no inside") +
               ": look at plane " + std::to_string(bad) + " (counted from 0)");
}

Beyond beyond(const PolyhedronShape& polyhedron, const dvec3& p) {
  double most = -INFINITY;
  for (std::size_t i = 0; i < polyhedron.points.size(); ++i)
    most =
        std::max(most, glm::dot(glm::normalize(polyhedron.normals[i]), p - polyhedron.points[i]));
  return Beyond::exactly(most);
}

PolyhedronShape drawn(std::type_identity<PolyhedronShape>, Draws& draws) {
  const double r = draws.size;
  return PolyhedronShape{
      {dvec3(-r), dvec3(-r), dvec3(-r), dvec3(0.3 * r), dvec3(0, 0, 0.5 * r)},
      {{-1, 0, 0}, {0, -2, 0}, {0, 0, -1}, {1, 1, 1}, {0.1, 0.2, draws.uniform(0.5, 3)}}};
}

}  // namespace caplet
