// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// MJCF: skins, whose vertices go with bodies, by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <glm/geometric.hpp>

#include "import/import.h"
#include "support/import_files.h"

namespace caplet::mjcf_skins_test {
namespace {

using test::complaint;
using testing::AllOf;
using testing::HasSubstr;

/// A body at the origin, and one at (1, 0, 2) turned by 90 degrees about z.
const std::string kBodies =
    "<worldbody><geom size='0.1'/><body name='a'/><body name='b' pos='1 0 2' euler='0 0 "
    "90'/></worldbody>";

Scene scene_of(const std::string& assets, const std::string& bodies = kBodies) {
  return import_scene(
      test::write_file("s.xml", "<mujoco>\n<asset>" + assets + "</asset>\n" + bodies + "</mujoco>"),
      test::NoImages(), {{{"up", "y"}}});
}
const TriangleMeshShape& mesh_of(const Scene& scene) {
  return std::get<TriangleMeshShape>(scene.shapes.back().geometry);
}
glm::dvec3 vertex(const Scene& scene, std::size_t i) {
  return glm::dvec3(scene.shapes.back().world_from_object *
                    glm::dvec4(glm::dvec3(mesh_of(scene).positions.at(i)), 1));
}

// The second bone was bound at (1, 0, 0), unturned: (2, 0, 0) is one before it along x, and comes
// to stand one before the body along y. The third vertex goes with both, three parts of four with
// the first.
const std::string kSkin =
    "<skin name='coat' rgba='1 0 0 1' vertex='0 0 0  2 0 0  1 1 0' face='0 1 2'>"
    "<bone body='a' bindpos='0 0 0' bindquat='1 0 0 0' vertid='0 2' vertweight='5 3'/>"
    "<bone body='b' bindpos='1 0 0' bindquat='2 0 0 0' vertid='1 2' vertweight='0.5 1'/></skin>";

TEST(MjcfSkins, VerticesGoWithTheirBodies) {
  const Scene scene = scene_of(kSkin);
  ASSERT_EQ(scene.shapes.size(), 2U);
  EXPECT_EQ(scene.shapes.back().name, "coat");
  const auto near = [](const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_LT(glm::length(a - b), 1e-6) << a.x << ' ' << a.y << ' ' << a.z;
  };
  near(vertex(scene, 0), {0, 0, 0});
  near(vertex(scene, 1), {1, 1, 2});
  // By the first it stays at (1, 1, 0), by the second it comes to (1 - 1, 0, 2).
  near(vertex(scene, 2), {0.75, 0.75, 0.5});
  const auto& material =
      std::get<DiffuseMaterial>(scene.materials[scene.shapes.back().material].model);
  EXPECT_EQ(std::get<RgbSpectrum>(material.reflectance).rgb, glm::dvec3(1, 0, 0));
  // As it was bound, a turned bone moves nothing of a body that is turned likewise.
  std::string bound = kSkin;
  bound.replace(bound.find("bindpos='1 0 0' bindquat='2 0 0 0'"), 34,
                "bindpos='1 0 2' bindquat='1 0 0 1'");
  near(vertex(scene_of(bound), 1), {2, 0, 0});
}

TEST(MjcfSkins, AreOfTheirGroup) {
  std::string hidden = kSkin;
  hidden.replace(hidden.find("rgba="), 5, "group='4' rgba=");
  EXPECT_EQ(scene_of(hidden).shapes.size(), 1U);
}

/// The same as a file.
std::string file_bytes() {
  std::string out;
  const auto add = [&out](const auto& values) {
    out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
  };
  const auto bone = [&](const char* name, std::vector<float> bind, std::vector<std::int32_t> ids,
                        std::vector<float> weights) {
    std::string letters(40, '\0');
    std::memcpy(letters.data(), name, std::strlen(name));
    out += letters;
    add(bind);
    add(std::vector<std::int32_t>{static_cast<std::int32_t>(ids.size())});
    add(ids);
    add(weights);
  };
  add(std::vector<std::int32_t>{3, 3, 1, 2});
  add(std::vector<float>{0, 0, 0, 2, 0, 0, 1, 1, 0});
  add(std::vector<float>{0, 0, 1, 0.25F, 0, 1});
  add(std::vector<std::int32_t>{0, 1, 2});
  bone("a", {0, 0, 0, 1, 0, 0, 0}, {0, 2}, {5, 3});
  bone("b", {1, 0, 0, 2, 0, 0, 0}, {1, 2}, {0.5F, 1});
  return out;
}
Scene scene_of_file(const std::string& bytes) {
  const std::filesystem::path path = test::write_file(
      "s.xml", "<mujoco>\n<asset><skin file='s.skn'/></asset>\n" + kBodies + "</mujoco>");
  std::ofstream(path.parent_path() / "s.skn", std::ios::binary) << bytes;
  return import_scene(path, test::NoImages(), {{{"up", "y"}}});
}

TEST(MjcfSkins, FilesSayTheSame) {
  const Scene written = scene_of(kSkin), read = scene_of_file(file_bytes());
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT(glm::length(vertex(written, i) - vertex(read, i)), 1e-6);
  EXPECT_EQ(mesh_of(read).triangles, mesh_of(written).triangles);
  EXPECT_EQ(mesh_of(read).uvs.at(1), glm::vec2(1, 0.75F));  // rows of the image from the top
}

TEST(MjcfSkins, BadInput) {
  const std::string bytes = file_bytes();
  for (std::size_t i = 0; i < bytes.size(); ++i)
    EXPECT_THAT(complaint([&] { scene_of_file(bytes.substr(0, i)); }),
                HasSubstr("s.skn: the skin: "))
        << i;
  EXPECT_THAT(complaint([&] { scene_of_file(bytes + "x"); }), HasSubstr("1 bytes follow"));
  std::string many = bytes;
  std::memcpy(many.data(), "\xff\xff\xff\x7f", 4);
  EXPECT_THAT(complaint([&] { scene_of_file(many); }),
              HasSubstr("2147483647 times 12 bytes are announced"));
  std::memcpy(many.data(), "\xff\xff\xff\xff", 4);
  EXPECT_THAT(complaint([&] { scene_of_file(many); }), HasSubstr("a count is negative"));
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = kSkin;
    text.replace(text.find(from), from.size(), to);
    return complaint([&] { scene_of(text); });
  };
  EXPECT_THAT(with("body='b'", "body='c'"), AllOf(HasSubstr("s.xml:2:"), HasSubstr("no body 'c'")));
  EXPECT_THAT(with("face='0 1 2'", "face='0 1 3'"), HasSubstr("3 is no vertex of the skin, of 3"));
  EXPECT_THAT(with("face='0 1 2'", "face='0 1'"), HasSubstr("a multiple of 3"));
  EXPECT_THAT(with("face='0 1 2'", ""), HasSubstr("a skin has faces and bones"));
  EXPECT_THAT(with("vertid='1 2'", "vertid='1 7'"), HasSubstr("bone b: 7 is no vertex, of 3"));
  EXPECT_THAT(with("vertid='1 2'", "vertid='1 1.5'"), HasSubstr("1.5 is no vertex"));
  EXPECT_THAT(with("vertweight='0.5 1'", "vertweight='0.5'"), HasSubstr("1 weights of 2 vertices"));
  EXPECT_THAT(with("vertweight='0.5 1'", "vertweight='0 1'"),
              HasSubstr("vertex 1 of the skin goes with no bone"));
  EXPECT_THAT(with("bindquat='2 0 0 0'", "bindquat='0 0 0 0'"),
              HasSubstr("bindquat has no length"));
  EXPECT_THAT(with("<bone body='a'", "<bones body='a'"), HasSubstr("s.xml"));
}

}  // namespace
}  // namespace caplet::mjcf_skins_test
