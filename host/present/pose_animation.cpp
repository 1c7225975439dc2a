// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "present/pose_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <iterator>

#include "present/open_shutter.h"
#include "scene/bounds.h"

namespace caplet {

namespace {

bool mirrors(const glm::dmat4& m) { return glm::determinant(glm::dmat3(m)) < 0; }

glm::dvec3 middle_of(const Bounds& bounds) {
  return bounds.empty() ? glm::dvec3(0) : 0.5 * (bounds.min + bounds.max);
}

Bounds bounds_of(const Object& object) {
  Bounds out;
  for (const Shape& shape : object.shapes) out.extend(caplet::bounds_of(shape));
  return out;
}

/// Refuses a turn that can go either way.
void check_turn(const ScenePose& pose, const glm::dvec3& before, const glm::dvec3& now,
                const char* what) {
  if (glm::dot(before, now) < -1 + 1e-6)
    throw InputError(pose.where, fmt::format("the camera's {} makes half a turn since the pose "
                                             "before: a pose between them says which way",
                                             what));
}

SmoothCurve::Point point_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
glm::dvec3 vector_of(const SmoothCurve::Point& p) { return {p[0], p[1], p[2]}; }

}  // namespace

PoseAnimation::PoseAnimation(const Scene& scene, const std::vector<ScenePose>& keys) {
  for (const ScenePose& pose : keys)
    for (const SceneEdit& edit : pose.edits) add(scene, pose, edit);
  const auto finish = [](Moving& moving) {
    if (!moving.keys.empty()) moving.transform.emplace(moving.keys, moving.pivot);
  };
  for (auto& [number, moving] : shapes_) finish(moving);
  for (auto& [number, moving] : instances_) finish(moving);
  finish(camera_);
}

void PoseAnimation::add(const Scene& scene, const ScenePose& pose, const SceneEdit& edit) {
  if (const auto* shape = std::get_if<TransformEdit>(&edit)) {
    const auto [at, is_new] = shapes_.try_emplace(shape->at.shape);
    const Shape& of = scene.shapes[shape->at.shape];
    if (is_new) at->second.pivot = middle_of(bounds_of(of.geometry, glm::dmat4(1)));
    add(at->second, pose, shape->world_from_object);
  } else if (const auto* instance = std::get_if<InstanceEdit>(&edit)) {
    const auto [at, is_new] = instances_.try_emplace(instance->instance);
    const Object& of = scene.objects[scene.instances[instance->instance].object];
    if (is_new) at->second.pivot = middle_of(bounds_of(of));
    add(at->second, pose, instance->world_from_object);
  } else if (const auto* capsule = std::get_if<CapsuleEdit>(&edit)) {
    capsules_[{capsule->at.shape, capsule->capsule}].push_back({pose.time.value(), capsule->to});
  } else {
    const View& view = std::get<View>(edit);
    add(camera_, pose, view.camera.world_from_camera);
    views_.emplace_back(pose.time.value(), view);
    add_look(pose, view);
  }
}

void PoseAnimation::add(Moving& to, const ScenePose& pose, const glm::dmat4& matrix) {
  if (!to.keys.empty() && mirrors(to.keys.back().matrix) != mirrors(matrix))
    throw InputError(pose.where,
                     "a transform mirrors what the one of the pose before does not mirror");
  to.keys.push_back({pose.time.value(), matrix});
}

void PoseAnimation::add_look(const ScenePose& pose, const View& view) {
  looks_ = looks_ && pose.look;
  zooms_ = zooms_ && std::holds_alternative<PerspectiveProjection>(view.camera.projection);
  if (zooms_) fov_.add(*pose.time, {fov_of(view.camera)});
  if (!looks_) return;
  LookAt look = *pose.look;
  const glm::dvec3 away = look.eye - look.target;
  const double distance = glm::length(away);
  // Points that coincide were refused. What is left of `up` across the view is what counts.
  const glm::dvec3 back = away / distance;
  look.up = glm::normalize(look.up);
  if (before_) {
    const glm::dvec3 back_before = glm::normalize(before_->eye - before_->target);
    check_turn(pose, back_before, back, "place around its target");
    check_turn(pose, before_->up, look.up, "up");
  }
  from_target_.add(*pose.time, point_of(back));
  up_.add(*pose.time, point_of(look.up));
  target_.add(*pose.time, point_of(look.target));
  log_distance_.add(*pose.time, {std::log(distance)});
  before_ = look;
}

glm::dmat4 PoseAnimation::camera_at(double time) const {
  if (!looks_) return camera_.transform->at(time);
  const glm::dvec3 target = vector_of(target_.at(time)),
                   eye = target +
                         std::exp(log_distance_.at(time)[0]) * vector_of(from_target_.at(time));
  std::optional<glm::dmat4> out = camera_looking(eye, target, vector_of(up_.at(time)));
  // Where the curve goes over the pole, up is that of the transforms.
  if (!out) out = camera_looking(eye, target, glm::dvec3(camera_.transform->at(time)[1]));
  if (!out) return camera_.transform->at(time);
  if (mirrors(*out) != mirrors(camera_.keys.front().matrix)) (*out)[0] *= -1;
  return *out;
}

template <class At>
TransformKeys PoseAnimation::keys_from(double time, double exposure, const FilmSettings& film,
                                       const At& at) {
  if (!(exposure > 0)) return {};
  return keys_while_open(film, [&](double u) { return at(time + u * exposure); });
}

View PoseAnimation::view_at(double time, double exposure, const FilmSettings& film) const {
  const auto after = std::ranges::upper_bound(views_, time, {}, &std::pair<double, View>::first);
  View out = (after == views_.begin() ? after : std::prev(after))->second;
  out.film = film;
  if (zooms_) out.camera.projection = PerspectiveProjection{fov_.at(time)[0]};
  out.camera.world_from_camera = camera_at(time);
  out.camera.motion = keys_from(time, exposure, film, [&](double t) { return camera_at(t); });
  return out;
}

std::vector<SceneEdit> PoseAnimation::at(double time, double exposure,
                                         const FilmSettings& film) const {
  std::vector<SceneEdit> out;
  for (const auto& [number, moving] : shapes_)
    out.emplace_back(TransformEdit{{std::nullopt, number}, moving.transform->at(time)});
  for (const auto& [number, moving] : instances_) {
    const AnimatedTransform& transform = *moving.transform;
    out.emplace_back(InstanceEdit{
        number, transform.at(time),
        keys_from(time, exposure, film, [&](double t) { return transform.at(t); }), moving.pivot});
  }
  for (const auto& [place, keys] : capsules_) {
    const auto after = std::ranges::upper_bound(keys, time, {}, &CapsuleKey::time);
    const CapsuleKey& b = after == keys.end() ? keys.back() : *after;
    const CapsuleKey& a = after == keys.begin() ? b : *std::prev(after);
    const double u =
        b.time > a.time ? std::clamp((time - a.time) / (b.time - a.time), 0.0, 1.0) : 0;
    const auto mixed = [u](const auto& from, const auto& to) {
      return static_cast<float>(1 - u) * from + static_cast<float>(u) * to;
    };
    out.emplace_back(
        CapsuleEdit{{std::nullopt, place.first},
                    place.second,
                    {mixed(a.capsule.p0, b.capsule.p0), mixed(a.capsule.p1, b.capsule.p1),
                     mixed(a.capsule.radius0, b.capsule.radius0),
                     mixed(a.capsule.radius1, b.capsule.radius1)}});
  }
  if (!views_.empty()) out.emplace_back(view_at(time, exposure, film));
  return out;
}

}  // namespace caplet
