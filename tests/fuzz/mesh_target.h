// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The fuzz target of a mesh that only robots name.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "import/detail/robot.h"
#include "target.h"

namespace caplet::test {

/// Whatever is read as a mesh of such an ending has finite vertices, and triangles of vertices that
/// are there.
inline int fuzz_robot_mesh(const std::string& ending, const std::uint8_t* data, std::size_t size) {
  // Readers go by the name's ending, so the file in memory gets one.
  static const std::filesystem::path folder = [] {
    std::string name = (std::filesystem::temp_directory_path() / "fuzz-XXXXXX").string();
    require(::mkdtemp(name.data()) != nullptr);
    static const struct Remove {
      std::filesystem::path path;
      ~Remove() { std::filesystem::remove_all(path); }
    } remove{name};
    return remove.path;
  }();
  const MemoryFile file(data, size);
  const std::filesystem::path link = folder / ("mesh" + ending);
  std::filesystem::remove(link);
  std::filesystem::create_symlink(file.path(), link);
  return run_target([&] {
    const std::shared_ptr<const MeshParts> parts = MeshFiles().read(link, {});
    require(!parts->empty());
    for (const TriangleMeshShape& part : *parts) {
      require(!part.triangles.empty());
      require(part.normals.empty() || part.normals.size() == part.positions.size());
      for (const glm::vec3& p : part.positions)
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
      for (const auto& triangle : part.triangles)
        for (const std::uint32_t vertex : triangle) require(vertex < part.positions.size());
    }
  });
}

}  // namespace caplet::test
