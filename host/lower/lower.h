// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scene -> records, flat buffers, trees and light tables. The only room that decides layouts and indices.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "shared/records.h"

namespace caplet {

/// Everything a device needs, by the names of buffers.def.
struct FlatScene {
  ParamsRecord params{};
  CameraRecord camera{};
  std::vector<float> nodes, leaves;
  std::vector<InstanceRecord> instances;
  std::vector<GeometryRecord> geometries;
  std::vector<uint> primitive_geometry, surface_materials, mesh_indices;
  std::vector<float> mesh_normals, mesh_uvs;
  std::vector<MaterialRecord> materials;
  std::vector<SpectrumRecord> spectra;
  std::vector<float> spectrum_tables;
  std::vector<LightRecord> lights;
  std::vector<float> light_data;
  std::vector<AliasRecord> light_alias;
  std::vector<float> environment_texels, environment_cdf, observer, wavelength_table, filter_table;

  // For `info` and statistics.
  std::uint64_t primitive_count = 0, bvh_nodes = 0;
  bool basic_shapes() const;  // spheres, capsules, triangles and whole disks alone: kernels may be built with CAPLET_BASIC_SHAPES
  int bvh_depth = 0;
  double bvh_sah = 0;
  double build_seconds = 0;
  std::uint64_t device_bytes() const;
  std::uint64_t geometry_bytes() const;  // nodes, leaves, primitive_geometry, instances, mesh arrays
};

/// Throws InputError when a limit of the layout is exceeded (before memory is allocated).
FlatScene lower(const Scene& scene);

}  // namespace caplet
