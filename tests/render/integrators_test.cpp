// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Integrators beside the path tracer: ambient occlusion against closed forms, and those without
// multiple importance sampling against the path tracer.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "render_scene.h"

namespace caplet::test::integrators_test {
namespace {

/// A narrow view of the floor around (2, 0, 0), from the side.
std::string looking_at_floor(const std::string& integrator) {
  return "Integrator " + integrator +
         "\nLookAt 2 -5 2  2 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 0.2\nPixelFilter "
         "\"box\"\n"
         "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nSampler "
         "\"independent\"\nWorldBegin\n";
}

const std::string floor = "Shape \"disk\" \"float radius\" 1000\n";
const std::string resting_ball = "AttributeBegin Translate 0 0 1 Shape \"sphere\" AttributeEnd\n";

Mean mean_of_text(const std::string& text, int samples) {
  return mean_of(render_model(scene_of_text(text), samples).image, "G");
}

void expect_mean(const Mean& mean, double value) {
  EXPECT_NEAR(mean.value, value, 4 * mean.error + 1e-5);
  EXPECT_LT(mean.error, 0.01);
}

// The form factor of a sphere above a plane's horizon is the cosine times its squared radius over
// its squared distance.
TEST(AmbientOcclusion, OfABallOnAFloorIsItsFormFactor) {
  const double value = 1 - 1 / std::pow(5, 1.5);
  for (const char* more : {"", " \"bool cossample\" false", " \"float maxdistance\" 10"})
    expect_mean(mean_of_text(looking_at_floor("\"ambientocclusion\"" + std::string(more)) + floor +
                                 resting_ball,
                             1024),
                value);
  // Nothing is nearer than sqrt(5) - 1.
  expect_mean(mean_of_text(looking_at_floor("\"ambientocclusion\" \"float maxdistance\" 1.2") +
                               floor + resting_ball,
                           64),
              1);
}

// Beneath a ceiling at height 1 directions of a cosine below 1 / m reach beyond the distance m:
// their share is 1 / m^2.
TEST(AmbientOcclusion, EndsAtItsGreatestDistance) {
  const std::string ceiling =
      "AttributeBegin Translate 0 0 1 Shape \"disk\" \"float radius\" 1000 AttributeEnd\n";
  const std::string below =
      "Integrator \"ambientocclusion\" \"float maxdistance\" 2\nLookAt 2 -1 .5  2 0 0  0 0 1\n";
  std::string text = looking_at_floor("\"path\"");
  text = below + text.substr(text.find("Camera"));
  expect_mean(mean_of_text(text + floor + ceiling, 1024), 0.25);
}

// If a surface is seen from behind, the rays leave on that side.
TEST(AmbientOcclusion, IsOfTheSideThatIsSeen) {
  const std::string upright = looking_at_floor("\"ambientocclusion\"");
  const std::string below = upright.substr(0, upright.find("LookAt")) +
                            "LookAt 2 -5 -2  2 0 0  0 0 1\n" +
                            upright.substr(upright.find("Camera"));
  expect_mean(mean_of_text(below + floor + resting_ball, 64), 1);
  expect_mean(
      mean_of_text(
          below + floor + "AttributeBegin Translate 0 0 -1 Shape \"sphere\" AttributeEnd\n", 1024),
      1 - 1 / std::pow(5, 1.5));
}

// Lights, materials, bumps and media do not count, and there is nothing where no surface is.
TEST(AmbientOcclusion, IsOfTheShapesAlone) {
  const double value = 1 - 1 / std::pow(5, 1.5);
  const std::string smoke =
      "MakeNamedMedium \"smoke\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [1 1 1]\n";
  const std::string text = looking_at_floor("\"ambientocclusion\"");
  const std::string looks =
      "LightSource \"infinite\" \"rgb L\" [3 3 3]\nLightSource \"point\" \"point3 from\" [2 -2 2]\n"
      "Texture \"f\" \"float\" \"fbm\"\nMaterial \"conductor\" \"texture displacement\" \"f\"\n";
  expect_mean(mean_of_text(text + looks + "AreaLightSource \"diffuse\" \"rgb L\" [9 9 9]\n" +
                               floor + resting_ball,
                           1024),
              value);
  expect_mean(mean_of_text(text + looks + floor +
                               "AreaLightSource \"diffuse\" \"rgb L\" [9 9 9]\n" + resting_ball,
                           1024),
              value);
  const std::string fog = "Material \"diffuse\"\n" + smoke +
                          "AttributeBegin MediumInterface \"smoke\" \"\" Material \"interface\"\n" +
                          "Translate 2 0 0 Shape \"sphere\" \"float radius\" 0.7 AttributeEnd\n";
  // What lets light through is passed by rays of the camera; rays of occlusion end there, as
  // pbrt-v4's do.
  const Mean dark = mean_of_text(text + fog + floor, 256);
  EXPECT_EQ(dark.value, 0);
  const std::string beyond = text.substr(0, text.find("LookAt")) +
                             "LookAt 2 -5 2  2 -9 9  0 0 1\n" + text.substr(text.find("Camera"));
  EXPECT_EQ(mean_of_text(beyond + looks + floor, 16).value, 0);
}

// --- Without multiple importance sampling ---

std::string room(const std::string& integrator) {
  return "Integrator " + integrator +
         " \"integer maxdepth\" 3\nLookAt 0 -4 2  0 0 0.6  0 0 1\nCamera \"perspective\" \"float "
         "fov\" 50\nPixelFilter \"box\"\n"
         "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nSampler "
         "\"independent\"\nWorldBegin\n"
         "LightSource \"infinite\" \"rgb L\" [0.2 0.2 0.2]\n"
         // So large that light samples and scattered rays find it about as well.
         "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [0.4 0.4 0.4] ReverseOrientation "
         "Translate 0 0 3\n"
         "Shape \"disk\" \"float radius\" 6 AttributeEnd\n"
         "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\nShape \"disk\" \"float radius\" "
         "6\n"
         "AttributeBegin Material \"conductor\" \"float roughness\" 0.5 Translate -1 0 0.6 Shape "
         "\"sphere\" \"float radius\" 0.6 "
         "AttributeEnd\n"
         "AttributeBegin Material \"diffusetransmission\" Translate 1 0 0.6 Shape \"sphere\" "
         "\"float radius\" 0.6 AttributeEnd\n";
}

TEST(SimplePath, IsThePathTracersPicture) {
  const Mean path = mean_of_text(room("\"path\""), 512);
  for (const char* integrator :
       {"\"simplepath\"", "\"simplepath\" \"bool samplelights\" false",
        "\"simplepath\" \"bool samplebsdf\" false",
        "\"simplepath\" \"bool samplelights\" false \"bool samplebsdf\" false", "\"randomwalk\""}) {
    const Mean other = mean_of_text(room(integrator), 2048);
    EXPECT_NEAR(other.value, path.value, 4 * std::hypot(other.error, path.error)) << integrator;
    EXPECT_LT(other.error, 0.01 * path.value) << integrator;
    EXPECT_NE(other.value, path.value) << integrator;
  }
}

// As in pbrt-v4: what has no density is found by sampling it or not at all.
TEST(SimplePath, FindsPointsAndMirrorsBySamplingThemAlone) {
  const std::string lamp = "LightSource \"point\" \"point3 from\" [2 -3 4]\nMaterial \"diffuse\"\n";
  const auto light = [&](const std::string& integrator, const std::string& world) {
    return mean_of_text(looking_at_floor(integrator) + world + floor, 64).value;
  };
  EXPECT_GT(light("\"simplepath\"", lamp), 0.001);
  EXPECT_EQ(light("\"simplepath\" \"bool samplelights\" false", lamp), 0);
  EXPECT_EQ(light("\"randomwalk\"", lamp), 0);
  const std::string mirror =
      "LightSource \"infinite\"\nMaterial \"conductor\" \"float roughness\" 0\n";
  EXPECT_GT(light("\"simplepath\"", mirror), 0.1);
  EXPECT_EQ(light("\"simplepath\" \"bool samplebsdf\" false", mirror), 0);
}

// The same through media: a slab of smoke between the floor and the camera.
TEST(SimplePath, IsThePathTracersPictureInMedia) {
  const std::string smoke =
      "MakeNamedMedium \"smoke\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [.5 .5 .5] \"rgb "
      "sigma_a\" [.1 .1 .1]\n"
      "AttributeBegin MediumInterface \"smoke\" \"\" Material \"interface\" Translate 0 0 1 Shape "
      "\"sphere\" \"float radius\" 2 "
      "AttributeEnd\n";
  const Mean path = mean_of_text(room("\"volpath\"") + smoke, 512);
  for (const char* integrator : {"\"simplepath\"", "\"simplepath\" \"bool samplelights\" false"}) {
    const Mean other = mean_of_text(room(integrator) + smoke, 2048);
    EXPECT_NEAR(other.value, path.value, 4 * std::hypot(other.error, path.error)) << integrator;
    EXPECT_LT(other.error, 0.01 * path.value) << integrator;
  }
}

}  // namespace
}  // namespace caplet::test::integrators_test
