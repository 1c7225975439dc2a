// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/device_scene.h"

#include <utility>

#include "render/detail/launch_policy.h"

namespace caplet {

namespace {

bool camera_stage_pays(const Device& device) { return device.encoding() == Encoding::wide; }

bool has_texture(const StageOptions& options, int kind) {
  return (options.rows.at("textures") >> kind & 1) != 0;
}

/// Returns `options` for the view's sampler, camera and clipping plane as well.
StageOptions with_view(StageOptions options, const FlatView& view) {
  options.rows["samplers"] |= std::uint64_t{1} << view.view.sampler;
  // Viewers switch between these two cameras, which cost next to nothing.
  options.rows["cameras"] |=
      std::uint64_t{1} << view.camera.kind | 1U << camera_perspective | 1U << camera_orthographic;
  options.clip |= has_clip(view);
  return options;
}

StageNeeds stage_needs(const Device& device, const StageOptions& options, bool has_media,
                       bool has_clip) {
  return {camera_stage_pays(device), has_texture(options, texture_alpha), has_media, has_clip,
          launch_policy_of(device).counts_on_device};
}

}  // namespace

std::vector<CompileJob> render_jobs(const Device& device, const FlatScene& scene,
                                    const FlatView& view) {
  const StageOptions options = with_view(stage_options(scene, device), view);
  return Kernels(device, options)
      .jobs(render_stages(stage_needs(device, options, scene.has_media(), has_clip(view))));
}

DeviceScene::DeviceScene(const Device& device, const FlatScene& scene)
    : DeviceScene(device, scene, SceneBuffers(device, scene)) {}

DeviceScene::DeviceScene(const Device& device, FlatScene&& scene)
    : DeviceScene(device, scene, SceneBuffers(device, std::move(scene))) {}

DeviceScene::DeviceScene(const Device& device, const FlatScene& scene, SceneBuffers buffers)
    : device_(device),
      options_(stage_options(scene, device, buffers.part_distance())),
      buffers_(std::move(buffers)),
      kernels_(device, options_),
      world_(scene.world),
      light_radiance_(scene.lighting.radiance),
      has_light_tree_(!scene.light_nodes.empty()),
      has_media_(scene.has_media()),
      moves_(scene.moves()),
      bvh_nodes_(scene.bvh_nodes) {}

StageNeeds DeviceScene::needs(bool has_clip) const {
  return stage_needs(device_, options_, has_media_, has_clip);
}

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
  if (StageOptions options =
          options_.together_with(stage_options(scene, device_, buffers_.part_distance()));
      options != options_) {
    kernels_ = Kernels(device_, options);
    options_ = std::move(options);
  }
}

void DeviceScene::prepare_for(const FlatView& view) {
  StageOptions options = with_view(options_, view);
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
