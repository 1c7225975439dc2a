// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Normals at the vertices of meshes (docs/decisions/0023): on open meshes no light is lost, and
// closed opaque ones let none through.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "film/develop.h"
#include "lower/lower.h"
#include "render_scene.h"
#include "support/thorough.h"

namespace caplet::test::shading_normals_test {
namespace {

using std::numbers::pi;

const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
const std::string from_above =
    "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-0.5 0.5 -0.5 "
    "0.5]\n";
const std::string from_aside =
    "LookAt 4 0 3  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 20\n";

/// This has something of each kind that is too far away and too small to matter, so that all scenes
/// have the same kernels.
const std::string some_of_each =
    "AttributeBegin Translate 0 300 0\n"
    "Material \"conductor\" Shape \"sphere\" \"float radius\" 1e-3 Material \"dielectric\" Shape "
    "\"disk\" \"float radius\" 1e-3\n"
    "Material \"coateddiffuse\" Shape \"sphere\" \"float radius\" 1e-3 Material "
    "\"coatedconductor\" Shape \"sphere\" \"float "
    "radius\" 1e-3\n"
    "Material \"principled\" Shape \"sphere\" \"float radius\" 1e-3 Material "
    "\"diffusetransmission\" Shape \"sphere\" \"float "
    "radius\" 1e-3\n"
    "Material \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1e-3 0 0 0 1e-3 0 1e-3 1e-3 "
    "0]\n"
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1e-3 0 0 0 1e-3 0] \"integer indices\" [0 1 "
    "2]\nAttributeEnd\n";
/// The same with what makes the stages of media render a scene.
const std::string with_a_medium =
    some_of_each +
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0 0 0] \"rgb "
    "sigma_s\" [1 1 1]\n"
    "AttributeBegin MediumInterface \"fog\" \"\" Material \"interface\" Translate 0 300 0 Shape "
    "\"sphere\" \"float radius\" 1e-3 "
    "AttributeEnd\n";

std::string diffuse(double reflectance) {
  return fmt::format("Material \"diffuse\" \"rgb reflectance\" [{0} {0} {0}]\n", reflectance);
}

Mean green(const std::string& view, const std::string& world, int samples = 64, int depth = 100) {
  return mean_of(
      render_model(
          scene_of_text(fmt::format(
              "Integrator \"volpath\" \"integer maxdepth\" {}\n{}PixelFilter \"box\"\nFilm \"rgb\" "
              "\"integer xresolution\" 16 \"integer yresolution\" 16\nWorldBegin\n{}",
              depth, view, world)),
          samples)
          .image,
      "G");
}

/// A plate of a side of 2 h in the plane z = 0, its vertices with these normals.
std::string plate(const glm::dvec3& n, double h = 50) {
  return fmt::format(
      "Shape \"trianglemesh\" \"point3 P\" [-{0} -{0} 0  {0} -{0} 0  {0} {0} 0  -{0} {0} 0] "
      "\"integer indices\" [0 1 2  0 2 3]\n"
      "\"normal N\" [{1} {2} {3}  {1} {2} {3}  {1} {2} {3}  {1} {2} {3}]\n",
      h, n.x, n.y, n.z);
}

/// The same without normals, across n.
std::string plate_across(const glm::dvec3& n) {
  const glm::dvec3 z = glm::normalize(n),
                   x = 50.0 * glm::normalize(glm::cross(z, glm::dvec3(0.3, 1, 0.2))),
                   y = 50.0 * glm::normalize(glm::cross(z, x));
  std::string points;
  for (const glm::dvec3& p : {-x - y, x - y, x + y, y - x})
    points += fmt::format("{} {} {}  ", p.x, p.y, p.z);
  return "Shape \"trianglemesh\" \"point3 P\" [" + points +
         "] \"integer indices\" [0 1 2  0 2 3]\n";
}

