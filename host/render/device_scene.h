// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// DeviceScene is a lowered scene on a device, with the kernels that are built for it. Renders and
// queries of one scene share it.
#pragma once

#include "device/device.h"
#include "lower/changes.h"
#include "lower/flat_scene.h"
#include "render/buffers.h"
#include "render/kernels.h"
#include "shared/kinds.h"

namespace caplet {

/// Returns what has to be compiled for a render of a view of the scene.
std::vector<CompileJob> render_jobs(const Device& device, const FlatScene& scene,
                                    const FlatView& view);

class DeviceScene {
 public:
  /// Sends the scene to the device; nothing of `scene` is referred to afterwards. Throws RunError
  /// when it does not fit.
  DeviceScene(const Device& device, const FlatScene& scene);
  /// Does the same, and gives back the memory of the scene's nodes and leaves, which are empty
  /// then.
  DeviceScene(const Device& device, FlatScene&& scene);

  /// Sends what differs: `scene` is the one that was sent last, except for `changes`. Buffers that
  /// have grown are allocated again, and kernels are built again if the scene needs others.
  /// Renderers on this must be reset; queries go on. Throws RunError when it does not fit; then
  /// this object cannot be used any more.
  void update(const FlatScene& scene, const SceneChanges& changes);
  /// Builds the kernels again if they do not have the view's sampler or camera yet.
  void prepare_for(const FlatView& view);
  /// Returns the bytes that updates have sent.
  std::uint64_t bytes_updated() const { return bytes_updated_; }

  const Device& device() const { return device_; }
  Kernels& kernels() { return kernels_; }
  /// Returns the scene's groups, and no others. They are valid as long as this object.
  Bindings bindings() const;
  /// Returns the scene's bounds.
  const WorldRecord& world() const { return world_; }
  /// Returns LightingRecord.radiance.
  float light_radiance() const { return light_radiance_; }
  /// Returns whether camera rays have a stage of their own: where eight lanes are tested at a time.
  bool has_camera_stage() const { return needs(false).camera_stage; }
  /// Returns what decides which stages a render needs.
  StageNeeds needs(bool has_clip) const;
  /// Returns whether kernels know textures. They may have more than the scene.
  bool has_textures() const { return options_.rows.at("textures") != 0; }
  /// Returns whether lights are chosen by a light tree.
  bool has_light_tree() const { return has_light_tree_; }
  /// Returns whether there are media, or surfaces that light passes.
  bool has_media() const { return has_media_; }
  /// Returns whether instances move.
  bool moves() const { return moves_; }
  /// Returns the number of nodes of its trees.
  std::uint64_t bvh_nodes() const { return bvh_nodes_; }

 private:
  DeviceScene(const Device& device, const FlatScene& scene, SceneBuffers buffers);
  Device device_;
  StageOptions options_;
  SceneBuffers buffers_;
  Kernels kernels_;
  WorldRecord world_;
  float light_radiance_ = 0;
  bool has_light_tree_ = false;
  bool has_media_ = false;
  bool moves_ = false;
  std::uint64_t bvh_nodes_ = 0;
  std::uint64_t bytes_updated_ = 0;
};

}  // namespace caplet
