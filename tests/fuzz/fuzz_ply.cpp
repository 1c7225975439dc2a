// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// PLY bytes either give a mesh whose indices are in range, or are refused.
#include "import/detail/ply.h"
#include "target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using caplet::test::require;
  return caplet::test::run_target([&] {
    std::vector<glm::vec3> colors;
    const auto mesh =
        caplet::parse_ply("fuzz.ply", {reinterpret_cast<const char*>(data), size}, &colors);
    require(!mesh.triangles.empty());
    require(colors.empty() || colors.size() == 3 * mesh.triangles.size());
    for (const glm::vec3& c : colors)
      for (int k = 0; k < 3; ++k) require(c[k] >= 0 && c[k] <= 1);
    require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
    require(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
    for (const glm::vec3& p : mesh.positions)
      require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle) require(vertex < mesh.positions.size());
  });
}
