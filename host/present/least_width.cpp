// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "present/least_width.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <utility>
#include <vector>

namespace caplet {

namespace {

/// Returns the smallest singular value of a matrix, by power iteration on the inverse of its Gram
/// matrix.
double least_stretch(const glm::dmat4& m) {
  const glm::dmat3 linear(m), inverse = glm::inverse(glm::transpose(linear) * linear);
  glm::dvec3 v(0.6, 0.64, 0.48);
  for (int i = 0; i < 32; ++i) v = glm::normalize(inverse * v);
  return 1 / std::sqrt(glm::length(inverse * v));
}

struct Place {
  glm::dmat4 world_from_shape;
  double stretch;
};

std::size_t widen(Shape& shape, const std::vector<glm::dmat4>& worlds, const Scene& scene,
                  double pixels) {
  auto* capsules = std::get_if<CapsulesShape>(&shape.geometry);
  auto* sphere = std::get_if<SphereShape>(&shape.geometry);
  if ((!capsules && !sphere) || worlds.empty()) return 0;
  std::vector<Place> places;
  for (const glm::dmat4& world : worlds) {
    const glm::dmat4 m = world * shape.world_from_object;
    places.push_back({m, least_stretch(m)});
  }
  const auto least = [&](const glm::dvec3& p) {
    double radius = 0;
    for (const Place& place : places)
      radius = std::max(radius,
                        0.5 * pixels *
                            pixel_footprint(scene.view.camera, scene.view.film,
                                            glm::dvec3(place.world_from_shape * glm::dvec4(p, 1))) /
                            place.stretch);
    return radius;
  };
  std::size_t grown = 0;
  if (sphere) {
    const double radius = least({0, 0, 0});
    if (!(sphere->radius < radius)) return 0;
    sphere->radius = radius;
    return 1;
  }
  const bool is_tapered = !capsules->radius1.empty();
  std::vector<float> second = is_tapered ? capsules->radius1 : capsules->radius0;
  bool differ = is_tapered;
  for (std::size_t i = 0; i < capsules->radius0.size(); ++i) {
    const auto grow = [&](const glm::vec3& p, float& radius) {
      const auto wanted = static_cast<float>(least(p));
      if (!(radius < wanted)) return;
      radius = wanted;
      ++grown;
    };
    grow(capsules->p0[i], capsules->radius0[i]);
    grow(capsules->p1[i], second[i]);
    differ |= second[i] != capsules->radius0[i];
  }
  if (differ) capsules->radius1 = std::move(second);
  return grown;
}

}  // namespace

std::size_t widen_to_least(Scene& scene) {
  const double pixels = scene.view.film.least_width;
  if (!(pixels > 0)) return 0;
  std::size_t grown = 0;
  for (Shape& shape : scene.shapes) grown += widen(shape, {glm::dmat4(1)}, scene, pixels);
  std::vector<std::vector<glm::dmat4>> placed(scene.objects.size());
  for (const Instance& instance : scene.instances)
    placed.at(instance.object).push_back(instance.world_from_object);
  for (std::size_t i = 0; i < placed.size(); ++i)
    for (Shape& shape : scene.objects[i].shapes) grown += widen(shape, placed[i], scene, pixels);
  return grown;
}

}  // namespace caplet
