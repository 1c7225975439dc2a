// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Directives that change the current transform.
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "import/detail/pbrt/builder.h"
#include "import/detail/pbrt/names.h"
#include "scene/edit.h"
#include "scene/transform.h"

namespace caplet::pbrt {

void OneTransform::multiply(const Statement& at, const glm::dmat4& matrix) {
  if (!has_inverse(matrix)) {
    // As in pbrt-v4, a singular transform is an error only where something is placed with it.
    if (!flat_) flat_ = {at.where, std::string(at.directive) + " has no inverse"};
    return;
  }
  if (!is_affine(matrix) && !skewed_)
    skewed_ = {at.where,
               std::string(at.directive) + " is not affine (its last row must be 0 0 0 1)"};
  set(ctm_ * matrix);
}

void OneTransform::set(const glm::dmat4& ctm) {
  ctm_ = ctm;
  inverse_.reset();
}

void OneTransform::restart(const glm::dmat4& ctm) {
  set(ctm);
  flat_.reset();
  skewed_.reset();
}

void OneTransform::restart_inverse(const glm::dmat4& matrix) {
  restart(glm::inverse(matrix));
  inverse_ = matrix;
}

glm::dmat4 OneTransform::inverse() const { return inverse_ ? *inverse_ : glm::inverse(ctm_); }

void OneTransform::check_place(Diagnostics& diagnostics) const {
  for (const std::optional<Fault>& bad : {flat_, skewed_})
    if (bad) diagnostics.error(bad->where, bad->what, bad->where.to_string());
}

glm::dmat4 OneTransform::place_of_light(const std::string& type, Diagnostics& diagnostics) const {
  if (type != "infinite" || !skewed_ || flat_) {
    check_place(diagnostics);
    return ctm_;
  }
  return glm::dmat4(glm::inverse(glm::dmat3(inverse())));
}

TransformKeys Building::keys() const {
  if (!state.transform.moves()) return {};
  return {{transform_times[0], state.transform.start.matrix()},
          {transform_times[1], state.transform.end.matrix()}};
}

void Building::warn_that_stays(const Statement& at, const std::string& what) {
  if (!state.transform.moves()) return;
  const std::string text =
      what + " does not move, as in pbrt-v4: it stays where it is at the start";
  draft.warnings.add(at.where, text, text);
}

void TransformBuilder::active_transform(const Statement& at, const Word& which) {
  if (!check_name(at.directive, which.text, which.where, to_.draft.diagnostics)) return;
  to_.state.transform.start_is_active = which.text != "EndTime";
  to_.state.transform.end_is_active = which.text != "StartTime";
}

void TransformBuilder::transform_times(const Statement&, double start, double end) {
  to_.transform_times = {start, end};
}

void TransformBuilder::concat_transform(const Statement& at, const glm::dmat4& matrix) {
  each_active([&](OneTransform& one) { one.multiply(at, matrix); });
}

void TransformBuilder::transform(const Statement& at, const glm::dmat4& matrix) {
  each_active([&](OneTransform& one) {
    one.restart(glm::dmat4(1));
    one.multiply(at, matrix);
    if (one.matrix() == matrix) one.set(matrix);  // keeps the signs of zeros
  });
}

void TransformBuilder::inverse_transform(const Statement& at, const glm::dmat4& matrix) {
  if (has_inverse(matrix))
    each_active([&](OneTransform& one) { one.restart_inverse(matrix); });
  else
    to_.draft.diagnostics.error(at.where, std::string(at.directive) + " has no inverse");
}

void TransformBuilder::identity(const Statement&) {
  each_active([](OneTransform& one) { one.restart(glm::dmat4(1)); });
}

void TransformBuilder::coordinate_system(const Statement&, const Word& name) {
  to_.check_place();
  const CurrentTransform& current = to_.state.transform;
  to_.coordinate_systems[name.text] = {current.start.matrix(), current.end.matrix()};
}

void TransformBuilder::coord_sys_transform(const Statement&, const Word& name) {
  const auto found = to_.coordinate_systems.find(name.text);
  if (found == to_.coordinate_systems.end())
    return to_.draft.diagnostics.error(name.where,
                                       "unknown coordinate system " + in_quotes(name.text) +
                                           to_.draft.nearest(name.text, to_.coordinate_systems));
  // As in pbrt-v4, whatever is active.
  to_.state.transform.start.restart(found->second[0]);
  to_.state.transform.end.restart(found->second[1]);
}

void TransformBuilder::look_at(const Statement& at, const glm::dvec3& eye, const glm::dvec3& target,
                               const glm::dvec3& up) {
  if (const auto world_from_camera = camera_looking(eye, target, up))
    each_active(
        [&](OneTransform& one) { one.set(one.matrix() * glm::affineInverse(*world_from_camera)); });
  else
    to_.draft.diagnostics.error(
        at.where, "LookAt has no direction (the points coincide, or up lies along the view)");
}

void TransformBuilder::rotate(const Statement& at, double degrees, const glm::dvec3& axis) {
  if (glm::length(axis) > 0)
    concat_transform(
        at, glm::rotate(glm::dmat4(1), degrees * glm::pi<double>() / 180, glm::normalize(axis)));
  else
    to_.draft.diagnostics.error(at.where, "Rotate has no axis");
}

void TransformBuilder::scale(const Statement& at, const glm::dvec3& factors) {
  concat_transform(at, glm::scale(glm::dmat4(1), factors));
}

void TransformBuilder::translate(const Statement& at, const glm::dvec3& offset) {
  concat_transform(at, glm::translate(glm::dmat4(1), offset));
}

}  // namespace caplet::pbrt
