// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/shape.h"

namespace caplet {

const std::vector<double>& key_times(const Shape& shape) {
  static const std::vector<double> none;
  return std::visit(
      [](const auto& own) -> const std::vector<double>& {
        if constexpr (requires { own.times; })
          return own.times;
        else
          return none;
      },
      shape.geometry);
}

bool moves(const Shape& shape) {
  const auto* csg = std::get_if<CsgShape>(&shape.geometry);
  return csg ? moves(*csg) : !key_times(shape).empty();
}

void visit_key_times(const Shape& shape, const std::function<void(double)>& visit) {
  if (const auto* csg = std::get_if<CsgShape>(&shape.geometry)) visit_key_times(*csg, visit);
  for (const double time : key_times(shape)) visit(time);
}

std::size_t surface_count(const Shape& shape) {
  return std::visit([](const auto& own) { return surfaces_of(own); }, shape.geometry);
}

bool is_closed(const Shape& shape) {
  return std::visit([](const auto& own) { return closed(own); }, shape.geometry);
}

std::size_t solid_count(const Shape& shape) {
  const auto* csg = std::get_if<CsgShape>(&shape.geometry);
  return csg ? solids_of(*csg) : 1;
}

Bounds bounds_of(const Geometry& geometry, const glm::dmat4& m) {
  return std::visit([&](const auto& own) { return bounds_under(own, m); }, geometry);
}
Bounds bounds_of(const Shape& shape) { return bounds_of(shape.geometry, shape.world_from_object); }

const char* geometry_name(const Shape& shape) {
  static constexpr const char* names[] = {
#define GEOMETRY(Type, name) #name,
#include "scene/geometries.def"
  };
  return names[shape.geometry.index()];
}

std::size_t primitive_count(const Shape& shape) {
  return std::visit([](const auto& own) { return count_of(own); }, shape.geometry);
}

void check_geometry(const Shape& shape, ShapeCheck& report) {
  std::visit([&](const auto& own) { check(own, report); }, shape.geometry);
}

}  // namespace caplet
