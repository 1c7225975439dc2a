// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// For test kernels that trace a lowered scene: their parameters, the Globals made of these, and the buffers.
#pragma once

#include <span>
#include <tuple>
#include <vector>

#include "device/device.h"
#include "lower/lower.h"

namespace caplet::test {

/// OpenCL C to put before a kernel's text: SCENE_PARAMETERS of a kernel, those of SceneBuffers in order, and SCENE_GLOBALS(g),
/// which defines the Globals of them.
inline constexpr const char* scene_parameters = R"(
#define SCENE_PARAMETERS                                                                                    \
  __global const float *nodes, __global const float *leaves, __global const InstanceRecord *instances,      \
      __global const GeometryRecord *geometries, __global const uint *primitive_geometry,                   \
      __global const uint *surface_materials, __global const uint *mesh_indices,                            \
      __global const float *mesh_normals, __global const float *mesh_uvs, uint root
#define SCENE_GLOBALS(g)                     \
  Globals g;                                 \
  g.nodes = nodes;                           \
  g.leaves = leaves;                         \
  g.instances = instances;                   \
  g.geometries = geometries;                 \
  g.primitive_geometry = primitive_geometry; \
  g.surface_materials = surface_materials;   \
  g.mesh_indices = mesh_indices;             \
  g.mesh_normals = mesh_normals;             \
  g.mesh_uvs = mesh_uvs
)";

template <class T>
Buffer<T> upload(const Device& device, const std::vector<T>& values) {
  return Buffer<T>(device, std::span<const T>(values));
}

/// Sets the arguments of a kernel with (SCENE_PARAMETERS, more...). The scene's buffers last as long as this.
class SceneBuffers {
 public:
  SceneBuffers(const Device& device, const FlatScene& scene)
      : device_(&device),
        buffers_(upload(device, scene.nodes), upload(device, scene.leaves), upload(device, scene.instances),
                 upload(device, scene.geometries), upload(device, scene.primitive_geometry),
                 upload(device, scene.surface_materials), upload(device, scene.mesh_indices), upload(device, scene.mesh_normals),
                 upload(device, scene.mesh_uvs)),
        root_(scene.params.root) {}

  template <class... More>
  void set_arguments(cl::Kernel& kernel, const More&... more) const {
    std::apply([&](const auto&... buffers) { caplet::set_arguments(*device_, kernel, buffers..., root_, more...); }, buffers_);
  }

 private:
  const Device* device_;
  std::tuple<Buffer<float>, Buffer<float>, Buffer<InstanceRecord>, Buffer<GeometryRecord>, Buffer<cl_uint>, Buffer<cl_uint>,
             Buffer<cl_uint>, Buffer<float>, Buffer<float>>
      buffers_;
  cl_uint root_;
};

}  // namespace caplet::test
