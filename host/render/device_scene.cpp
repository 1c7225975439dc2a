// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/device_scene.h"

#include "shared/shapes.h"

namespace caplet {

DeviceScene::DeviceScene(const Device& device, const FlatScene& scene)
    : device_(device),
      buffers_(device, scene),
      kernels_(device, stage_options(scene, device)),
      world_(scene.world),
      light_radiance_(scene.lighting.radiance),
      has_camera_stage_(device.encoding() == Encoding::wide && (scene.shapes & shape_bit(shape_instance)) == 0),
      bvh_nodes_(scene.bvh_nodes) {}

Bindings DeviceScene::bindings() const {
  Bindings out;
  buffers_.bind(out);
  return out;
}

}  // namespace caplet
