// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A scene that is edited: what changes in its flat arrays is what an edit touches, so that a picture of them is, to the bit, that
// of the edited scene lowered afresh.
#pragma once

#include <cstdint>
#include <memory>

#include "lower/changes.h"
#include "lower/flat_scene.h"
#include "scene/edit.h"
#include "scene/scene.h"

namespace caplet {

/// Keeps the scene, its flat arrays, and some 70 bytes a primitive that edits go by.
class LiveScene {
 public:
  /// Throws as lower() does. The scene has passed validate().
  explicit LiveScene(Scene scene);
  LiveScene(LiveScene&&) noexcept;
  LiveScene& operator=(LiveScene&&) noexcept;
  ~LiveScene();

  const Scene& scene() const;
  const FlatScene& flat() const;
  /// How its picture is taken.
  FlatView view() const;

  /// Makes a change. A moved capsule takes the path from its leaf to the root, and no more; boxes along it are the exact unions
  /// that a fresh tree would have. What the arrays cannot hold in place (a capsule that becomes a sphere, a transform that a
  /// shape's form cannot hold) lowers the whole again, as does a tree of which edits have made twice the cost that it was built
  /// with. Throws InputError as check_edit and lower() do, and then changes nothing.
  void edit(const SceneEdit& edit);
  /// Another scene in its place. Throws as lower() does.
  void replace(Scene scene);

  /// What has changed since it was made, or since the last call.
  SceneChanges take_changes();
  /// How often the whole was lowered.
  std::uint64_t lowerings() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace caplet
