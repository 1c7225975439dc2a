// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The automatic camera sees everything, as large as fits, from a sensible side; the studio light
// stays out of the picture.
#include "present/present.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <random>

#include "import/detail/importers.h"
#include "present/turntable.h"
#include "support/import_files.h"

namespace caplet {
namespace {

Scene capsules_scene(const CapsulesShape& capsules, int width, int height) {
  Scene scene;
  scene.materials.push_back({DiffuseMaterial{}, "m", {}});
  Shape shape;
  shape.geometry = capsules;
  scene.shapes.push_back(shape);
  scene.view.film.width = width;
  scene.view.film.height = height;
  add_presentation(scene);
  return scene;
}

/// Random capsules in a box of the given half extents.
CapsulesShape cloud(const glm::vec3& half, int count, float radius, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto point = [&] {
    return half * glm::vec3(unit(random), unit(random), unit(random)) + glm::vec3(100, -50, 7);
  };
  CapsulesShape capsules;
  for (int i = 0; i < count; ++i) {
    capsules.p0.push_back(point());
    capsules.p1.push_back(point());
    capsules.radius0.push_back(radius);
  }
  return capsules;
}

/// Largest |x| / (width / shorter) and |y| / (height / shorter) on the image plane of the points of
/// all end spheres: 1 is the edge of the film. By projecting points of the spheres, where the code
/// under test uses planes.
glm::dvec2 reach(const Scene& scene) {
  const glm::dmat4 camera_from_world = glm::inverse(scene.view.camera.world_from_camera);
  const double shorter = std::min(scene.view.film.width, scene.view.film.height),
               tangent = std::tan(fov_of(scene.view.camera) / 2);
  const glm::dvec2 edge(tangent * scene.view.film.width / shorter,
                        tangent * scene.view.film.height / shorter);
  glm::dvec2 most(0);
  const CapsulesShape capsules = test::capsules_of(scene);
  for (std::size_t i = 0; i < capsules.p0.size(); ++i)
    for (const glm::vec3& end : {capsules.p0[i], capsules.p1[i]})
      for (int step = 0; step < 64; ++step)
        for (int ring = 1; ring < 16; ++ring) {
          const double phi = step * std::numbers::pi / 32, theta = ring * std::numbers::pi / 16;
          const glm::dvec3 offset(std::sin(theta) * std::cos(phi), std::cos(theta),
                                  std::sin(theta) * std::sin(phi));
          const glm::dvec4 p =
              camera_from_world *
              glm::dvec4(glm::dvec3(end) + offset * double{capsules.radius0[i]}, 1);
          EXPECT_GT(p.z, 0);
          most = glm::max(most, glm::abs(glm::dvec2(p) / p.z) / edge);
        }
  return most;
}

struct Size {
  int width, height;
};

class Framing : public testing::TestWithParam<Size> {};

TEST_P(Framing, EverythingFitsAndFillsTheFilm) {
  const Size size = GetParam();
  for (const glm::vec3& half :
       {glm::vec3(10, 10, 10), glm::vec3(50, 20, 1), glm::vec3(1, 40, 3), glm::vec3(30, 1, 30)}) {
    SCOPED_TRACE(testing::Message() << half.x << " " << half.y << " " << half.z);
    const glm::dvec2 most =
        reach(capsules_scene(cloud(half, 40, 0.5F, 7), size.width, size.height));
    // A margin of 5 % of the half image on the axis that binds; sampled points of a sphere miss its
    // silhouette by little.
    EXPECT_LE(most.x, 0.951);
    EXPECT_LE(most.y, 0.951);
    EXPECT_GE(std::max(most.x, most.y), 0.93);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Framing,
                         testing::Values(Size{960, 540}, Size{540, 960}, Size{512, 512},
                                         Size{2000, 400}));

TEST(FramingAgain, FollowsTheFilmAlone) {
  Scene scene = capsules_scene(cloud({50, 20, 1}, 40, 0.5F, 3), 960, 540);
  const Camera before = scene.view.camera;
  scene.view.film.width = 540;
  frame_camera(scene);
  EXPECT_EQ(scene.view.camera.world_from_camera[2], before.world_from_camera[2])
      << "the direction depends on the shapes alone";
  EXPECT_NE(scene.view.camera.world_from_camera[3], before.world_from_camera[3]);
  EXPECT_LE(std::max(reach(scene).x, reach(scene).y), 0.951);
  scene.view.film.width = 960;
  frame_camera(scene);
  EXPECT_EQ(scene.view.camera.world_from_camera, before.world_from_camera);
}

// Small boxes placed over a ball are framed as the capsules of no length in their middles are,
// not as the bounds of all of them.
TEST(FramingInstances, IsAsTightAsThatOfShapes) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  Scene placed;
  placed.materials.push_back({DiffuseMaterial{}, "m", {}});
  Shape shape;
  shape.geometry = BoxShape{glm::vec3(-1e-3F), glm::vec3(1e-3F)};
  placed.objects.push_back({"o", {shape}, {}});
  CapsulesShape points;
  for (int i = 0; i < 400; ++i) {
    const glm::vec3 at(glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))) *
                       glm::dvec3(3, 2, 1));
    Instance instance;
    instance.world_from_object = glm::translate(glm::dmat4(1), glm::dvec3(at));
    placed.instances.push_back(instance);
    points.p0.push_back(at);
    points.p1.push_back(at);
    points.radius0.push_back(1e-3F);
  }
  placed.view.film.width = 320;
  placed.view.film.height = 240;
  add_presentation(placed);
  const Scene expected = capsules_scene(points, 320, 240);
  const glm::dmat4 &seen = placed.view.camera.world_from_camera,
                   &wanted = expected.view.camera.world_from_camera;
  // A corner lies 1.7e-3 from the middle, a plane of the view at least 18 degrees from its axis.
  for (int i = 0; i < 4; ++i)
    EXPECT_LT(glm::distance(glm::dvec3(seen[i]), glm::dvec3(wanted[i])), 0.01) << i;
}

