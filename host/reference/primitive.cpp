// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Each function calls that of the shape's own file; functions that only some shapes have return a
// default here for the others.
#include "reference/primitive.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "reference/detail/parts.h"

namespace caplet::reference {

using glm::dvec3;

double distance_to_segment(const dvec3& x, const dvec3& a, const dvec3& b) {
  const dvec3 ab = b - a;
  const double squared = glm::dot(ab, ab);
  const double s = squared > 0 ? std::clamp(glm::dot(x - a, ab) / squared, 0.0, 1.0) : 0.0;
  return glm::length(x - (a + s * ab));
}

dvec3 any_perpendicular(const dvec3& n) {
  return glm::normalize(glm::cross(n, std::abs(n.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
}

dvec3 Curve::at(double s) const {
  if (kind == Kind::segment) return p + s * (q - p);
  const double a = from + s * (to - from);
  return p + radius * (std::cos(a) * q + std::sin(a) * r);
}

std::size_t kind_of(const Primitive& primitive) {
  return std::visit(
      [](const auto& shape) -> std::size_t {
        using Type = std::decay_t<decltype(shape)>;
        std::size_t kinds = 0;  // before the one in question
#define PRIMITIVE(Other)                           \
  if constexpr (std::is_same_v<Type, Other>) {     \
    if constexpr (requires { which_kind(shape); }) \
      return kinds + which_kind(shape);            \
    else                                           \
      return kinds;                                \
  }
#define KIND(name) ++kinds;
#include "reference/primitives.def"
        return kinds;
      },
      primitive);
}

bool is_solid(const Primitive& primitive) {
  return std::visit([](const auto& shape) { return has_inside(shape); }, primitive);
}

int surface_count(const Primitive& primitive) {
  return std::visit(
      [](const auto& shape) {
        if constexpr (requires { surfaces_of(shape); })
          return surfaces_of(shape);
        else
          return 1;
      },
      primitive);
}

double value(const Primitive& primitive, const dvec3& x) {
  return std::visit([&](const auto& shape) { return value_of(shape, x); }, primitive);
}

SurfaceAt surface_at(const Primitive& primitive, const dvec3& x) {
  return std::visit(
      [&](const auto& shape) -> SurfaceAt {
        if constexpr (requires { surface_of(shape, x); })
          return surface_of(shape, x);
        else
          return {0, HUGE_VAL};
      },
      primitive);
}

double distance_from_surface(const Primitive& primitive, const dvec3& x, int surface) {
  if (surface < 0 || surface >= surface_count(primitive)) return HUGE_VAL;
  return std::visit(
      [&](const auto& shape) {
        if constexpr (requires { distance_from(shape, x, surface); })
          return distance_from(shape, x, surface);
        else
          return std::abs(value_of(shape, x));
      },
      primitive);
}

Ball bounding_ball(const Primitive& primitive) {
  return std::visit([](const auto& shape) { return ball_of(shape); }, primitive);
}

namespace {

dvec3 gradient_of(const Primitive& carrier, const dvec3& x, double step) {
  dvec3 gradient{0};
  for (int i = 0; i < 3; ++i) {
    dvec3 e{0};
    e[i] = step;
    gradient[i] = value(carrier, x + e) - value(carrier, x - e);
  }
  return glm::normalize(gradient);
}

}  // namespace

dvec3 normal_at(const Primitive& primitive, const dvec3& x, double step) {
  return std::visit(
      [&](const auto& shape) {
        if constexpr (requires { sheet_normal(shape, x); })
          return sheet_normal(shape, x);
        else
          return gradient_of(carrier_of(primitive), x, step);
      },
      primitive);
}

dvec3 normal_of_surface(const Primitive& primitive, const dvec3& x, int surface, double step) {
  if (surface < 0 || surface >= surface_count(primitive)) return normal_at(primitive, x, step);
  return std::visit(
      [&](const auto& shape) {
        if constexpr (requires { normal_of(shape, x, surface); })
          return normal_of(shape, x, surface);
        else
          return normal_at(primitive, x, step);
      },
      primitive);
}

Primitive carrier_of(const Primitive& primitive) {
  return std::visit(
      [&](const auto& shape) -> Primitive {
        if constexpr (requires { carrier_from(shape); })
          return carrier_from(shape);
        else
          return primitive;
      },
      primitive);
}

bool keeps(const Primitive& primitive, const dvec3& x, int surface) {
  return std::visit(
      [&](const auto& shape) {
        if constexpr (requires { keeps_of(shape, x, surface); })
          return keeps_of(shape, x, surface);
        else
          return true;
      },
      primitive);
}

std::vector<Curve> boundary(const Primitive& primitive) {
  return std::visit(
      [](const auto& shape) -> std::vector<Curve> {
        if constexpr (requires { boundary_of(shape); })
          return boundary_of(shape);
        else
          return {};
      },
      primitive);
}

}  // namespace caplet::reference
