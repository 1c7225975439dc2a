// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This loops over all groups of primitives; a ray that misses the ball of a group, or of a
// primitive, is not tested further.
#include "reference/scene_reference.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "reference/detail/uv.h"
#include "reference/from_scene.h"

namespace caplet::reference {

namespace {

using glm::dvec3;

// Returns false only when the line surely misses the ball: its distance from the centre, by the
// cross product, exceeds the radius.
bool may_touch(const Ball& ball, const Ray& ray) {
  const dvec3 to_center = ball.center - ray.origin;
  const dvec3 moment = glm::cross(ray.direction, to_center);
  const double slack = 1e-9 * (glm::dot(to_center, to_center) + ball.radius * ball.radius);
  return glm::dot(moment, moment) <=
         (ball.radius * ball.radius + slack) * glm::dot(ray.direction, ray.direction);
}

/// Returns the material of each surface; empty when all have the shape's own.
std::vector<std::uint32_t> materials_by_surface(const Shape& shape) {
  const auto* csg = std::get_if<CsgShape>(&shape.geometry);
  if (!csg) return shape.materials;
  std::vector<std::uint32_t> out;
  for (const auto& operand : csg->operands) {
    std::vector<std::uint32_t> own = materials_by_surface(*operand);
    if (own.empty()) own.assign(surface_count(*operand), operand->material);
    out.insert(out.end(), own.begin(), own.end());
  }
  return out;
}

/// Returns the uvs at the corners of each triangle (the first three entries) or patch; empty when
/// the mesh has none.
std::vector<std::array<glm::dvec2, 4>> corner_uvs(const Shape& shape) {
  std::vector<std::array<glm::dvec2, 4>> out;
  const auto add = [&](const auto& faces, const std::vector<glm::vec2>& uvs) {
    if (uvs.empty()) return;
    for (const auto& face : faces) {
      out.emplace_back();
      for (std::size_t k = 0; k < face.size(); ++k) out.back()[k] = uvs[face[k]];
    }
  };
  if (const auto* mesh = std::get_if<TriangleMeshShape>(&shape.geometry))
    add(mesh->triangles, mesh->uvs);
  if (const auto* mesh = std::get_if<BilinearMeshShape>(&shape.geometry))
    add(mesh->patches, mesh->uvs);
  return out;
}

/// Returns the faces that a mesh's normals turn over by pbrt's rule: where a mesh has normals they
/// say which side is out, not the winding. They are judged in the shape's outer space. It is empty
/// for meshes without normals.
std::vector<bool> turned_faces(const Shape& shape) {
  std::vector<bool> out;
  const glm::dmat3 normal_matrix =
      glm::transpose(glm::inverse(glm::dmat3(shape.world_from_object)));
  const auto add = [&](const auto& mesh, const auto& faces, const auto& by_winding) {
    if (mesh.normals.empty()) return;
    for (const auto& face : faces) {
      dvec3 sum(0);
      for (const std::uint32_t v : face)
        if (const dvec3 n = normal_matrix * dvec3(mesh.normals[v]); glm::length(n) > 0)
          sum += glm::normalize(n);
      out.push_back(glm::dot(normal_matrix * by_winding(face), sum) < 0);
    }
  };
  if (const auto* mesh = std::get_if<TriangleMeshShape>(&shape.geometry))
    add(*mesh, mesh->triangles, [&](const auto& face) {
      const dvec3 a(mesh->positions[face[0]]);
      return glm::cross(dvec3(mesh->positions[face[1]]) - a, dvec3(mesh->positions[face[2]]) - a);
    });
  if (const auto* mesh = std::get_if<BilinearMeshShape>(&shape.geometry))
    add(*mesh, mesh->patches, [&](const auto& face) {
      const auto corner = [&](std::size_t k) { return dvec3(mesh->positions[face[k]]); };
      return glm::cross(corner(3) - corner(0), corner(2) - corner(1));
    });
  return out;
}

SceneHit hit_of(SceneHit identity, const Crossing& crossing, bool leaving,
                const std::vector<std::uint32_t>& materials) {
  identity.t = crossing.t;
  identity.leaving = leaving;
  identity.surface = static_cast<std::uint32_t>(crossing.surface);
  identity.surface_margin = crossing.surface_margin;
  if (!materials.empty()) identity.material = materials[identity.surface];
  return identity;
}

}  // namespace

SceneReference::SceneReference(const Scene& scene) {
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i) {
    shape_begin_.push_back(placed_.size());
    add(scene.shapes[i], scene.shapes[i].world_from_object, {.instance = no_instance, .shape = i});
  }
  for (std::uint32_t j = 0; j < scene.instances.size(); ++j) {
    const Instance& instance = scene.instances[j];
    const Object& object = scene.objects[instance.object];
    instance_begin_.emplace_back();
    for (std::uint32_t i = 0; i < object.shapes.size(); ++i) {
      instance_begin_.back().push_back(placed_.size());
      add(object.shapes[i], instance.world_from_object * object.shapes[i].world_from_object,
          {.instance = j, .object = instance.object, .shape = i});
    }
  }
}

