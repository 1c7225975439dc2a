// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A camera that goes round a scene, once.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>

#include "scene/scene.h"

namespace caplet {

/// The axis goes through the middle of the scene's bounds, along what is up: of scenes that know it the axis of the world nearest
/// to the camera's own up, else that itself. An automatic camera is moved back so far that it sees all of what turns, in every
/// frame (perspective alone); studio light, which belongs to it, goes round with it, other lights stay.
class Turntable {
 public:
  /// The scene has shapes.
  explicit Turntable(const Scene& scene);

  /// Frame `number` from 0 of `count`: the camera has gone so much of one turn to its right. Of the first, the scene's camera but
  /// for its distance.
  Camera camera(std::uint32_t number, std::uint32_t count) const;
  /// Whether `light` goes with the camera.
  bool turns(const Light& light) const;
  /// The light as it then stands.
  Light turned(const Light& light, std::uint32_t number, std::uint32_t count) const;

 private:
  glm::dmat4 turn(std::uint32_t number, std::uint32_t count) const;
  void step_back(const Scene& scene);

  Camera camera_;
  glm::dvec3 axis_{0, 1, 0}, middle_{0};
  bool is_automatic_;
};

}  // namespace caplet
