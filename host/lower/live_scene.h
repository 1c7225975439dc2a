// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A LiveScene is a scene that is edited: an edit changes only the parts of its flat arrays that it
// affects, so that a picture of them is, to the bit, that of the edited scene lowered afresh.
#pragma once

#include <cstdint>
#include <memory>

#include "lower/changes.h"
#include "lower/flat_scene.h"
#include "lower/linking.h"
#include "scene/edit.h"
#include "scene/scene.h"

namespace caplet {

/// It keeps the scene, its flat arrays, and some 70 bytes a primitive for edits.
class LiveScene {
 public:
  /// Lowers the scene, which has passed validate(). Throws as lower() does.
  explicit LiveScene(Scene scene, const Linking& linking = Linking::of_edited());
  LiveScene(LiveScene&&) noexcept;
  LiveScene& operator=(LiveScene&&) noexcept;
  ~LiveScene();

  const Scene& scene() const;
  const FlatScene& flat() const;
  /// Returns the view of its picture.
  FlatView view() const;

  /// Makes a change, and returns the edit that undoes it. A moved capsule changes only the path
  /// from its leaf to the root; boxes along it are the exact unions that a fresh tree would have.
  /// The whole is lowered again if the arrays cannot hold the change in place (a capsule that is
  /// linked or becomes a sphere, a transform that a shape's form cannot hold), or if edits have
  /// doubled the cost of a tree since it was built. Throws InputError as check_edit and lower() do,
  /// and then changes nothing.
  SceneEdit edit(const SceneEdit& edit);
  /// Does the same with an edit that check_edit has already passed.
  SceneEdit put(const SceneEdit& edit);
  /// Puts another scene in its place. Throws as lower() does.
  void replace(Scene scene);

  /// Returns what has changed since it was made, or since the last call.
  SceneChanges take_changes();
  /// Returns how often the whole was lowered.
  std::uint64_t lowerings() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace caplet