SceneReference::PlacedPrimitive SceneReference::placed(std::size_t index) const {
  const Placed& placed = placed_.at(index);
  return {placed.primitive, placed.ball, object_from_world_[placed.space], placed.identity};
}

std::uint32_t SceneReference::material(std::size_t index, std::uint32_t surface) const {
  const Placed& placed = placed_.at(index);
  const std::vector<std::uint32_t>& materials = surface_materials_[placed.space];
  return surface < materials.size() ? materials[surface] : placed.identity.material;
}

std::optional<std::size_t> SceneReference::index_of(std::uint32_t instance, std::uint32_t shape,
                                                    std::uint32_t primitive) const {
  if (instance != no_instance && instance >= instance_begin_.size()) return std::nullopt;
  const std::vector<std::size_t>& begin =
      instance == no_instance ? shape_begin_ : instance_begin_[instance];
  if (shape >= begin.size() || begin[shape] + primitive >= placed_.size()) return std::nullopt;
  const SceneHit& found = placed_[begin[shape] + primitive].identity;
  if (found.instance != instance || found.shape != shape || found.primitive != primitive)
    return std::nullopt;
  return found.index;
}

void SceneReference::add(const Shape& shape, const glm::dmat4& world_from_shape,
                         const SceneHit& identity) {
  object_from_world_.push_back(glm::inverse(world_from_shape));
  surface_materials_.push_back(materials_by_surface(shape));
  corner_uvs_.push_back(corner_uvs(shape));
  const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry);
  const auto* molecule = std::get_if<MolecularSurfaceShape>(&shape.geometry);
  const std::vector<bool> turned = turned_faces(shape);
  const std::size_t first = placed_.size();
  std::uint32_t index = 0;
  for (const Primitive& primitive : primitives_of(shape)) {
    Placed placed{primitive, bounding_ball(primitive), identity,
                  static_cast<std::uint32_t>(object_from_world_.size() - 1)};
    placed.identity.primitive = index;
    placed.identity.material = capsules && !capsules->materials.empty() ? capsules->materials[index]
                               : molecule && !molecule->materials.empty()
                                   ? molecule->materials[ball_of_patch(*molecule, index)]
                                   : shape.material;
    // A one-sided shape is not seen from behind an open shape's normal, as ReverseOrientation
    // leaves it, or from inside a solid.
    if (shape.one_sided)
      (is_solid(primitive) || !shape.reverse_orientation ? placed.sees_leaving
                                                         : placed.sees_entering) = false;
    placed.reversed = shape.reverse_orientation;
    placed.turned = !turned.empty() && turned[index];
    placed.identity.index = placed_.size();
    placed_.push_back(placed);
    ++index;
  }
  for (std::size_t i = first; i < placed_.size(); ++i)
    grouped_.push_back(static_cast<std::uint32_t>(i));
  if (first < placed_.size())
    group(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(placed_.size()),
          world_from_shape);
}

/// Halves the primitives of one shape, along the axis on which their centres are furthest apart,
/// until 32 or fewer are left.
void SceneReference::group(std::uint32_t begin, std::uint32_t end,
                           const glm::dmat4& world_from_shape) {
  dvec3 low(HUGE_VAL), high(-HUGE_VAL);
  for (std::uint32_t i = begin; i < end; ++i) {
    low = glm::min(low, placed_[grouped_[i]].ball.center);
    high = glm::max(high, placed_[grouped_[i]].ball.center);
  }
  const dvec3 size = high - low;
  if (end - begin > 32) {
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(grouped_.begin() + begin, grouped_.begin() + middle, grouped_.begin() + end,
                     [&](auto a, auto b) {
                       return placed_[a].ball.center[axis] < placed_[b].ball.center[axis];
                     });
    group(begin, middle, world_from_shape);
    group(middle, end, world_from_shape);
    return;
  }
  Ball ball{0.5 * (low + high), 0};
  for (std::uint32_t i = begin; i < end; ++i) {
    const Ball& own = placed_[grouped_[i]].ball;
    ball.radius = std::max(ball.radius, glm::length(own.center - ball.center) + own.radius);
  }
  // The square root of the sum of all entries' squares is at least the stretch of every direction.
  double squares = 0;
  for (int c = 0; c < 3; ++c)
    squares += glm::dot(dvec3(world_from_shape[c]), dvec3(world_from_shape[c]));
  groups_.push_back(
      {{dvec3(world_from_shape * glm::dvec4(ball.center, 1)), std::sqrt(squares) * ball.radius},
       begin,
       end});
}