/// A plate of some thickness, closed, each side of it with vertices of its own: the upper one's
/// normals lean.
std::string closed_plate(const glm::dvec3& n) {
  std::string points, normals, indices;
  int count = 0;
  const auto face = [&](std::initializer_list<glm::dvec3> corners, const glm::dvec3& normal) {
    for (const glm::dvec3& p : corners) points += fmt::format("{} {} {}  ", p.x, p.y, p.z);
    for (int k = 0; k < 4; ++k) normals += fmt::format("{} {} {}  ", normal.x, normal.y, normal.z);
    for (const int k : {0, 1, 2, 0, 2, 3}) indices += fmt::format("{} ", count + k);
    count += 4;
  };
  const double h = 50, z = -0.01;
  face({{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}}, n);
  face({{-h, -h, z}, {-h, h, z}, {h, h, z}, {h, -h, z}}, {0, 0, -1});
  face({{-h, -h, z}, {h, -h, z}, {h, -h, 0}, {-h, -h, 0}}, {0, -1, 0});
  face({{-h, h, z}, {-h, h, 0}, {h, h, 0}, {h, h, z}}, {0, 1, 0});
  face({{-h, -h, z}, {-h, -h, 0}, {-h, h, 0}, {-h, h, z}}, {-1, 0, 0});
  face({{h, -h, z}, {h, h, z}, {h, h, 0}, {h, -h, 0}}, {1, 0, 0});
  return "Shape \"trianglemesh\" \"point3 P\" [" + points + "] \"normal N\" [" + normals +
         "] \"integer indices\" [" + indices + "]\n";
}

/// A sphere of radius 1 as 8 times 4^levels triangles, the last `open` of them left out: corners on
/// the sphere, normals the sphere's. Each triangle has vertices of its own.
std::string ball(int levels, std::size_t open = 0) {
  std::vector<std::array<glm::dvec3, 3>> faces;
  for (const double x : {1, -1})
    for (const double y : {1, -1})
      for (const double z : {1, -1}) {
        const glm::dvec3 a(x, 0, 0), b(0, y, 0), c(0, 0, z);
        faces.push_back(x * y * z > 0 ? std::array{a, b, c} : std::array{a, c, b});
      }
  for (int level = 0; level < levels; ++level) {
    std::vector<std::array<glm::dvec3, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const glm::dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c),
                       ca = glm::normalize(c + a);
      for (const auto& face : {std::array{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}})
        finer.push_back(face);
    }
    faces = std::move(finer);
  }
  std::string points, indices;
  for (std::size_t i = 0; i + open < faces.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      points += fmt::format("{} {} {}  ", faces[i][k].x, faces[i][k].y, faces[i][k].z);
      indices += fmt::format("{} ", 3 * i + k);
    }
  return "Shape \"trianglemesh\" \"point3 P\" [" + points + "] \"normal N\" [" + points +
         "] \"integer indices\" [" + indices + "]\n";
}

const char* const opaque[] = {"\"diffuse\" \"rgb reflectance\" [0.8 0.8 0.8]",
                              "\"conductor\"",
                              "\"conductor\" \"float roughness\" 0.1",
                              "\"coateddiffuse\"",
                              "\"coatedconductor\" \"float conductor.roughness\" 0.2",
                              "\"principled\" \"float metallic\" 0.3",
                              "\"diffusetransmission\" \"rgb transmittance\" [0 0 0]"};

// Under a sky of 1 a surface sends back its reflectance, wherever its normals point: also what goes
// beneath the surface is met by the sky. (The part of a cosine lobe around n that is above the
// surface is (1 + n.z) / 2: without the rest 0.487, 0.474, 0.394 and 0.362 come back.)
TEST(ShadingNormals, OpenMeshesReflectAllOfASky) {
  for (const std::string& medium : {some_of_each, with_a_medium})
    for (const glm::dvec3& n :
         {glm::dvec3(1. / 3, 0, 1), {0.5, 0, 1}, {1, 1, 1}, {2, 0, 1}, {-2, 0, -1}}) {
      const Mean mean =
          green(n.x < 1 ? from_above : from_aside, sky + medium + diffuse(0.5) + plate(n));
      EXPECT_NEAR(mean.value, 0.5, 1e-4) << n.x << ' ' << n.y << ' ' << n.z;
    }
}

