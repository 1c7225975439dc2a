// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/device_scene.h"

#include <utility>

namespace caplet {

namespace {

bool camera_stage_pays(const Device& device) { return device.encoding() == Encoding::wide; }

}  // namespace

DeviceScene::DeviceScene(const Device& device, const FlatScene& scene)
    : device_(device),
      options_(stage_options(scene, device)),
      buffers_(device, scene),
      kernels_(device, options_),
      world_(scene.world),
      light_radiance_(scene.lighting.radiance),
      has_light_tree_(!scene.light_nodes.empty()),
      has_media_(scene.has_media()),
      moves_(scene.moves()),
      has_camera_stage_(camera_stage_pays(device)),
      bvh_nodes_(scene.bvh_nodes) {}

void DeviceScene::update(const FlatScene& scene, const SceneChanges& changes) {
  bytes_updated_ += buffers_.update(device_, scene, changes);
  world_ = scene.world;
  light_radiance_ = scene.lighting.radiance;
  has_light_tree_ = !scene.light_nodes.empty();
  has_media_ = scene.has_media();
  moves_ = scene.moves();
  bvh_nodes_ = scene.bvh_nodes;
  // A kind that has disappeared may come back: kernels that have it are kept, so that no picture
  // waits for a compiler.
  if (StageOptions options = options_.together_with(stage_options(scene, device_));
      options != options_) {
    kernels_ = Kernels(device_, options);
    options_ = std::move(options);
  }
}

void DeviceScene::prepare_for(const FlatView& view) {
  StageOptions options = options_;
  options.rows["samplers"] |= std::uint64_t{1} << view.view.sampler;
  // Viewers switch between these two cameras, which cost next to nothing.
  options.rows["cameras"] |=
      std::uint64_t{1} << view.camera.kind | 1U << camera_perspective | 1U << camera_orthographic;
  options.clip |= has_clip(view);
  if (options == options_) return;
  kernels_ = Kernels(device_, options);
  options_ = std::move(options);
}

Bindings DeviceScene::bindings() const {
  Bindings out;
  buffers_.bind(out);
  return out;
}

}  // namespace caplet