/// Calls visit(placed, ray in its space) for every primitive that the ray may touch.
template <class Visit>
void SceneReference::visit_touched(const Ray& ray, const Visit& visit) const {
  Ray local = ray;
  std::uint32_t space = 0xffffffffu;
  for (const Group& group : groups_) {
    if (!may_touch(group.ball, ray)) continue;
    for (std::uint32_t i = group.begin; i < group.end; ++i) {
      const Placed& placed = placed_[grouped_[i]];
      if (placed.space != space) {
        space = placed.space;
        local.origin = dvec3(object_from_world_[space] * glm::dvec4(ray.origin, 1));
        local.direction = dvec3(object_from_world_[space] * glm::dvec4(ray.direction, 0));
      }
      if (may_touch(placed.ball, local)) visit(placed, local);
    }
  }
}

std::optional<SceneHit> SceneReference::closest(const Ray& ray) const {
  std::optional<SceneHit> best;
  visit_touched(ray, [&](const Placed& placed, const Ray& local) {
    for (const Crossing& crossing : crossings(placed.primitive, local)) {
      if (!(crossing.t > local.t_min && crossing.t < local.t_max)) continue;
      if (!placed.sees(crossing)) continue;
      if (!best || crossing.t < best->t ||
          (crossing.t == best->t && placed.identity.index < best->index))
        best = hit_of(placed.identity, crossing, placed.leaves(crossing),
                      surface_materials_[placed.space]);
      return;
    }
  });
  return best;
}

std::vector<SceneHit> SceneReference::all(const Ray& ray, std::size_t limit) const {
  std::vector<std::uint32_t> near;
  std::vector<SceneHit> out = all(ray, near);
  out.resize(std::min(out.size(), limit));
  return out;
}

std::vector<SceneHit> SceneReference::all(const Ray& ray, std::vector<std::uint32_t>& near) const {
  std::vector<SceneHit> out;
  near.clear();
  visit_touched(ray, [&](const Placed& placed, const Ray& local) {
    near.push_back(static_cast<std::uint32_t>(placed.identity.index));
    for (const Crossing& crossing : crossings(placed.primitive, local))
      if (crossing.t > ray.t_min && crossing.t < ray.t_max && placed.sees(crossing))
        out.push_back(hit_of(placed.identity, crossing, placed.leaves(crossing),
                             surface_materials_[placed.space]));
  });
  std::ranges::stable_sort(out, [](const SceneHit& a, const SceneHit& b) {
    return a.t != b.t ? a.t < b.t : a.leaving != b.leaving ? a.leaving : a.index < b.index;
  });
  return out;
}

dvec3 SceneReference::normal(const SceneHit& hit, const dvec3& point) const {
  const Placed& placed = placed_.at(hit.index);
  const glm::dmat4& m = object_from_world_[placed.space];
  const dvec3 local =
      normal_at(placed.primitive, dvec3(m * glm::dvec4(point, 1)), 1e-6 * placed.ball.radius);
  const dvec3 out = glm::normalize(glm::transpose(glm::dmat3(m)) * local);
  return placed.reversed != placed.turned ? -out : out;
}

glm::dvec2 SceneReference::uv(const SceneHit& hit, const dvec3& point,
                              const dvec3& direction) const {
  const Placed& placed = placed_.at(hit.index);
  const dvec3 own(object_from_world_[placed.space] * glm::dvec4(point, 1));
  const glm::dvec2 at = uv_at(placed.primitive, own, static_cast<int>(hit.surface),
                              glm::dmat3(object_from_world_[placed.space]) * direction);
  if (corner_uvs_[placed.space].empty()) return at;
  const auto& corners = corner_uvs_[placed.space][placed.identity.primitive];
  if (std::holds_alternative<Triangle>(placed.primitive))
    return (1 - at.x) * corners[0] + (at.x - at.y) * corners[1] + at.y * corners[2];
  return (1 - at.y) * ((1 - at.x) * corners[0] + at.x * corners[1]) +
         at.y * ((1 - at.x) * corners[2] + at.x * corners[3]);
}

std::vector<std::optional<SceneHit>> SceneReference::closest(std::span<const Ray> rays) const {
  std::vector<std::optional<SceneHit>> out(rays.size());
  tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t i) { out[i] = closest(rays[i]); });
  return out;
}

}  // namespace caplet::reference
