// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Worlds are many poses of one scene: in each, some of its shapes are elsewhere. They share one
// FlatScene, in which every shape is stored once; each world is a small tree that places them.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <memory>
#include <span>
#include <vector>

#include "lower/changes.h"
#include "lower/flat_scene.h"
#include "scene/edit.h"
#include "scene/scene.h"

namespace caplet {

/// What the scene that the worlds were made of calls the shape and the instance of a crossing.
struct WorldsIdentity {
  std::uint32_t shape = CAPLET_NONE;     // by the order of the world's shapes, then each object's
  std::uint32_t instance = CAPLET_NONE;  // index into Scene::instances; CAPLET_NONE: of no instance
  std::uint32_t primitive = CAPLET_NONE;  // of the shape
};

/// Worlds have shapes and the numbers of materials, and nothing else that shading needs: rays find
/// the nearest crossings (WorldQuery).
class Worlds {
 public:
  /// Takes a scene that passed validate(). `moving` has indices into Scene::shapes, each at most
  /// once; other shapes and the instances are where the scene has them. `deforming` has indices of
  /// shapes of capsules, each at most once, whose ends and radii are other ones in each world; they
  /// may move as well. Throws InputError for a scene that moves while its shutter is open, for a
  /// deforming shape that is not of capsules or shows one side alone, and as lower() does.
  Worlds(Scene scene, std::span<const std::uint32_t> moving,
         std::span<const std::uint32_t> deforming = {});
  Worlds(Worlds&&) noexcept;
  Worlds& operator=(Worlds&&) noexcept;
  ~Worlds();

  /// Makes the trees of so many worlds, in place of those before: the moving shapes of world w have
  /// world_from_object transforms[w * moving() + i], and its deforming shapes have the capsules
  /// ends[w * ends() ...], one shape after the other. Throws InputError for a matrix that is not
  /// affine or has no inverse (a deforming shape's must be a similarity), for a capsule that is not
  /// finite or has a negative radius, with the shape's index and that of the world, counted from
  /// `first_world`, and when the trees exceed a limit of the layout; then no world is left.
  void place(std::size_t worlds, std::span<const glm::dmat4> transforms,
             std::span<const Capsule> ends = {}, std::size_t first_world = 0);
  std::size_t moving() const;
  /// Returns how many capsules the deforming shapes have in all.
  std::size_t ends() const;

  const FlatScene& flat() const;
  /// Returns the first node of each world's tree.
  std::span<const uint> roots() const;
  /// Returns what has changed since it was made, or since the last call.
  SceneChanges take_changes();
  /// Returns what a crossing (not a miss) is on.
  WorldsIdentity identity_of(const PickRecord& pick) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace caplet
