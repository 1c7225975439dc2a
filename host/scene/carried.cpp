// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/carried.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "scene/frozen.h"

namespace caplet {

namespace {

using glm::dvec3;

Scene at(const Scene& scene, double time) {
  const FilmSettings& film = scene.view.film;
  return frozen_at(scene,
                   std::clamp(time, film.shutter_open, film.shutter_open + film.open_time()));
}

dvec3 transformed_by(const glm::dmat4& m, const dvec3& p) { return dvec3(m * glm::dvec4(p, 1)); }

const Shape& shape_of(const Scene& scene, const SurfacePlace& place) {
  return place.instance ? scene.objects[scene.instances[*place.instance].object].shapes[place.shape]
                        : scene.shapes[place.shape];
}

glm::dmat4 world_from(const Scene& scene, const SurfacePlace& place) {
  const glm::dmat4& own = shape_of(scene, place).world_from_object;
  return place.instance ? scene.instances[*place.instance].world_from_object * own : own;
}

/// Turns `v` as the smallest rotation does that takes the direction of `a` to that of `b`
/// (Rodrigues). Opposite directions turn about any axis across them.
dvec3 turned(const dvec3& v, const dvec3& a, const dvec3& b) {
  if (!(glm::length(a) > 0 && glm::length(b) > 0)) return v;
  const dvec3 from = glm::normalize(a), to = glm::normalize(b), axis = glm::cross(from, to);
  const double cosine = glm::dot(from, to), sine = glm::length(axis);
  if (sine < 1e-12) {
    if (cosine > 0) return v;
    const dvec3 other = std::abs(from.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 about = glm::normalize(glm::cross(from, other));
    return 2 * glm::dot(about, v) * about - v;
  }
  const dvec3 about = axis / sine;
  return cosine * v + sine * glm::cross(about, v) + (1 - cosine) * glm::dot(about, v) * about;
}

dvec3 carried_by(const CapsulesShape& before, const CapsulesShape& after, std::size_t i,
                 const dvec3& p) {
  const auto radius = [i](const CapsulesShape& of, double share) {
    const double r0 = static_cast<double>(of.radius0[i]),
                 r1 = of.radius1.empty() ? r0 : static_cast<double>(of.radius1[i]);
    return r0 + share * (r1 - r0);
  };
  const dvec3 a(before.p0[i]), axis = dvec3(before.p1[i]) - a;
  const dvec3 b(after.p0[i]), new_axis = dvec3(after.p1[i]) - b;
  const double length2 = glm::dot(axis, axis);
  const double share = length2 > 0 ? std::clamp(glm::dot(p - a, axis) / length2, 0.0, 1.0) : 0;
  const double r = radius(before, share), grows = r > 0 ? radius(after, share) / r : 1;
  return b + share * new_axis + grows * turned(p - a - share * axis, axis, new_axis);
}

dvec3 carried_by(const TriangleMeshShape& before, const TriangleMeshShape& after, std::size_t i,
                 const dvec3& p) {
  const auto corner = [i](const TriangleMeshShape& of, std::size_t k) {
    return dvec3(of.positions[of.triangles[i][k]]);
  };
  const dvec3 v0 = corner(before, 0), e1 = corner(before, 1) - v0, e2 = corner(before, 2) - v0;
  const dvec3 n = glm::cross(e1, e2);
  const double n2 = glm::dot(n, n);
  const double u = n2 > 0 ? glm::dot(glm::cross(p - v0, e2), n) / n2 : 0,
               v = n2 > 0 ? glm::dot(glm::cross(e1, p - v0), n) / n2 : 0;
  return (1 - u - v) * corner(after, 0) + u * corner(after, 1) + v * corner(after, 2);
}

}  // namespace

Carrier::Carrier(const Scene& scene, double from, double to)
    : before_(at(scene, from)), after_(at(scene, to)) {}

dvec3 Carrier::carried(const SurfacePlace& place, const dvec3& point) const {
  dvec3 p = transformed_by(glm::inverse(world_from(before_, place)), point);
  const Geometry &before = shape_of(before_, place).geometry,
                 &after = shape_of(after_, place).geometry;
  if (const auto* capsules = std::get_if<CapsulesShape>(&before))
    p = carried_by(*capsules, std::get<CapsulesShape>(after), place.primitive, p);
  else if (const auto* mesh = std::get_if<TriangleMeshShape>(&before))
    p = carried_by(*mesh, std::get<TriangleMeshShape>(after), place.primitive, p);
  return transformed_by(world_from(after_, place), p);
}

}  // namespace caplet