// Normals anywhere within 0.5 of straight up, another at each vertex.
TEST(ShadingNormals, AnOpenMeshOfUnevenNormalsReflectsAllOfASky) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> u(-0.5, 0.5);
  std::string points, normals, indices;
  constexpr int side = 12;
  for (int j = 0; j <= side; ++j)
    for (int i = 0; i <= side; ++i) {
      points += fmt::format("{} {} 0  ", 2. * i / side - 1, 2. * j / side - 1);
      const double x = u(engine);
      normals += fmt::format("{} {} 1  ", x, u(engine));
    }
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const int a = j * (side + 1) + i, b = a + side + 1;
      indices += fmt::format("{} {} {}  {} {} {}  ", a, a + 1, b + 1, a, b + 1, b);
    }
  const std::string mesh = "Shape \"trianglemesh\" \"point3 P\" [" + points + "] \"normal N\" [" +
                           normals + "] \"integer indices\" [" + indices + "]\n";
  EXPECT_NEAR(green(from_above, sky + some_of_each + diffuse(0.5) + mesh).value, 0.5, 1e-4);
}

// A bilinear patch likewise.
TEST(ShadingNormals, OpenPatchesReflectAllOfASky) {
  const std::string patch =
      "Shape \"bilinearmesh\" \"point3 P\" [-9 -9 0  9 -9 0  -9 9 0  9 9 0] \"normal N\" [2 0 1  2 "
      "0 1  2 0 1  2 0 1]\n";
  EXPECT_NEAR(green(from_above, sky + some_of_each + diffuse(0.5) + patch).value, 0.5, 1e-4);
}

// Whatever the material, an even sky cannot tell a plate whose normals lean from one that leans.
TEST(ShadingNormals, AnOpenPlateLooksLikeOneThatLeans) {
  const int samples = thorough() ? 1024 : 256;
  const glm::dvec3 n(0.9, 0.3, 1);
  for (const std::string material :
       {"\"conductor\" \"float roughness\" 0.3", "\"conductor\"",
        "\"dielectric\" \"float roughness\" 0.2", "\"dielectric\"",
        "\"diffusetransmission\" \"rgb reflectance\" [0.3 0.3 0.3] \"rgb transmittance\" [0.4 0.4 "
        "0.4]",
        "\"coateddiffuse\" \"float roughness\" 0.2",
        "\"coatedconductor\" \"float conductor.roughness\" 0.2",
        "\"principled\" \"float spec_trans\" 0.5 \"float roughness\" 0.6"})
    for (const std::string& medium : {some_of_each, with_a_medium}) {
      const std::string world = sky + medium + "Material " + material + "\n";
      const Mean leaning = green(from_above, world + plate(n), samples),
                 expected = green(from_above, world + plate_across(n), samples);
      const double error = std::hypot(leaning.error, expected.error);
      EXPECT_NEAR(leaning.value, expected.value, 4.5 * error + 1e-4) << material;
      EXPECT_LT(error, (thorough() ? 5e-3 : 1e-2) * expected.value) << material;
    }
}

