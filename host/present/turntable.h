// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A camera that goes once around a scene.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>

#include "scene/scene.h"

namespace caplet {

/// The axis goes through the centre of the scene's bounds along the up axis: the world axis nearest
/// to the camera's up, or the camera's up for scenes without an up axis. An automatic camera moves
/// back until it sees all of the turning scene in every frame (perspective only). Studio light
/// belongs to it and turns with it; other lights stay.
class Turntable {
 public:
  /// The scene must have shapes.
  explicit Turntable(const Scene& scene);

  /// Returns the camera of frame `number`, from 0, of `count`: it has gone this part of a turn to
  /// its right. Frame 0 has the scene's camera except for its distance. While the shutter is open
  /// the camera goes on by a share `shutter` of the way to the next frame.
  Camera camera(std::uint32_t number, std::uint32_t count, double shutter = 0) const;
  /// Returns whether `light` turns with the camera.
  bool turns(const Light& light) const;
  /// Returns the light of that frame.
  Light turned(const Light& light, std::uint32_t number, std::uint32_t count) const;

 private:
  glm::dmat4 turn(double number, std::uint32_t count) const;
  void step_back(const Scene& scene);

  Camera camera_;
  FilmSettings film_;
  glm::dvec3 axis_{0, 1, 0}, middle_{0};
  bool is_automatic_;
};

}  // namespace caplet
