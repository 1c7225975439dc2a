// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/edit.h"

#include <glm/geometric.hpp>
#include <utility>

namespace caplet {

namespace {

[[noreturn]] void no_such(const char* what, std::size_t number, std::size_t count) {
  throw InputError("there is no " + std::string(what) + " " + std::to_string(number) + ", of " +
                   std::to_string(count) + " counted from 0");
}

template <class T>
const T& at(const std::vector<T>& values, std::size_t number, const char* what) {
  if (number >= values.size()) no_such(what, number, values.size());
  return values[number];
}

const CapsulesShape& capsules_of(const Shape& shape) {
  const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry);
  if (!capsules) throw InputError(shape.where, "the shape is not one of capsules");
  return *capsules;
}

/// Throws the errors that validate() finds in `scene`, which contains only the edited thing.
void check_alone(Scene scene, const Scene& of) {
  scene.source = of.source;
  if (scene.materials.empty()) scene.materials.emplace_back();
  Diagnostics diagnostics;
  validate(scene, diagnostics);
  diagnostics.finish();
}

/// Copies everything that shapes refer to.
void add_parts(Scene& to, const Scene& from) {
  to.textures = from.textures;
  to.materials = from.materials;
  to.media = from.media;
}

/// Returns a scene of this shape alone, where it lies; a shape of an object appears in all
/// instances of the object.
Scene alone(const Scene& scene, const ShapeAt& place, Shape shape) {
  Scene out;
  if (!place.object) {
    out.shapes.push_back(std::move(shape));
    return out;
  }
  out.objects.emplace_back().shapes.push_back(std::move(shape));
  for (const Instance& instance : scene.instances)
    if (instance.object == *place.object)
      out.instances.push_back(
          {0, instance.world_from_object, instance.where, instance.motion, instance.pivot});
  if (out.instances.empty()) out.instances.emplace_back();
  return out;
}

void check(const Scene& scene, const CapsuleEdit& edit) {
  const Shape& shape = shape_at(scene, edit.at);
  const CapsulesShape& capsules = capsules_of(shape);
  if (edit.capsule >= count_of(capsules)) no_such("capsule", edit.capsule, count_of(capsules));
  if (!capsules.times.empty())
    throw InputError(shape.where, "one end of capsules that move cannot be edited");
  Shape one;
  one.geometry =
      CapsulesShape{{edit.to.p0}, {edit.to.p1}, {edit.to.radius0}, {edit.to.radius1}, {}};
  one.world_from_object = shape.world_from_object;
  one.where = shape.where;
  check_alone(alone(scene, edit.at, std::move(one)), scene);
}

void check(const Scene& scene, const TransformEdit& edit) {
  Shape shape = shape_at(scene, edit.at);
  shape.world_from_object = edit.world_from_object;
  Scene one = alone(scene, edit.at, std::move(shape));
  add_parts(one, scene);
  check_alone(std::move(one), scene);
}

const Shape& light_at(const Scene& scene, const ShapeAt& place) {
  const Shape& shape = shape_at(scene, place);
  if (!shape.emission) throw InputError(shape.where, "the shape is no light");
  return shape;
}

void check(const Scene& scene, const EmissionEdit& edit) {
  const Shape& shape = light_at(scene, edit.at);
  Shape one;
  one.geometry = shape.geometry;
  one.emission = edit.to;
  one.where = shape.where;
  one.world_from_object = shape.world_from_object;
  Scene scene_of_it = alone(scene, edit.at, std::move(one));
  add_parts(scene_of_it, scene);
  check_alone(std::move(scene_of_it), scene);
}

void check(const Scene& scene, const InstanceEdit& edit) {
  const Instance& instance = at(scene.instances, edit.instance, "instance");
  Bounds box;
  for (const Shape& shape : scene.objects[instance.object].shapes) box.extend(bounds_of(shape));
  if (box.empty()) box = {glm::dvec3(0), glm::dvec3(0)};
  // A capsule along the diagonal has the object's bounds, which is all that the check needs.
  Shape diagonal;
  diagonal.geometry = CapsulesShape{{glm::vec3(box.min)}, {glm::vec3(box.max)}, {0}, {}, {}};
  Scene one;
  one.objects.emplace_back().shapes.push_back(std::move(diagonal));
  one.instances.push_back({0, edit.world_from_object, instance.where,
                           edit.motion.value_or(TransformKeys()), edit.pivot});
  check_alone(std::move(one), scene);
}

void check(const Scene& scene, const MaterialEdit& edit) {
  const Material& material = at(scene.materials, edit.material, "material");
  Scene one;
  if (!edit.textures.empty()) one.textures = scene.textures;
  if (std::holds_alternative<MixMaterial>(edit.to)) {
    one.materials = scene.materials;
    one.textures = scene.textures;
    one.materials[edit.material] = {edit.to, material.name, material.where, edit.textures};
  } else {
    one.materials.push_back({edit.to, material.name, material.where, edit.textures});
  }
  check_alone(std::move(one), scene);
}

void check(const Scene& scene, const LightEdit& edit) {
  at(scene.lights, edit.light, "light");
  Scene one;
  one.lights.push_back(edit.to);
  check_alone(std::move(one), scene);
}

void put(Scene& scene, const View& edit) { scene.view = edit; }

void check(const Scene& scene, const View& edit) {
  Scene one;
  put(one, edit);
  check_alone(std::move(one), scene);
}

Shape& shape_at(Scene& scene, const ShapeAt& at) {
  return const_cast<Shape&>(shape_at(std::as_const(scene), at));
}

void put(Scene& scene, const CapsuleEdit& edit) {
  auto& capsules = std::get<CapsulesShape>(shape_at(scene, edit.at).geometry);
  if (capsules.radius1.empty() && edit.to.radius0 != edit.to.radius1)
    capsules.radius1 = capsules.radius0;
  capsules.p0[edit.capsule] = edit.to.p0;
  capsules.p1[edit.capsule] = edit.to.p1;
  capsules.radius0[edit.capsule] = edit.to.radius0;
  if (!capsules.radius1.empty()) capsules.radius1[edit.capsule] = edit.to.radius1;
}
void put(Scene& scene, const TransformEdit& edit) {
  shape_at(scene, edit.at).world_from_object = edit.world_from_object;
}
void put(Scene& scene, const EmissionEdit& edit) { shape_at(scene, edit.at).emission = edit.to; }
void put(Scene& scene, const InstanceEdit& edit) {
  Instance& instance = scene.instances[edit.instance];
  if (edit.motion) {
    instance.motion = *edit.motion;
    instance.pivot = edit.pivot;
  } else if (!instance.motion.empty()) {
    // All keys go where the first one goes.
    move(instance.motion, edit.world_from_object * glm::inverse(instance.world_from_object));
    instance.motion.front().matrix = edit.world_from_object;
  }
  instance.world_from_object = edit.world_from_object;
}
void put(Scene& scene, const MaterialEdit& edit) {
  scene.materials[edit.material].model = edit.to;
  scene.materials[edit.material].textures = edit.textures;
}
void put(Scene& scene, const LightEdit& edit) { scene.lights[edit.light] = edit.to; }

CapsuleEdit inverse_of(const Scene& scene, const CapsuleEdit& edit) {
  return {edit.at, edit.capsule, capsule_at(scene, edit.at, edit.capsule)};
}
TransformEdit inverse_of(const Scene& scene, const TransformEdit& edit) {
  return {edit.at, shape_at(scene, edit.at).world_from_object};
}
EmissionEdit inverse_of(const Scene& scene, const EmissionEdit& edit) {
  return {edit.at, *light_at(scene, edit.at).emission};
}
InstanceEdit inverse_of(const Scene& scene, const InstanceEdit& edit) {
  const Instance& instance = at(scene.instances, edit.instance, "instance");
  return {edit.instance, instance.world_from_object, instance.motion, instance.pivot};
}
MaterialEdit inverse_of(const Scene& scene, const MaterialEdit& edit) {
  const Material& material = at(scene.materials, edit.material, "material");
  return {edit.material, material.model, material.textures};
}
LightEdit inverse_of(const Scene& scene, const LightEdit& edit) {
  return {edit.light, at(scene.lights, edit.light, "light")};
}
View inverse_of(const Scene& scene, const View&) { return scene.view; }

}  // namespace