TEST(FramingInstances, HoldsAllPlacesOfOneThatMoves) {
  Scene scene;
  scene.materials.push_back({DiffuseMaterial{}, "m", {}});
  Shape shape;
  shape.geometry = BoxShape{glm::vec3(-1), glm::vec3(1)};
  scene.objects.push_back({"o", {shape}, {}});
  Instance instance;
  instance.motion = {{0, glm::dmat4(1)}, {1, glm::translate(glm::dmat4(1), glm::dvec3(40, 0, 0))}};
  scene.instances.push_back(instance);
  add_presentation(scene);
  const glm::dmat4 camera_from_world = glm::inverse(scene.view.camera.world_from_camera);
  const double edge = std::tan(fov_of(scene.view.camera) / 2) * scene.view.film.width /
                      std::min(scene.view.film.width, scene.view.film.height);
  for (const double x : {-1.0, 41.0}) {
    const glm::dvec4 seen = camera_from_world * glm::dvec4(x, 0, 0, 1);
    EXPECT_GT(seen.z, 0) << x;
    EXPECT_LT(std::abs(seen.x / seen.z), edge) << x;
  }
}

TEST(FramingDirection, FlatScenesAreSeenFaceOn) {
  const std::array<glm::vec3, 3> halves = {glm::vec3(1, 30, 40), glm::vec3(40, 1, 30),
                                           glm::vec3(30, 40, 1)};
  for (int thin = 0; thin < 3; ++thin) {
    const Scene scene =
        capsules_scene(cloud(halves[static_cast<std::size_t>(thin)], 200, 0.1F, 5), 960, 540);
    EXPECT_GT(std::abs(scene.view.camera.world_from_camera[2][thin]),
              std::cos(15 * std::numbers::pi / 180))
        << thin;
  }
}

TEST(FramingDirection, UpIsYAndTheWorldIsNotMirrored) {
  const Scene scene = capsules_scene(cloud({30, 40, 10}, 200, 0.1F, 5), 960, 540);
  const glm::dmat3 axes(scene.view.camera.world_from_camera);
  EXPECT_GT(axes[1].y, 0.8);
  EXPECT_NEAR(axes[0].y, 0, 1e-12);
  // Right, up and toward the viewer are right-handed; forward is the opposite of the last.
  EXPECT_NEAR(glm::determinant(axes), -1, 1e-12);
}

