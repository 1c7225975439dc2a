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

  // What kernels are built for (stage_options): the kinds of shapes there are (bit k: kind k), operands of csg among them, and
  // the bits of leaf references for them.
  std::uint64_t shapes = ~std::uint64_t{0};
  int leaf_kind_bits = CAPLET_LEAF_KIND_BITS;

  // For `info` and statistics.
  std::uint64_t primitive_count = 0, bvh_nodes = 0;
  int bvh_depth = 0;
  double bvh_sah = 0;
  double build_seconds = 0;
  std::uint64_t device_bytes() const;
  std::uint64_t geometry_bytes() const;  // nodes, leaves, primitive_geometry, instances, mesh arrays
};

/// Throws InputError when a limit of the layout is exceeded (before memory is allocated).
FlatScene lower(const Scene& scene);

}  // namespace caplet