// Lights that are beneath an open plate, on the outer side of its leaning normals, light it by the
// cosine to these: a L cos / pi of irradiance L across the light, and a I cos / (pi d^2).
TEST(ShadingNormals, OpenMeshesAreLitFromBeneath) {
  const glm::dvec3 n(0.95, 0, 0.3);
  const std::string far_light =
                        "LightSource \"distant\" \"rgb L\" [9 9 9] \"point3 from\" [3 0 -1] "
                        "\"point3 to\" [0 0 0]\n",
                    near_light =
                        "LightSource \"point\" \"rgb I\" [9 9 9] \"point3 from\" [50 0 -10]\n";
  const double cosine = glm::dot(glm::normalize(n), glm::normalize(glm::dvec3(3, 0, -1))),
               of_plate = 0.5 / pi * 9;
  const std::string view =
      "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-0.01 0.01 "
      "-0.01 0.01]\n";
  for (const std::string& medium : {some_of_each, with_a_medium}) {
    EXPECT_NEAR(green(view, far_light + medium + diffuse(0.5) + plate(n, 1)).value,
                of_plate * cosine, 2e-4 * of_plate);
    EXPECT_NEAR(
        green(view, near_light + medium + diffuse(0.5) + plate(n, 1)).value,
        of_plate * glm::dot(glm::normalize(n), glm::normalize(glm::dvec3(50, 0, -10))) / 2600,
        1e-3 * of_plate / 2600);
  }
}

// Both lights are below the opaque plate, on the outer side of its leaning normals.
TEST(ShadingNormals, LetNoLightSampleThrough) {
  for (const std::string& medium : {some_of_each, with_a_medium})
    for (const std::string light :
         {"LightSource \"point\" \"rgb I\" [9 9 9] \"point3 from\" [5 0 -0.005]\n",
          "LightSource \"distant\" \"rgb L\" [9 9 9] \"point3 from\" [3 0 -1] \"point3 to\" [0 0 "
          "0]\n"})
      EXPECT_EQ(
          green(from_aside, light + medium + diffuse(0.5) + closed_plate({0.95, 0, 0.3})).value, 0)
          << light;
}

// A lamp within the plate, which is met by scattered rays alone: it has no chance of being sampled.
TEST(ShadingNormals, LetNoScatteredRayThrough) {
  for (const std::string& medium : {some_of_each, with_a_medium}) {
    const Scene scene =
        scene_of_text("Integrator \"volpath\" \"integer maxdepth\" 8\n" + from_aside +
                      "PixelFilter \"box\"\nFilm \"rgb\" \"integer xresolution\" 16 \"integer "
                      "yresolution\" 16\nWorldBegin\n" +
                      medium + diffuse(0.5) + closed_plate({0.95, 0, 0.3}) +
                      "AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] \"bool twosided\" true "
                      "Translate 0 0 -0.005 Shape \"disk\" "
                      "\"float radius\" "
                      "50\n");
    FlatScene flat = lower(scene);
    const FlatView view = lower_view(scene);
    flat.lighting.sampled_light_count = 0;
    RenderOptions options;
    options.samples_per_pixel = 64;
    EXPECT_EQ(mean_of(develop(render(flat, view, test_device(), options, {}).film, scene.view.film,
                              Layers::all()),
                      "G")
                  .value,
              0);
  }
}

// A lamp in a ball of coarse triangles whose normals are a smooth one's: outside all is dark, not
// by little but by all. From inside, the sky is not seen. Light samples and scattered rays,
// mirrors, coats and what principled makes of its parameters.
TEST(ShadingNormals, ClosedOpaqueMeshesLetNoLightThrough) {
  const std::string lamp =
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] Shape \"sphere\" \"float "
      "radius\" 0.4 AttributeEnd\n"
      "LightSource \"point\" \"rgb I\" [9 9 9] \"point3 from\" [0.2 0.1 0.5]\n";
  const std::string outside =
      "LookAt 1 2 5  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-1.3 1.3 -1.3 "
      "1.3]\n";
  const std::string within =
      "LookAt 0 0.1 0  0.3 1 0.2  0 0 1\nCamera \"perspective\" \"float fov\" 120\n";
  for (const std::string material : opaque)
    for (const std::string& medium : {some_of_each, with_a_medium}) {
      const std::string world = medium + "Material " + material + "\n" + ball(1);
      EXPECT_EQ(green(outside, lamp + world, 64, 20).value, 0) << material << medium;
      EXPECT_EQ(green(within, sky + world, 64, 20).value, 0) << material << medium;
    }
}

