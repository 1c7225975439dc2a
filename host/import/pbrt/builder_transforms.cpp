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

void CurrentTransform::multiply(const Statement& at, const glm::dmat4& matrix) {
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

void CurrentTransform::set(const glm::dmat4& ctm) {
  ctm_ = ctm;
  inverse_.reset();
}

void CurrentTransform::restart(const glm::dmat4& ctm) {
  set(ctm);
  flat_.reset();
  skewed_.reset();
}

void CurrentTransform::restart_inverse(const glm::dmat4& matrix) {
  restart(glm::inverse(matrix));
  inverse_ = matrix;
}

glm::dmat4 CurrentTransform::inverse() const { return inverse_ ? *inverse_ : glm::inverse(ctm_); }

void CurrentTransform::check_place(Diagnostics& diagnostics) const {
  for (const std::optional<Fault>& bad : {flat_, skewed_})
    if (bad) diagnostics.error(bad->where, bad->what, bad->where.to_string());
}

glm::dmat4 CurrentTransform::place_of_light(const std::string& type,
                                            Diagnostics& diagnostics) const {
  if (type != "infinite" || !skewed_ || flat_) {
    check_place(diagnostics);
    return ctm_;
  }
  return glm::dmat4(glm::inverse(glm::dmat3(inverse())));
}

void TransformBuilder::active_transform(const Statement& at, const Word& which) {
  check_name(at.directive, which.text, which.where, to_.draft.diagnostics);
}

void TransformBuilder::concat_transform(const Statement& at, const glm::dmat4& matrix) {
  current().multiply(at, matrix);
}

void TransformBuilder::transform(const Statement& at, const glm::dmat4& matrix) {
  current().restart(glm::dmat4(1));
  current().multiply(at, matrix);
  if (current().matrix() == matrix) current().set(matrix);  // keeps the signs of zeros
}

void TransformBuilder::inverse_transform(const Statement& at, const glm::dmat4& matrix) {
  if (has_inverse(matrix))
    current().restart_inverse(matrix);
  else
    to_.draft.diagnostics.error(at.where, std::string(at.directive) + " has no inverse");
}

void TransformBuilder::identity(const Statement&) { current().restart(glm::dmat4(1)); }

void TransformBuilder::coordinate_system(const Statement&, const Word& name) {
  to_.check_place();
  to_.coordinate_systems[name.text] = current().matrix();
}

void TransformBuilder::coord_sys_transform(const Statement&, const Word& name) {
  if (const auto found = to_.coordinate_systems.find(name.text);
      found != to_.coordinate_systems.end())
    return current().restart(found->second);
  to_.draft.diagnostics.error(name.where, "unknown coordinate system " + in_quotes(name.text) +
                                              to_.draft.nearest(name.text, to_.coordinate_systems));
}

void TransformBuilder::look_at(const Statement& at, const glm::dvec3& eye, const glm::dvec3& target,
                               const glm::dvec3& up) {
  if (const auto world_from_camera = camera_looking(eye, target, up))
    current().set(current().matrix() * glm::affineInverse(*world_from_camera));
  else
    to_.draft.diagnostics.error(
        at.where, "LookAt has no direction (the points coincide, or up lies along the view)");
}

void TransformBuilder::rotate(const Statement& at, double degrees, const glm::dvec3& axis) {
  if (glm::length(axis) > 0)
    current().multiply(
        at, glm::rotate(glm::dmat4(1), degrees * glm::pi<double>() / 180, glm::normalize(axis)));
  else
    to_.draft.diagnostics.error(at.where, "Rotate has no axis");
}

void TransformBuilder::scale(const Statement& at, const glm::dvec3& factors) {
  current().multiply(at, glm::scale(glm::dmat4(1), factors));
}

void TransformBuilder::translate(const Statement& at, const glm::dvec3& offset) {
  current().multiply(at, glm::translate(glm::dmat4(1), offset));
}

}  // namespace caplet::pbrt
