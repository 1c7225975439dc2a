// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// For test kernels that trace a lowered scene: their parameters, the groups made of these, and the
// buffers.
#pragma once

#include <vector>

#include "device/device.h"
#include "lower/lower.h"
#include "render/buffers.h"

namespace caplet::test {

/// OpenCL C to put before a kernel's text: SCENE_PARAMETERS of a kernel, the arguments that
/// SceneOnDevice sets, and SCENE_STRUCTS, which defines `tree` and `surfaces` of them.
inline constexpr const char* scene_parameters = R"(
#include "groups.cl"
#define GROUP_BEGIN(Type, group)
#define BUFFER(name, type, access) access(type) name,
#define GROUP_END(Type)
#define SCENE_PARAMETERS GROUP_TREE GROUP_SURFACES uint scene_end
#define SCENE_STRUCTS                                                                          \
  const Tree tree = {world, nodes, leaves, instances};                                         \
  const Surfaces surfaces = {geometries,   primitive_geometry, surface_materials,              \
                             mesh_indices, mesh_normals,       mesh_uvs}
)";

template <class T>
Buffer<T> upload(const Device& device, const std::vector<T>& values) {
  return Buffer<T>(device, std::span<const T>(values));
}

/// Sets the arguments of a kernel with (SCENE_PARAMETERS, more...). The scene's buffers last as
/// long as this.
class SceneOnDevice {
 public:
  /// For kernels of this CAPLET_REAL_WIDTH.
  SceneOnDevice(const Device& device, const FlatScene& scene, int width)
      : device_(&device), buffers_(device, scene, width == 1 ? Encoding::single : Encoding::wide) {}

  template <class... More>
  void set_arguments(cl::Kernel& kernel, const More&... more) const {
    const TreeBuffers& tree = buffers_.tree;
    const SurfacesBuffers& surfaces = buffers_.surfaces;
    caplet::set_arguments(*device_, kernel,
#define GROUP_BEGIN(Type, group)
#define BUFFER(name, type, access) tree.name,
#define GROUP_END(Type)
                          GROUP_TREE
#undef BUFFER
#define BUFFER(name, type, access) surfaces.name,
                              GROUP_SURFACES
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
                                  cl_uint{0},
                          more...);
  }

 private:
  const Device* device_;
  SceneBuffers buffers_;
};

}  // namespace caplet::test