void check_edit(const Scene& scene, const SceneEdit& edit) {
  std::visit([&](const auto& one) { check(scene, one); }, edit);
}

void apply_edit(Scene& scene, const SceneEdit& edit) {
  check_edit(scene, edit);
  put_edit(scene, edit);
}

void put_edit(Scene& scene, const SceneEdit& edit) {
  std::visit([&](const auto& one) { put(scene, one); }, edit);
}

SceneEdit inverse(const Scene& scene, const SceneEdit& edit) {
  return std::visit([&](const auto& one) { return SceneEdit(inverse_of(scene, one)); }, edit);
}

const Shape& shape_at(const Scene& scene, const ShapeAt& place) {
  if (!place.object) return at(scene.shapes, place.shape, "shape");
  return at(at(scene.objects, *place.object, "object").shapes, place.shape, "shape of the object");
}

Capsule capsule_at(const Scene& scene, const ShapeAt& at, std::size_t capsule) {
  const CapsulesShape& capsules = capsules_of(shape_at(scene, at));
  if (capsule >= count_of(capsules)) no_such("capsule", capsule, count_of(capsules));
  return {capsules.p0[capsule], capsules.p1[capsule], capsules.radius0[capsule],
          capsules.radius1.empty() ? capsules.radius0[capsule] : capsules.radius1[capsule]};
}

std::optional<glm::dmat4> camera_looking(const glm::dvec3& eye, const glm::dvec3& target,
                                         const glm::dvec3& up) {
  const glm::dvec3 forward = glm::normalize(target - eye);
  const glm::dvec3 sideways = glm::cross(glm::normalize(up), forward);
  // Six digits of text leave an angle of 1e-6 between up and the view undetermined.
  if (!(glm::length(sideways) > 1e-6)) return std::nullopt;
  const glm::dvec3 right = glm::normalize(sideways);
  return glm::dmat4(glm::dvec4(right, 0), glm::dvec4(glm::cross(forward, right), 0),
                    glm::dvec4(forward, 0), glm::dvec4(eye, 1));
}

}  // namespace caplet
