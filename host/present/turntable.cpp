// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "present/turntable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "present/lights.h"
#include "present/open_shutter.h"
#include "present/present.h"

namespace caplet {

namespace {

constexpr int kSides = 64;  // of the polygon that encloses the circle of a rim

/// The swept volume: the least cylinder around the axis.
struct Swept {
  double radius = 0, low = 1e300, high = -1e300;
  glm::dvec3 axis, middle;

  void add(const glm::dvec3& p, double r) {
    const double along = glm::dot(p - middle, axis);
    radius = std::max(radius, glm::length(p - middle - along * axis) + r);
    low = std::min(low, along - r);
    high = std::max(high, along + r);
  }
  void add(const Bounds& bounds) {
    if (bounds.empty()) return;
    for (int corner = 0; corner < 8; ++corner)
      add({corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
           corner & 4 ? bounds.max.z : bounds.min.z},
          0);
  }
  void add(const Shape& shape) {
    const glm::dmat4& world = shape.world_from_object;
    const std::array<double, 3> scales{glm::length(glm::dvec3(world[0])),
                                       glm::length(glm::dvec3(world[1])),
                                       glm::length(glm::dvec3(world[2]))};
    const double scale = std::ranges::max(scales);
    const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry);
    const auto* molecule = std::get_if<MolecularSurfaceShape>(&shape.geometry);
    if (!(capsules || molecule) || scale > 1.000001 * std::ranges::min(scales))
      return add(bounds_of(shape));
    const auto place = [&](const glm::vec3& p) { return glm::dvec3(world * glm::dvec4(p, 1)); };
    if (molecule) {
      for (std::size_t i = 0; i < molecule->centers.size(); ++i)
        add(place(molecule->centers[i]), scale * static_cast<double>(molecule->radii[i]));
      return;
    }
    for (std::size_t i = 0; i < capsules->p0.size(); ++i) {
      add(place(capsules->p0[i]), scale * static_cast<double>(capsules->radius0[i]));
      add(place(capsules->p1[i]),
          scale * static_cast<double>(capsules->radius1.empty() ? capsules->radius0[i]
                                                                : capsules->radius1[i]));
    }
  }
};

}  // namespace

Turntable::Turntable(const Scene& scene)
    : camera_(scene.view.camera), film_(scene.view.film), is_automatic_(scene.automatic_camera) {
  const Bounds bounds = bounds_or_unit_of(scene);
  middle_ = 0.5 * (bounds.min + bounds.max);
  axis_ = glm::normalize(glm::dvec3(camera_.world_from_camera[1]));
  if (!scene.has_no_up) {
    const glm::dvec3 size = glm::abs(axis_);
    const int main = size.y >= size.x && size.y >= size.z ? 1 : size.z >= size.x ? 2 : 0;
    glm::dvec3 nearest(0);
    nearest[main] = axis_[main] < 0 ? -1 : 1;
    axis_ = nearest;
  }
  if (is_automatic_ && fov_of(camera_) > 0) step_back(scene);
}

void Turntable::step_back(const Scene& scene) {
  Swept swept;
  swept.axis = axis_;
  swept.middle = middle_;
  for (const Shape& shape : scene.shapes) swept.add(shape);
  if (!scene.instances.empty()) {
    Scene placed;
    placed.objects = scene.objects;
    placed.instances = scene.instances;
    swept.add(bounds_of(placed));
  }
  const glm::dmat3 view(camera_.world_from_camera);
  const glm::dvec3 right = glm::normalize(view[0]), up = glm::normalize(view[1]),
                   forward = glm::normalize(view[2]);
  const glm::dvec3 target = middle_ + 0.5 * (swept.low + swept.high) * axis_;
  const glm::dvec3 across = glm::normalize(
      glm::cross(axis_, std::abs(axis_.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
  const glm::dvec3 other = glm::cross(axis_, across);
  const double width = scene.view.film.width, height = scene.view.film.height,
               shorter = std::min(width, height);
  const double half = std::tan(fov_of(camera_) / 2) * (1 - frame_margin);
  const double rim = swept.radius / std::cos(std::numbers::pi / kSides);
  double distance = 0;
  for (const double along : {swept.low, swept.high})
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2 * std::numbers::pi * i / kSides;
      const glm::dvec3 p = middle_ + along * axis_ +
                           rim * (std::cos(angle) * across + std::sin(angle) * other) - target;
      const double x = std::abs(glm::dot(p, right)) / (half * width / shorter);
      const double y = std::abs(glm::dot(p, up)) / (half * height / shorter);
      distance = std::max(distance, std::max(x, y) - glm::dot(p, forward));
    }
  camera_.world_from_camera[3] = glm::dvec4(target - distance * forward, 1);
}

glm::dmat4 Turntable::turn(double number, std::uint32_t count) const {
  const double angle = 2 * std::numbers::pi * number / count;
  const glm::dmat4 about = glm::rotate(glm::dmat4(1), angle, axis_);
  return glm::translate(glm::dmat4(1), middle_) * about * glm::translate(glm::dmat4(1), -middle_);
}

Camera Turntable::camera(std::uint32_t number, std::uint32_t count, double shutter) const {
  Camera out = camera_;
  if (number > 0) {
    out.world_from_camera = turn(number, count) * camera_.world_from_camera;
    move(out.motion, turn(number, count));
  }
  if (shutter > 0)
    out.motion = keys_while_open(film_, [&](double u) {
      return turn(number + u * shutter, count) * camera_.world_from_camera;
    });
  return out;
}

bool Turntable::turns(const Light& light) const { return is_automatic_ && is_preset(light); }

Light Turntable::turned(const Light& light, std::uint32_t number, std::uint32_t count) const {
  Light out = light;
  auto& infinite = std::get<InfiniteLight>(out.model);
  if (number > 0)
    infinite.world_from_light = glm::dmat3(turn(number, count)) * infinite.world_from_light;
  return out;
}

}  // namespace caplet
