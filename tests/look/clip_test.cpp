// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Clipping planes as people write them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <string>
#include <utility>

#include "import/picture_options.h"
#include "present/clip.h"
#include "support/import_files.h"

namespace caplet {
namespace {

using test::complaint;
using testing::HasSubstr;

/// A ball of radius 1 at (3, 1, 0), seen from (3, 1, 10).
Scene ball() {
  Scene scene;
  scene.materials.push_back({DiffuseMaterial{}, "m", {}});
  Shape shape;
  shape.geometry = SphereShape{};
  shape.world_from_object[3] = {3, 1, 0, 1};
  scene.shapes.push_back(shape);
  scene.view.camera.world_from_camera =
      glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 0, -1, 0),
                 glm::dvec4(3, 1, 10, 1));
  return scene;
}

TEST(Clip, IsReadFromAnAxisAndAPlace) {
  struct Row {
    const char* text;
    glm::dvec3 normal;
    double offset;
  };
  const double third = 1 / std::sqrt(3.0);
  for (const Row& row :
       {Row{"x", {1, 0, 0}, 3}, Row{"+y", {0, 1, 0}, 1}, Row{"-x", {-1, 0, 0}, -3},
        Row{"x=2.5", {1, 0, 0}, 2.5}, Row{"-x=2.5", {-1, 0, 0}, -2.5},
        Row{"-y=-1e-1", {0, -1, 0}, 0.1}, Row{"x=25%", {1, 0, 0}, 2.5},
        Row{"-x=25%", {-1, 0, 0}, -3.5}, Row{"x=0%", {1, 0, 0}, 2}, Row{"z=100%", {0, 0, 1}, 1},
        Row{"view", {0, 0, 1}, 0}, Row{"view=9.5", {0, 0, 1}, 0.5}, Row{"view=75%", {0, 0, 1}, 0.5},
        Row{"0,0,-2=4", {0, 0, -1}, 4}, Row{"1,1,1=0.5", {third, third, third}, 0.5},
        Row{"0,2,0", {0, 1, 0}, 1}}) {
    SCOPED_TRACE(row.text);
    const ClipPlane plane = parse_clip(row.text, ball(), "--clip");
    EXPECT_LT(glm::length(plane.normal - row.normal), 1e-15);
    EXPECT_NEAR(plane.offset, row.offset, 1e-12);
  }
}

// Axes are the file's, where importers turn it.
TEST(Clip, IsAlongTheAxesOfTheFile) {
  Scene scene = ball();
  scene.world_from_file = glm::dmat3(glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0));
  const ClipPlane plane = parse_clip("x=0.5", scene, "--clip");
  EXPECT_EQ(plane.normal, glm::dvec3(0, 0, 1));
  EXPECT_EQ(plane.offset, 0.5);
  EXPECT_EQ(parse_clip("-y", scene, "--clip").offset, -3);
}

TEST(Clip, RefusesWhatIsNoPlane) {
  for (const auto& [text, part] :
       {std::pair{"w", "'w' cuts along none of: x, y, z, -x, -y, -z, view"},
        std::pair{"", "'' cuts along none of"}, std::pair{"xy", "'xy' cuts along none of"},
        std::pair{"=3", "'=3' cuts along none of"}, std::pair{"x=", "'x=' needs a number"},
        std::pair{"x=a", "'x=a' needs a number"}, std::pair{"x=101%", "from 0% to 100%"},
        std::pair{"x=-1%", "from 0% to 100%"}, std::pair{"x=nan", "'x=nan' needs a number"},
        std::pair{"x=1,2", "'x=1,2' needs a number"}, std::pair{"0,0,0=1", "has no direction"},
        std::pair{"view=%", "needs a number"}})
    EXPECT_THAT(complaint([&, of = text] { parse_clip(of, ball(), "--clip"); }),
                testing::AllOf(HasSubstr("--clip"), HasSubstr(part)))
        << text;
}

TEST(Clip, IsAnOptionOfPictures) {
  Scene scene = ball();
  const auto set = [&](const char* text) {
    apply_picture_options(scene, test::NoImages(),
                          ImportOptions(std::map<std::string, std::string>{{"clip", text}}), false);
  };
  set("x=2");
  ASSERT_TRUE(scene.view.clip);
  EXPECT_EQ(scene.view.clip->offset, 2);
  set("none");
  EXPECT_FALSE(scene.view.clip);
}

}  // namespace
}  // namespace caplet
