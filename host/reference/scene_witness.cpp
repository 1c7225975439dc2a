// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A loop over all primitives; a ray that passes a primitive's ball is not looked at closer.
#include "reference/scene_witness.h"

#include <tbb/parallel_for.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

namespace caplet::reference {

namespace {

using glm::dvec3;

std::vector<Primitive> primitives_of(const Shape& shape) {
  std::vector<Primitive> out;
  if (const auto* sphere = std::get_if<SphereShape>(&shape.geometry)) {
    out.push_back(Sphere{dvec3(0), sphere->radius});
  } else if (const auto* disk = std::get_if<DiskShape>(&shape.geometry)) {
    out.push_back(Disk{dvec3(0, 0, disk->height), dvec3(0, 0, 1), disk->radius});
  } else if (const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry)) {
    for (std::size_t i = 0; i < capsules->p0.size(); ++i) {
      const double radius0 = capsules->radius0[i];
      const double radius1 = capsules->radius1.empty() ? radius0 : static_cast<double>(capsules->radius1[i]);
      out.push_back(Capsule{dvec3(capsules->p0[i]), dvec3(capsules->p1[i]), radius0, radius1});
    }
  } else {
    const auto& mesh = std::get<TriangleMeshShape>(shape.geometry);
    for (const auto& corner : mesh.triangles)
      out.push_back(
          Triangle{dvec3(mesh.positions[corner[0]]), dvec3(mesh.positions[corner[1]]), dvec3(mesh.positions[corner[2]])});
  }
  return out;
}

// False only when the line surely passes the ball: its distance from the centre, by the cross product, exceeds the radius.
bool may_touch(const Ball& ball, const Ray& ray) {
  const dvec3 to_center = ball.center - ray.origin;
  const dvec3 moment = glm::cross(ray.direction, to_center);
  const double slack = 1e-9 * (glm::dot(to_center, to_center) + ball.radius * ball.radius);
  return glm::dot(moment, moment) <= (ball.radius * ball.radius + slack) * glm::dot(ray.direction, ray.direction);
}

}  // namespace

SceneWitness::SceneWitness(const Scene& scene) {
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i)
    add(scene.shapes[i], scene.shapes[i].world_from_object, {.instance = no_instance, .shape = i});
  for (std::uint32_t j = 0; j < scene.instances.size(); ++j) {
    const Instance& instance = scene.instances[j];
    const Object& object = scene.objects[instance.object];
    for (std::uint32_t i = 0; i < object.shapes.size(); ++i)
      add(object.shapes[i], instance.world_from_object * object.shapes[i].world_from_object,
          {.instance = j, .object = instance.object, .shape = i});
  }
}

void SceneWitness::add(const Shape& shape, const glm::dmat4& world_from_shape, const SceneHit& identity) {
  object_from_world_.push_back(glm::inverse(world_from_shape));
  std::uint32_t index = 0;
  for (const Primitive& primitive : primitives_of(shape)) {
    Placed placed{primitive, bounding_ball(primitive), identity, static_cast<std::uint32_t>(object_from_world_.size() - 1)};
    placed.identity.primitive = index++;
    placed_.push_back(placed);
  }
}

std::optional<SceneHit> SceneWitness::closest(const Ray& ray) const {
  std::optional<SceneHit> best;
  Ray local = ray;
  std::uint32_t space = 0xffffffffu;
  for (const Placed& placed : placed_) {
    if (placed.space != space) {
      space = placed.space;
      local.origin = dvec3(object_from_world_[space] * glm::dvec4(ray.origin, 1));
      local.direction = dvec3(object_from_world_[space] * glm::dvec4(ray.direction, 0));
    }
    if (!may_touch(placed.ball, local)) continue;
    if (const auto crossing = reference::closest(placed.primitive, local)) {
      best = placed.identity;
      best->t = crossing->t;
      best->leaving = crossing->leaving;
      local.t_max = crossing->t;
    }
  }
  return best;
}

std::vector<std::optional<SceneHit>> SceneWitness::closest(std::span<const Ray> rays) const {
  std::vector<std::optional<SceneHit>> out(rays.size());
  tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t i) { out[i] = closest(rays[i]); });
  return out;
}

}  // namespace caplet::reference
