// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A lowered scene on a device, with the kernels that are built for it. Renders and queries of one scene share it.
#pragma once

#include "device/device.h"
#include "lower/changes.h"
#include "lower/flat_scene.h"
#include "render/buffers.h"
#include "render/kernels.h"
#include "shared/kinds.h"

namespace caplet {

class DeviceScene {
 public:
  /// Sends the scene to the device; nothing of `scene` is referred to afterwards. Throws RunError when it does not fit.
  DeviceScene(const Device& device, const FlatScene& scene);

  /// Sends what differs: `scene` is the one that was sent last, but for `changes`. Buffers that have grown are made anew, and so
  /// are the kernels when the scene needs others. Renderers on this are to be reset; queries go on. Throws RunError when it does
  /// not fit, and then this scene is of no more use.
  void update(const FlatScene& scene, const SceneChanges& changes);
  /// Makes the kernels anew where they do not know the view's sampler or camera yet.
  void prepare_for(const FlatView& view);
  /// Bytes that updates have sent.
  std::uint64_t bytes_updated() const { return bytes_updated_; }

  const Device& device() const { return device_; }
  Kernels& kernels() { return kernels_; }
  /// The scene's groups, and none else. Valid as long as this.
  Bindings bindings() const;
  /// Its bounds.
  const WorldRecord& world() const { return world_; }
  /// LightingRecord.radiance.
  float light_radiance() const { return light_radiance_; }
  /// Whether camera rays have a stage of their own: where eight lanes are tested at a time.
  bool has_camera_stage() const { return has_camera_stage_; }
  /// Whether there are shapes that let rays through, and whether anything is textured: of the kernels, which may know more than
  /// there is.
  bool has_alpha() const { return has_texture(texture_alpha); }
  bool has_textures() const { return options_.rows.at("textures") != 0; }
  /// Whether lights are chosen by a light tree.
  bool has_light_tree() const { return has_light_tree_; }
  /// Whether there are media, or surfaces that light passes.
  bool has_media() const { return has_media_; }
  /// Nodes of its trees.
  std::uint64_t bvh_nodes() const { return bvh_nodes_; }

 private:
  bool has_texture(int kind) const { return (options_.rows.at("textures") >> kind & 1) != 0; }
  Device device_;
  StageOptions options_;
  SceneBuffers buffers_;
  Kernels kernels_;
  WorldRecord world_;
  float light_radiance_ = 0;
  bool has_light_tree_ = false;
  bool has_media_ = false;
  bool has_camera_stage_ = false;
  std::uint64_t bvh_nodes_ = 0;
  std::uint64_t bytes_updated_ = 0;
};

}  // namespace caplet
