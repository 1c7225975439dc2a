// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Animations of a scene between poses that have times.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "present/smooth_curve.h"
#include "scene/pose.h"

namespace caplet {

/// What moves follows the poses that name it, and rests before the first and after the last of
/// these. Transforms go on as AnimatedTransform has it, about the middle of the shape or object.
/// Capsules' ends and radii change linearly. A camera whose keys all have a target follows a
/// SmoothCurve: it turns around its target, comes nearer by factors, and its field of view changes
/// by even steps. A camera with another key goes on as transforms do.
class PoseAnimation {
 public:
  /// `keys` have times that rise. Throws InputError for a camera that turns by half a turn from one
  /// key to the next, and for transforms of which one mirrors and another does not.
  PoseAnimation(const Scene& scene, const std::vector<ScenePose>& keys);

  /// Returns the edits that make the scene as it is at `time`. `exposure` seconds pass while the
  /// shutter is open: the camera and instances move then, all else rests.
  /// `film` is the scene's.
  std::vector<SceneEdit> at(double time, double exposure, const FilmSettings& film) const;

 private:
  struct Moving {
    TransformKeys keys = {};
    glm::dvec3 pivot{0};
    std::optional<AnimatedTransform> transform = {};
  };
  struct CapsuleKey {
    double time;
    Capsule capsule;
  };

  void add(const Scene& scene, const ScenePose& pose, const SceneEdit& edit);
  void add(Moving& to, const ScenePose& pose, const glm::dmat4& matrix);
  void add_look(const ScenePose& pose, const View& view);
  View view_at(double time, double exposure, const FilmSettings& film) const;
  glm::dmat4 camera_at(double time) const;
  /// Returns the keys of at(t) from `time` on while the shutter is open; none without exposure.
  template <class At>
  static TransformKeys keys_from(double time, double exposure, const FilmSettings& film,
                                 const At& at);

  std::map<std::uint32_t, Moving> shapes_, instances_;
  std::map<std::pair<std::uint32_t, std::size_t>, std::vector<CapsuleKey>> capsules_;
  Moving camera_;
  std::vector<std::pair<double, View>> views_;
  bool looks_ = true, zooms_ = true;  // whether all keys have a target, and a field of view
  SmoothCurve from_target_{SmoothCurve::Space::sphere}, up_{SmoothCurve::Space::sphere};
  SmoothCurve target_{SmoothCurve::Space::line}, log_distance_{SmoothCurve::Space::line},
      fov_{SmoothCurve::Space::line};
  std::optional<LookAt> before_;
};

}  // namespace caplet