// With a face taken away the same ball is open, and goes by its normals: light comes out beside the
// hole too.
TEST(ShadingNormals, OpenBallsGoByTheirNormals) {
  const std::string lamp =
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] Shape \"sphere\" \"float "
      "radius\" 0.4 AttributeEnd\n";
  const std::string from_the_other_side =
      "LookAt 5 5 5  0 0 0  0 0 1\nCamera \"orthographic\" \"float screenwindow\" [-1.3 1.3 -1.3 "
      "1.3]\n";
  EXPECT_GT(
      green(from_the_other_side, lamp + some_of_each + diffuse(0.8) + ball(1, 1), 256, 20).value,
      1e-4);
}

// A mirror that reflects all but 4e-4 is not to be seen under an even sky, its rim included, where
// what is reflected goes beneath the surface: dropped, it would leave 6 % of this ball dark.
TEST(ShadingNormals, RimsOfMirrorsAreNotDark) {
  const std::string mirror =
      "Material \"conductor\" \"spectrum eta\" [300 1 900 1] \"spectrum k\" [300 100 900 100]\n";
  const std::string view =
      "LookAt 1 2 5  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-1.3 1.3 -1.3 "
      "1.3]\n";
  for (const std::string& medium : {some_of_each, with_a_medium})
    EXPECT_NEAR(green(view, sky + medium + mirror + ball(1)).value, 1, 1e-3);
}

// What lets light through and absorbs nothing takes nothing from an even sky, be its normals not
// those of its faces: of closed meshes of it too all directions go by them. Dropped, 3 % of the
// sheet's light would be missing.
TEST(ShadingNormals, ClosedMeshesThatLetLightThroughTakeNothing) {
  const std::string view =
      "LookAt 1 2 5  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-1.3 1.3 -1.3 "
      "1.3]\n";
  const std::string sheet =
      "Material \"diffusetransmission\" \"rgb reflectance\" [0.5 0.5 0.5] \"rgb transmittance\" "
      "[0.5 0.5 0.5]\n";
  for (const std::string& medium : {some_of_each, with_a_medium})
    for (const std::string& world : {sheet + ball(1), "Material \"dielectric\"\n" + ball(2)}) {
      const Mean mean = green(view, sky + medium + world, 256);
      EXPECT_NEAR(mean.value, 1, 4 * mean.error + 1e-3);
    }
  // With fog in it, which absorbs nothing.
  const std::string fog =
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0 0 0] \"rgb "
      "sigma_s\" [1 1 1]\n"
      "MediumInterface \"fog\" \"\" Material \"dielectric\"\n";
  const Mean mean = green(view, sky + some_of_each + fog + ball(2), 256, 1000);
  EXPECT_NEAR(mean.value, 1, 4 * mean.error + 3e-3);
}

// A ball of triangles over a floor beside the solid ball, under a sky. The mesh of 2,048 triangles
// is smaller: the middle of a triangle whose corners are 0.076 apart lies 0.001 within the sphere,
// and of what is hidden or seen of it no more than some three times that is another.
TEST(ShadingNormals, ASmoothMeshOverAFloorIsTheBall) {
  const std::string view =
      "LookAt 0 -5 2  0 0 0.6  0 0 1\nCamera \"perspective\" \"float fov\" 40\n";
  const std::string floor = sky + diffuse(0.5) + "Shape \"disk\" \"float radius\" 20\n" +
                            diffuse(0.9) + "Translate 0 0 1\n";
  for (const std::string& medium : {some_of_each, with_a_medium}) {
    const Mean solid = green(view, medium + floor + "Shape \"sphere\" \"float radius\" 1\n", 1024),
               mesh = green(view, medium + floor + ball(4), 1024);
    EXPECT_NEAR(mesh.value, solid.value,
                4.5 * std::hypot(mesh.error, solid.error) + 3e-3 * solid.value);
  }
}

}  // namespace
}  // namespace caplet::test::shading_normals_test