// The soma is at (1, 2, 3); of the apical dendrite 10 go along (0, 3, 4) / 5, and a side branch of
// 2 and one of 2 the other way cancel. The basal dendrite is longer.
TEST(FramingDirection, UpIsAlongTheApicalDendriteOnRequest) {
  const std::string neuron =
      "1 1 1 2 3 0.5 -1\n2 3 1 2 -40 0.1 1\n3 4 1 5 7 0.1 1\n4 4 1 8 11 0.1 3\n"
      "5 4 3 5 7 0.1 3\n6 4 -1 5 7 0.1 3\n";
  const auto seen = [](const std::string& text, const char* up) {
    return import_scene(test::write_file("n.swc", text), test::NoImages(), {{{"up", up}}});
  };
  const Scene scene = seen(neuron, "apical");
  ASSERT_TRUE(scene.framing.up);
  EXPECT_LT(glm::distance(*scene.framing.up, glm::dvec3(0, 0.6, 0.8)), 1e-6);
  // Turned by 18 degrees towards the viewer (FramingDirection), never to a side.
  const glm::dmat4& camera = scene.view.camera.world_from_camera;
  EXPECT_GT(glm::dot(glm::dvec3(camera[1]), *scene.framing.up), 0.9);
  EXPECT_LT(std::abs(glm::dot(glm::dvec3(camera[0]), *scene.framing.up)), 1e-6);
  EXPECT_THAT(test::complaint([&] { seen("1 1 0 0 0 1 -1\n2 3 0 9 0 1 1\n", "apical"); }),
              testing::HasSubstr("--up: "));
  EXPECT_THAT(test::complaint([&] { seen("1 1 0 0 0 1 -1\n2 3 0 9 0 1 1\n", "apical"); }),
              testing::HasSubstr("n.swc has no apical dendrite (samples of type 4)"));
  EXPECT_THAT(test::complaint([&] { seen(neuron, "apicl"); }),
              testing::HasSubstr("none of: x, y, z, -x, -y, -z, apical; the nearest is 'apical'"));
  EXPECT_THAT(test::complaint([&] {
                import_scene(test::write_file("n.xyz", "1\n\nC 0 0 0\n"), test::NoImages(),
                             {{{"up", "apical"}}});
              }),
              testing::HasSubstr("--up: apical is for one file of a neuron"));
}

TEST(FramingDegenerate, OneSphereAndOnePointCloudOnALine) {
  Scene sphere;
  sphere.materials.push_back({DiffuseMaterial{}, "m", {}});
  Shape shape;
  shape.geometry = SphereShape{2};
  sphere.shapes.push_back(shape);
  add_presentation(sphere);
  const glm::dvec3 eye(sphere.view.camera.world_from_camera[3]);
  // The sphere touches the margin above and below: sin(angle) = radius / distance.
  const double angle = std::atan(0.95 * std::tan(fov_of(sphere.view.camera) / 2));
  EXPECT_NEAR(glm::length(eye), 2 / std::sin(angle), 1e-9);

  for (const glm::vec3& along :
       {glm::vec3(9, 0, 0), glm::vec3(0, 9, 0), glm::vec3(0, 0, 9), glm::vec3(3, 3, 3)}) {
    CapsulesShape line;
    line.p0 = {-along};
    line.p1 = {along};
    line.radius0 = {0.25F};
    const glm::dvec2 most = reach(capsules_scene(line, 960, 540));
    EXPECT_LE(std::max(most.x, most.y), 0.951);
    EXPECT_GE(std::max(most.x, most.y), 0.93);
  }
}

const EnvironmentImage& studio_of(const Scene& scene) {
  return *std::get<InfiniteLight>(scene.lights.at(0).model).image;
}

/// The studio's radiance from a world direction (nearest texel), by the convention of
/// EnvironmentImage.
glm::dvec3 radiance_from(const Scene& scene, const glm::dvec3& world) {
  const auto& light = std::get<InfiniteLight>(scene.lights.at(0).model);
  const glm::dvec3 d = glm::transpose(light.world_from_light) * glm::normalize(world);
  const double u = std::fmod(std::atan2(d.y, d.x) / (2 * std::numbers::pi) + 1, 1.0),
               v = std::acos(d.z) / std::numbers::pi;
  const EnvironmentImage& image = studio_of(scene);
  const int column = std::min(static_cast<int>(u * image.width), image.width - 1);
  const int row = std::min(static_cast<int>(v * image.height), image.height - 1);
  const float* texel = &image.rgb[3 * static_cast<std::size_t>(row * image.width + column)];
  return {texel[0], texel[1], texel[2]};
}

