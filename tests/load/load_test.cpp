// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Loading takes time by the size of the scene: four times as many statements allocate four times as
// many bytes. An array that is moved at each statement would allocate sixteen times as many.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "counted_new.h"
#include "import/detail/pbrt/pbrt.h"
#include "lower/lower.h"
#include "scene/image_reader.h"

namespace caplet {
namespace {

class NoImages : public ImageReader {
 public:
  EnvironmentImage read_rgb(const std::filesystem::path& path) const override {
    throw InputError(path.string() + ": no images");
  }
};

/// Bytes allocated for `count` statements, loaded and lowered.
std::uint64_t bytes_for(const std::function<std::string(const std::string&)>& statement,
                        int count) {
  std::string text =
      "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\nShape \"sphere\"\nObjectBegin "
      "\"o\" Shape \"sphere\" "
      "ObjectEnd\n";
  for (int i = 0; i < count; ++i) text += statement(std::to_string(i)) + "\n";
  const std::uint64_t before = test::allocated_bytes();
  const Scene scene = pbrt::import_text("scene.pbrt", text, NoImages());
  Diagnostics diagnostics;
  validate(scene, diagnostics);
  diagnostics.finish();
  const FlatScene flat = lower(scene);
  EXPECT_GT(flat.primitive_count, 0u);
  return test::allocated_bytes() - before;
}

struct Kind {
  const char* name;
  std::function<std::string(const std::string& i)> statement;
};
void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

const std::string capsule =
    "Shape \"capsule\" \"point3 p0\" [0 0 0] \"point3 p1\" [1 0 0] \"float radius\" .1";

const Kind kinds[] = {
    {"Capsules",
     [](const std::string& i) {
       return "Shape \"capsule\" \"point3 p0\" [" + i + " 0 0] \"point3 p1\" [" + i +
              " 1 0] \"float radius\" .1";
     }},
    {"Curves",
     [](const std::string& i) {
       return "Shape \"curve\" \"point3 P\" [" + i + " 0 0 " + i + " 1 0 " + i + " 2 0 " + i +
              " 3 0] \"float width\" .1";
     }},
    {"Triangles",
     [](const std::string& i) {
       return "Shape \"trianglemesh\" \"point3 P\" [" + i + " 0 0 1 0 0 0 1 0]";
     }},
    {"Spheres",
     [](const std::string& i) {
       return "AttributeBegin Translate " + i + " 0 0 Shape \"sphere\" AttributeEnd";
     }},
    {"Ellipsoids",
     [](const std::string& i) {
       return "AttributeBegin Translate " + i + " 0 0 Scale 1 2 3 Shape \"sphere\" AttributeEnd";
     }},
    {"Materials",
     [](const std::string& i) {
       return "Material \"diffuse\" \"spectrum reflectance\" [400 .5 70" + i + " .6] " + capsule;
     }},
    {"NamedMaterials",
     [](const std::string& i) {
       return "MakeNamedMaterial \"" + i + "\" \"string type\" \"diffuse\" NamedMaterial \"" + i +
              "\" " + capsule;
     }},
    {"Textures",
     [](const std::string& i) {
       return "Texture \"" + i +
              "\" \"spectrum\" \"constant\" Material \"diffuse\" \"texture reflectance\" \"" + i +
              "\" " + capsule;
     }},
    {"Instances",
     [](const std::string& i) {
       return "AttributeBegin Translate " + i + " 0 0 ObjectInstance \"o\" AttributeEnd";
     }},
    {"Objects",
     [](const std::string& i) {
       return "ObjectBegin \"" + i + "\" Shape \"sphere\" ObjectEnd ObjectInstance \"" + i +
              "\" CoordinateSystem \"" + i + "\"";
     }},
    {"AreaLights",
     [](const std::string& i) {
       return "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 1" + i + "] " + capsule +
              " AttributeEnd";
     }},
    {"PointLights",
     [](const std::string& i) { return "LightSource \"point\" \"point3 from\" [" + i + " 0 0]"; }},
    {"Attributes",
     [](const std::string& i) {
       return "Attribute \"shape\" \"float radius\" 1" + i + " Shape \"sphere\"";
     }},
};

class LinearLoad : public testing::TestWithParam<Kind> {};

// Between doublings of arrays 4 n costs up to twice what 4 times n does on average, 8 in all;
// quadratic growth gives 16. The fixed cost (tables of spectra) only lessens the ratio, so n is
// such that it is small beside the rest.
TEST_P(LinearLoad, AllocatesByTheNumberOfStatements) {
  constexpr int count = 2000;
  const std::uint64_t fixed = bytes_for(GetParam().statement, 1);
  const std::uint64_t once = bytes_for(GetParam().statement, count) - fixed;
  const std::uint64_t four_times = bytes_for(GetParam().statement, 4 * count) - fixed;
  EXPECT_LT(static_cast<double>(four_times) / static_cast<double>(once), 8.5);
}

INSTANTIATE_TEST_SUITE_P(Statements, LinearLoad, testing::ValuesIn(kinds),
                         [](const auto& row) { return row.param.name; });

/// The first normal of the only mesh with normals.
glm::dvec3 lowered_normal(const std::string& transform, const std::string& normal) {
  const Scene scene = pbrt::import_text(
      "scene.pbrt",
      "Camera \"perspective\"\nWorldBegin\n" + transform +
          "\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"normal N\" [" + normal +
          " " + normal + " " + normal + "]",
      NoImages());
  const FlatScene flat = lower(scene);
  if (flat.mesh_normals.size() < 3) return glm::dvec3(0);
  return {flat.mesh_normals[0], flat.mesh_normals[1], flat.mesh_normals[2]};
}

// A surface stretched along an axis turns its normals away from it: f(x) = 0 becomes f(A^-1 x) = 0,
// with the gradient A^-T grad f. Tolerance: three roundings to floats.
TEST(Lowering, NormalsOfMeshesGoWithTheInverseTranspose) {
  const auto expect_along = [](const glm::dvec3& n, double x, double y, double z) {
    const double length = std::sqrt(x * x + y * y + z * z);
    EXPECT_NEAR(n.x, x / length, 2e-7);
    EXPECT_NEAR(n.y, y / length, 2e-7);
    EXPECT_NEAR(n.z, z / length, 2e-7);
  };
  // x + y + z = c becomes x + y / 2 + z / 4 = c.
  expect_along(lowered_normal("Scale 1 2 4", "1 1 1"), 4, 2, 1);
  // x' = x + 2 y: the plane x = c becomes x' - 2 y' = c.
  expect_along(lowered_normal("Transform [1 0 0 0  2 1 0 0  0 0 1 0  0 0 0 1]", "1 0 0"), 1, -2, 0);
  // Rotations turn them as they turn points: a quarter turn about z takes x to y.
  expect_along(lowered_normal("Rotate 90 0 0 1", "1 0 1"), 0, 1, 1);
}

}  // namespace
}  // namespace caplet
