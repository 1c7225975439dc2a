// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// URDF: where the meshes of packages lie.
#include <gtest/gtest.h>

#include "import/import.h"
#include "support/data.h"
#include "support/import_files.h"

namespace caplet::packages_test {
namespace {

// docs/formats/robots.md: of package://NAME/REST, REST beside the file or in a folder above it, or
// NAME/REST there.
TEST(Packages, AreFoundBesideTheFileAndAbove) {
  namespace fs = std::filesystem;
  const auto width_of = [](const std::string& mesh,
                           const std::vector<std::pair<std::string, int>>& files) {
    const fs::path top = test::temporary_folder(), folder = top / "robots/urdf";
    fs::create_directories(folder);
    for (const auto& [name, width] : files) {
      fs::create_directories((top / name).parent_path());
      std::ofstream(top / name) << "v 0 0 0\nv " << width << " 0 0\nv 0 1 0\nf 1 2 3\n";
    }
    std::ofstream(folder / "r.urdf") << "<robot><link name='a'><visual><geometry><mesh filename='"
                                     << mesh << "'/></geometry></visual></link></robot>";
    const Scene scene = import_scene(folder / "r.urdf", test::NoImages(), {{{"up", "y"}}});
    return std::get<TriangleMeshShape>(scene.shapes.at(0).geometry).positions.at(1).x;
  };
  EXPECT_EQ(width_of("package://robots/meshes/t.obj", {{"robots/meshes/t.obj", 2}}), 2);
  EXPECT_EQ(width_of("package://arm/meshes/t.obj", {{"arm/meshes/t.obj", 3}}), 3);
  EXPECT_EQ(width_of("package://robots/t.obj", {{"robots/urdf/t.obj", 4}, {"robots/t.obj", 5}}),
            4);                                                      // the nearest
  EXPECT_EQ(width_of("package://t.obj", {{"robots/t.obj", 6}}), 6);  // a name alone
  EXPECT_EQ(width_of("../t.obj", {{"robots/t.obj", 7}}), 7);
}

}  // namespace
}  // namespace caplet::packages_test
