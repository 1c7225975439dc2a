// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Materials, lamps and the camera of a glTF file beside what Blender's importer makes of it
// (blender/make.py). Its numbers are floats, written with seven digits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "import/import.h"
#include "support/data.h"
#include "support/import_files.h"

namespace caplet {
namespace {

using Json = nlohmann::json;

constexpr double kDigits = 3e-7;  // the rounding of a float and of its seventh digit

std::filesystem::path folder() { return test::source_folder() / "tests" / "meshes" / "blender"; }

Json blenders() {
  std::ifstream file(folder() / "looks.json");
  return Json::parse(file);
}

const Scene& ours() {
  static const Scene scene = import_scene(folder() / "looks.gltf", test::NoImages());
  return scene;
}

const Shape& shape_of(const std::string& name) {
  return *std::ranges::find(ours().shapes, name,
                            &Shape::name);  // nodes have the names of their materials
}

glm::dvec3 color_of(const Json& json) { return {json.at(0), json.at(1), json.at(2)}; }

void expect_near(const glm::dvec3& a, const glm::dvec3& b, const std::string& what) {
  EXPECT_LT(glm::length(a - b), kDigits * (1 + glm::length(b)))
      << what << ": " << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " "
      << b.z;
}

/// A column of a matrix of Blender's world, whose z is up, in the file's, whose y is.
glm::dvec3 column(const Json& matrix, std::size_t c) {
  return {matrix.at(0).at(c), matrix.at(2).at(c), -matrix.at(1).at(c).get<double>()};
}

TEST(Blender, MaterialsOfGltf) {
  const Json theirs = blenders();
  ASSERT_EQ(theirs.at("materials").size(), 7U);
  for (const auto& one : theirs.at("materials").items()) {
    SCOPED_TRACE(one.key());
    const Json& looks = one.value();
    const Shape& shape = shape_of(one.key());
    const auto& model = std::get<PrincipledMaterial>(ours().materials.at(shape.material).model);
    const auto near = [&](double value, const char* socket) {
      EXPECT_NEAR(value, looks.at(socket), kDigits * 2) << socket;
    };
    expect_near(std::get<RgbSpectrum>(model.base_color).rgb, color_of(looks.at("Base Color")),
                "Base Color");
    near(model.metallic, "Metallic");
    near(model.roughness, "Roughness");
    near(model.eta, "IOR");
    near(model.anisotropic, "Anisotropic");
    near(model.spec_trans, "Transmission Weight");
    near(model.coat, "Coat Weight");
    if (model.coat > 0) near(model.coat_roughness, "Coat Roughness");
    near(shape.alpha ? std::get<ConstantSpectrum>(shape.alpha->value).value : 1, "Alpha");
    // Ours has one number: the greatest of the colour.
    const glm::dvec3 sheen =
        looks.at("Sheen Weight").get<double>() * color_of(looks.at("Sheen Tint"));
    EXPECT_NEAR(model.sheen, std::max({sheen.x, sheen.y, sheen.z}), kDigits);
    const glm::dvec3 emitted =
        looks.at("Emission Strength").get<double>() * color_of(looks.at("Emission Color"));
    ASSERT_EQ(shape.emission.has_value(), emitted != glm::dvec3(0));
    if (shape.emission)
      expect_near(shape.emission->scale * std::get<RgbSpectrum>(shape.emission->radiance).rgb,
                  emitted, "Emission");
  }
}

TEST(Blender, LampsOfGltf) {
  const Json theirs = blenders();
  const Json file = Json::parse(std::ifstream(folder() / "looks.gltf"));
  const Json& named = file.at("extensions").at("KHR_lights_punctual").at("lights");
  ASSERT_EQ(ours().lights.size(), named.size());
  ASSERT_EQ(theirs.at("lamps").size(), named.size());
  for (std::size_t i = 0; i < named.size(); ++i) {
    const std::string name = named[i].at("name");
    SCOPED_TRACE(name);
    const Json& lamp = theirs.at("lamps").at(name);
    const Light& light = ours().lights[i];
    const glm::dvec3 position = column(lamp.at("matrix"), 3),
                     direction = -column(lamp.at("matrix"), 2);
    const double energy = lamp.at("energy");
    const auto lit = [&](const Spectrum& spectrum, double expected) {
      expect_near(light.scale * std::get<RgbSpectrum>(spectrum).rgb,
                  expected * color_of(lamp.at("color")), "color");
    };
    if (lamp.at("type") == "SUN") {
      const auto& sun = std::get<DistantLight>(light.model);
      lit(sun.irradiance, energy);
      expect_near(sun.direction, direction, "direction");
    } else if (lamp.at("type") == "POINT") {
      const auto& point = std::get<PointLight>(light.model);
      lit(point.intensity, energy / (4 * std::numbers::pi));
      expect_near(point.position, position, "position");
    } else {
      const auto& spot = std::get<SpotLight>(light.model);
      lit(spot.intensity, energy / (4 * std::numbers::pi));
      expect_near(spot.position, position, "position");
      expect_near(spot.direction, direction, "direction");
      const double outer = 0.5 * lamp.at("spot_size").get<double>();
      EXPECT_NEAR(spot.total_angle, outer, kDigits);
      EXPECT_NEAR(spot.falloff_start_angle, outer * (1 - lamp.at("spot_blend").get<double>()),
                  kDigits);
    }
  }
}

TEST(Blender, ACameraOfGltf) {
  const Json theirs = blenders().at("cameras").at("eye");
  const Camera& camera = ours().view.camera;
  EXPECT_NEAR(fov_of(camera), theirs.at("angle_y"), kDigits);
  const glm::dmat4& m = camera.world_from_camera;
  expect_near(glm::dvec3(m[0]), column(theirs.at("matrix"), 0), "right");
  expect_near(glm::dvec3(m[1]), column(theirs.at("matrix"), 1), "up");
  expect_near(glm::dvec3(m[2]), -column(theirs.at("matrix"), 2), "forward");
  expect_near(glm::dvec3(m[3]), column(theirs.at("matrix"), 3), "eye");
}

}  // namespace
}  // namespace caplet