TEST(Studio, BackgroundIsDimAndEvenInTheFrame) {
  for (const Size size : {Size{960, 540}, Size{540, 960}, Size{512, 512}}) {
    const Scene scene = capsules_scene(cloud({30, 40, 10}, 50, 0.1F, 5), size.width, size.height);
    const glm::dmat3 axes(scene.view.camera.world_from_camera);
    const double shorter = std::min(size.width, size.height),
                 tangent = std::tan(fov_of(scene.view.camera) / 2);
    const glm::dvec3 center = radiance_from(scene, axes[2]);
    EXPECT_GT(center.x, 0.005);
    EXPECT_LT(center.z, 0.1);
    for (int i = -10; i <= 10; ++i)
      for (int j = -10; j <= 10; ++j) {
        const glm::dvec3 direction = axes[2] + axes[0] * (tangent * size.width / shorter * i / 10) +
                                     axes[1] * (tangent * size.height / shorter * j / 10);
        EXPECT_EQ(radiance_from(scene, direction), center) << i << " " << j;
      }
  }
}

TEST(Studio, ASurfaceFacingTheKeyIsWellExposed) {
  const Scene scene = capsules_scene(cloud({30, 40, 10}, 50, 0.1F, 5), 960, 540);
  const glm::dmat3 axes(scene.view.camera.world_from_camera);
  const double elevation = 42 * std::numbers::pi / 180, azimuth = -48 * std::numbers::pi / 180;
  const glm::dvec3 normal = axes[0] * (std::sin(azimuth) * std::cos(elevation)) +
                            axes[1] * std::sin(elevation) -
                            axes[2] * (std::cos(azimuth) * std::cos(elevation));
  // Irradiance by a midpoint sum over directions.
  double irradiance = 0;
  constexpr int kRows = 200;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < 2 * kRows; ++column) {
      const double theta = std::numbers::pi * (row + 0.5) / kRows,
                   phi = std::numbers::pi * (column + 0.5) / kRows;
      const glm::dvec3 d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                         std::cos(theta));
      const double cosine = glm::dot(d, normal);
      if (cosine > 0)
        irradiance += radiance_from(scene, d).y * cosine * std::sin(theta) *
                      std::pow(std::numbers::pi / kRows, 2);
    }
  const double shown = 0.6 / std::numbers::pi * irradiance;
  EXPECT_GT(shown, 0.55);
  EXPECT_LT(shown, 0.8);
}

// Two rims of a cylinder that stands on y, of small balls: all of it is seen in each frame, and in
// one of them nearly to the margin. The balls' radius is a thousandth of the cylinder's.
TEST_P(Framing, OfATurntable) {
  const auto [width, height] = GetParam();
  CapsulesShape rims;
  for (const float y : {-3.0F, 2.0F})
    for (const float x : {-5.0F, 5.0F}) rims.p0.push_back(glm::vec3(x, y, 0) + glm::vec3(7, 8, 9));
  rims.p1 = rims.p0;
  rims.radius0.assign(rims.p0.size(), 0.005F);
  Scene scene = capsules_scene(rims, width, height);
  const Turntable table(scene);
  const int count = 48;
  glm::dvec2 most(0);
  const Camera first = table.camera(0, count);
  for (int i = 0; i < count; ++i) {
    scene.view.camera = table.camera(static_cast<std::uint32_t>(i), count);
    most = glm::max(most, reach(scene));
    // Around the vertical axis through the middle of the bounds, to the camera's right: seen from
    // above against the clock.
    const double angle = 2 * std::numbers::pi * i / count;
    const glm::dvec3 middle(7, 7.5, 9), from = glm::dvec3(first.world_from_camera[3]) - middle;
    const glm::dvec3 to(std::cos(angle) * from.x + std::sin(angle) * from.z, from.y,
                        -std::sin(angle) * from.x + std::cos(angle) * from.z);
    EXPECT_LT(glm::length(glm::dvec3(scene.view.camera.world_from_camera[3]) - middle - to),
              1e-4 * glm::length(from))
        << i;
  }
  // The rims are held by polygons of 64 sides, which are a thousandth wider.
  EXPECT_LE(std::max(most.x, most.y), 0.951);
  EXPECT_GE(std::max(most.x, most.y), 0.945);
}

TEST(Palette, ColoursAreReflectancesAndDiffer) {
  for (std::size_t i = 0; i < 10; ++i) {
    const glm::dvec3 color = palette_color(i);
    EXPECT_GT(std::min({color.x, color.y, color.z}), 0.0);
    EXPECT_LT(std::max({color.x, color.y, color.z}), 0.9);
    EXPECT_EQ(palette_color(i + 10), color);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT(glm::length(color - palette_color(j)), 0.1) << i << " " << j;
  }
}

}  // namespace
}  // namespace caplet
