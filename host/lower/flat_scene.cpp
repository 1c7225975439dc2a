// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/flat_scene.h"

#include <algorithm>

#include "shared/families.h"
#include "shared/shapes.h"

namespace caplet {

namespace {

template <class T>
std::span<const T> array_of(const std::vector<T>& values) {
  return values;
}
template <class T>
std::span<const T> array_of(const T& record) {
  return {&record, 1};
}

template <class Record>
std::uint64_t kinds_of(const std::vector<Record>& records) {
  std::uint64_t kinds = 0;
  for (const Record& record : records) kinds |= std::uint64_t{1} << record.kind;
  return kinds;
}

}  // namespace

std::uint64_t FlatScene::material_kinds() const { return kinds_of(materials); }

std::uint64_t FlatScene::texture_kinds() const { return kinds_of(textures); }

std::uint64_t FlatScene::light_kinds() const { return kinds_of(lights); }

std::uint64_t FlatScene::medium_kinds() const { return kinds_of(mediums); }

bool FlatScene::has_media() const {
  const auto passes = [](const MaterialRecord& material) {
    return (material_traits[material.kind] & trait_passes) != 0;
  };
  return !mediums.empty() || std::ranges::any_of(materials, passes);
}

bool FlatScene::moves() const {
  return (shapes & shapes_with(trait_moves)) != 0 || has_moving_operands ||
         std::ranges::any_of(instances,
                             [](const InstanceRecord& one) { return one.motion_segments > 0; });
}

bool FlatScene::multiscatters() const {
  return std::ranges::any_of(materials, [](const MaterialRecord& m) {
    return (m.flags & CAPLET_MATERIAL_MULTISCATTER) != 0;
  });
}

SceneArrays FlatScene::arrays() const {
  SceneArrays out;
#define GROUP_BEGIN(Type, group)
#define GROUP_END(Type)
#define BUFFER(name, type, access) \
  out.name = in_file && !in_file->name.empty() ? in_file->name : array_of(name);
  SCENE_GROUPS
#undef BUFFER
  return out;
}

std::uint64_t FlatScene::geometry_bytes() const {
  const SceneArrays all = arrays();
  return all.nodes.size_bytes() + all.leaves.size_bytes() + all.primitive_geometry.size_bytes() +
         all.instances.size_bytes() + all.mesh_indices.size_bytes() +
         all.mesh_normals.size_bytes() + all.mesh_uvs.size_bytes();
}

std::uint64_t FlatScene::device_bytes() const {
  const SceneArrays all = arrays();
  std::uint64_t bytes = 0;
#define BUFFER(name, type, access) bytes += all.name.size_bytes();
  SCENE_GROUPS
#undef BUFFER
#undef GROUP_BEGIN
#undef GROUP_END
  return bytes;
}

}  // namespace caplet
