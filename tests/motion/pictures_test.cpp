// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pictures of moving things against closed forms, and against the mean of pictures of the scene
// frozen at many times.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "film/develop.h"
#include "lower/lower.h"
#include "render_scene.h"
#include "scene/frozen.h"
#include "support/environment.h"
#include "support/thorough.h"

namespace caplet::test {
namespace {

using glm::dvec2;

/// Looks down the z axis at [-2, 2] x [-2, 2], x to the right and y up.
const std::string from_above =
    "Scale -1 1 1\nLookAt 0 0 10  0 0 0  0 1 0\n"
    "Camera \"orthographic\" \"float screenwindow\" [-2 2 -2 2]\n"
    "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\n"
    "PixelFilter \"box\"\nIntegrator \"path\" \"integer maxdepth\" 3\n";
const std::string shining =
    "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
    "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n";

/// Compares each pixel with the share of the exposure and of the pixel's area at which `covers`
/// says that something is at a place.
void expect_coverage(const std::string& text,
                     const std::function<bool(const dvec2& at, double time)>& covers) {
  const int samples = 256;
  const Scene scene = scene_of_text(text);
  const Rendered ours = render_model(scene, samples);
  const Channel &green = channel(ours.image, "G"), &variance = channel(ours.image, "variance.G");
  double sum = 0, squares = 0, partly = 0, all = 0, expected_all = 0, noise = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(32 * y + x);
      int covered = 0;
      for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i)
          for (int k = 0; k < 64; ++k)
            covered +=
                covers({-2 + (x + (i + 0.5) / 8) / 8, 2 - (y + (j + 0.5) / 8) / 8}, (k + 0.5) / 64)
                    ? 1
                    : 0;
      const double expected = covered / 4096.0;
      all += green.floats[pixel];
      expected_all += expected;
      noise += variance.floats[pixel];
      if (covered == 0) {
        EXPECT_LT(green.floats[pixel], 0.01) << x << " " << y;  // less than a step of the sum
        continue;
      }
      // The luminance of the four wavelengths of a sample is noise as well; and the sum above is
      // off by a step of 1/64 of time at most.
      const double z = (green.floats[pixel] - expected) /
                       std::sqrt(variance.floats[pixel] + 1e-3 * 1e-3 + 0.25 / 64 / 64 / 64);
      sum += z;
      squares += z * z;
      ++partly;
    }
  EXPECT_NEAR(all / expected_all, 1, 4 * std::sqrt(noise) / expected_all + 0.002);
  EXPECT_LT(std::abs(sum / partly), 4 / std::sqrt(partly));
  EXPECT_LT(squares / partly, 1.7);
  EXPECT_GE(partly, 100);
}

double distance_to_segment(const dvec2& p, const dvec2& a, const dvec2& b) {
  const double s = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
  return glm::length(p - (a + s * (b - a)));
}

TEST(MotionPictures, OfASphereThatFalls) {
  expect_coverage(from_above + "WorldBegin\n" + shining +
                      "Translate -0.5 1.5 0\nActiveTransform EndTime\nTranslate 1 -2.5 0\n"
                      "Shape \"sphere\" \"float radius\" 0.4\n",
                  [](const dvec2& at, double time) {
                    return glm::length(at - (dvec2(-0.5, 1.5) + time * dvec2(1, -2.5))) < 0.4;
                  });
}

TEST(MotionPictures, OfACapsuleThatTurnsAndFalls) {
  expect_coverage(
      from_above + "WorldBegin\n" + shining +
          "Translate 0 0.75 0\nActiveTransform EndTime\nTranslate 0 -1 0\nRotate 120 0 0 1\n"
          "Shape \"capsule\" \"point3 p0\" [-1 0 0] \"point3 p1\" [1 0 0] \"float radius\" 0.2\n",
      [](const dvec2& at, double time) {
        const double angle = time * 120 * std::numbers::pi / 180;
        const dvec2 middle(0, 0.75 - time), half(std::cos(angle), std::sin(angle));
        return distance_to_segment(at, middle - half, middle + half) < 0.2;
      });
}

/// Returns whether a point is in the hull of two disks.
bool is_in_hull(const dvec2& p, const dvec2& a, const dvec2& b, double r0, double r1) {
  for (int k = 0; k <= 32; ++k) {
    const double s = k / 32.0;
    if (glm::length(p - (a + s * (b - a))) < r0 + s * (r1 - r0)) return true;
  }
  return false;
}

// One end rests and grows, the other one goes round a corner.
TEST(MotionPictures, OfACapsuleWhoseEndsMove) {
  expect_coverage(
      from_above + "WorldBegin\n" + shining +
          "Shape \"capsules\" \"float times\" [0 0.5 1] \"point3 p0\" [-1 -1 0 -1 -1 0 -1 -1 0]\n"
          "  \"point3 p1\" [-1 1 0  1 1 0  1 -0.5 0] \"float radius\" [0.2 0.2 0.6]\n"
          "  \"float radius1\" [0.2 0.3 0.1]\n",
      [](const dvec2& at, double time) {
        const double u = 2 * time, v = u - 1;
        const dvec2 end = u < 1 ? dvec2(-1 + 2 * u, 1) : dvec2(1, 1 - 1.5 * v);
        return is_in_hull(at, {-1, -1}, end, u < 1 ? 0.2 : 0.2 + 0.4 * v,
                          u < 1 ? 0.2 + 0.1 * u : 0.3 - 0.2 * v);
      });
}

TEST(MotionPictures, OfASphereThatGrows) {
  expect_coverage(from_above + "WorldBegin\n" + shining +
                      "Shape \"capsules\" \"float times\" [0 1] \"point3 p0\" [0 0 0 0 1 0]\n"
                      "  \"point3 p1\" [0 0 0 0 1 0] \"float radius\" [0.2 0.9]\n",
                  [](const dvec2& at, double time) {
                    return glm::length(at - dvec2(0, time)) < 0.2 + 0.7 * time;
                  });
}

// One corner rests, one goes right and one goes round a corner.
TEST(MotionPictures, OfATriangleWhoseCornersMove) {
  expect_coverage(
      from_above + "WorldBegin\n" + shining +
          "Shape \"trianglemesh\" \"float times\" [0 0.5 1]\n"
          "  \"point3 P\" [-1.5 -1.5 0  0 -1.5 0  -1.5 0.5 0   -1.5 -1.5 0  0.75 -1.5 0  1 1.5 0\n"
          "               -1.5 -1.5 0  1.5 -1.5 0  1 -0.5 0]\n",
      [](const dvec2& at, double time) {
        const double u = 2 * time;
        const dvec2 a(-1.5, -1.5), b(1.5 * time, -1.5),
            c = u < 1 ? glm::mix(dvec2(-1.5, 0.5), dvec2(1, 1.5), u)
                      : glm::mix(dvec2(1, 1.5), dvec2(1, -0.5), u - 1);
        const auto left_of = [&](const dvec2& from, const dvec2& to) {
          return (to.x - from.x) * (at.y - from.y) - (to.y - from.y) * (at.x - from.x) > 0;
        };
        return left_of(a, b) && left_of(b, c) && left_of(c, a);
      });
}

// A sheet that rests, whose normals turn away from a light behind the camera: they go straight from
// one end to the other, and are then as long as 1.
TEST(MotionPictures, OfNormalsThatMove) {
  const Scene scene = scene_of_text(
      from_above +
      "WorldBegin\nLightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [0 0 9]\n"
      "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"
      "Shape \"trianglemesh\" \"float times\" [0 1] \"integer indices\" [0 1 2 0 2 3]\n"
      "  \"point3 P\" [-9 -9 0 9 -9 0 9 9 0 -9 9 0  -9 -9 0 9 -9 0 9 9 0 -9 9 0]\n"
      "  \"normal N\" [0 0 3 0 0 3 0 0 3 0 0 3  4 0 3 4 0 3 4 0 3 4 0 3]\n");
  double expected = 0;
  for (int k = 0; k < 1000; ++k) {
    const double time = (k + 0.5) / 1000;
    const glm::dvec3 n = (1 - time) * glm::dvec3(0, 0, 1) + time * glm::dvec3(0.8, 0, 0.6);
    expected += 0.5 / std::numbers::pi * n.z / glm::length(n) / 1000;
  }
  const Mean mean = mean_of(render_model(scene, 64).image, "G");
  EXPECT_NEAR(mean.value, expected, 4 * mean.error + 1e-3 * expected);
  EXPECT_LT(mean.error, 0.003 * expected);
}

// Only while the shutter is open; and nothing moves before the first and after the last key.
TEST(MotionPictures, OfTheTimeThatTheShutterIsOpen) {
  std::string text = from_above;
  text.insert(text.find("Camera \"orthographic\"") + 21,
              " \"float shutteropen\" 2.5 \"float shutterclose\" 4.5");
  expect_coverage("TransformTimes 3 4\n" +
                      text.replace(text.find("Film \"rgb\""), 10, "Film \"rgb\" \"float iso\" 50") +
                      "WorldBegin\n" + shining +
                      "ActiveTransform EndTime\nTranslate 1.2 0 0\n"
                      "Shape \"sphere\" \"float radius\" 0.5\n",
                  [](const dvec2& at, double time) {
                    const double moved = std::clamp(2 * time - 0.5, 0.0, 1.0);
                    return glm::length(at - dvec2(1.2 * moved, 0)) < 0.5;
                  });
}

TEST(MotionPictures, OfACameraThatMoves) {
  std::string text = from_above;
  text.insert(0, "ActiveTransform EndTime\nTranslate 1 0.5 0\nActiveTransform All\n");
  expect_coverage(
      text + "WorldBegin\n" + shining + "Shape \"sphere\" \"float radius\" 0.5\n",
      // Camera space is moved, of which x points left of the picture before the mirror.
      [](const dvec2& at, double time) { return glm::length(at - time * dvec2(1, 0.5)) < 0.5; });
}

// Each row, or column, is exposed for half a second; the last one begins 1.5 seconds after the
// first.
TEST(MotionPictures, OfRollingShutters) {
  for (const std::string order : {"down", "up", "right", "left"}) {
    SCOPED_TRACE(order);
    std::string text = from_above;
    text.insert(text.find("Camera \"orthographic\"") + 21,
                " \"float shutterclose\" 0.5 \"float readout\" 1.5 \"string readoutorder\" \"" +
                    order + "\"");
    expect_coverage(
        "TransformTimes 0 2\n" +
            text.replace(text.find("Film \"rgb\""), 10, "Film \"rgb\" \"float iso\" 200") +
            "WorldBegin\n" + shining +
            "Translate -1.2 0.6 0\nActiveTransform EndTime\nTranslate 2.4 -1.2 0\n"
            "Shape \"sphere\" \"float radius\" 0.6\n",
        [&](const dvec2& at, double time) {
          const double row = std::floor((2 - at.y) * 8) + 0.5,
                       column = std::floor((at.x + 2) * 8) + 0.5;
          const double place = (order == "down"    ? row
                                : order == "up"    ? 32 - row
                                : order == "right" ? column
                                                   : 32 - column) /
                               32;
          const double seconds = 1.5 * place + 0.5 * time;
          return glm::length(at - (dvec2(-1.2, 0.6) + seconds / 2 * dvec2(2.4, -1.2))) < 0.6;
        });
  }
}

// The irradiance under a sphere of radiance L that is above the horizon is L pi sin^2(its half
// angle) cos(its angle to the normal), whatever else it does; here averaged over its way.
TEST(MotionPictures, OfTheLightOfALampThatMoves) {
  const Scene scene = scene_of_text(
      "Scale -1 1 1\nLookAt 0 0 10  0 0 0  0 1 0\n"
      "Camera \"orthographic\" \"float screenwindow\" [-0.01 0.01 -0.01 0.01]\n"
      "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nPixelFilter \"box\"\n"
      "Integrator \"path\" \"integer maxdepth\" 1\nWorldBegin\n"
      "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\nShape \"disk\" \"float radius\" 5\n"
      "AreaLightSource \"diffuse\" \"rgb L\" [10 10 10]\n"
      "Translate -3 0.5 1.5\nActiveTransform EndTime\nTranslate 5 0 1\nRotate 90 1 0 0\n"
      "Shape \"sphere\" \"float radius\" 0.25\n");
  double expected = 0;
  for (int k = 0; k < 1000; ++k) {
    const double time = (k + 0.5) / 1000;
    const glm::dvec3 at = glm::dvec3(-3, 0.5, 1.5) + time * glm::dvec3(5, 0, 1);
    const double distance = glm::length(at);
    expected += 0.5 * 10 * std::pow(0.25 / distance, 2) * at.z / distance / 1000;
  }
  const Mean mean = mean_of(render_model(scene, 1024).image, "G");
  EXPECT_NEAR(mean.value, expected, 4 * mean.error + 2e-3 * expected);
  EXPECT_LT(mean.error, 0.01 * expected);
}

/// The picture of a scene and the mean of pictures of it frozen at the middles of `times` parts of
/// its exposure agree in their means and, with z of both pictures' stated errors, pixel by pixel.
void expect_mean_of_frozen(const std::string& text, int samples, int times = 32) {
  const Scene scene = scene_of_text(text);
  const Picture ours = picture_of(render_model(scene, samples).image);
  Picture theirs;
  for (int k = 0; k < times; ++k) {
    const FilmSettings& film = scene.view.film;
    Scene frozen = frozen_at(scene, film.shutter_open + (k + 0.5) / times * film.exposure_time);
    frozen.view.sampler.seed = 100 + static_cast<std::uint32_t>(k);
    const Picture one = picture_of(render_model(frozen, std::max(samples / times, 2)).image);
    if (theirs.rgb.empty()) {
      theirs = one;
      theirs.rgb.assign(one.rgb.size(), 0);
      theirs.variance.assign(one.rgb.size(), 0);
    }
    for (std::size_t i = 0; i < one.rgb.size(); ++i) {
      theirs.rgb[i] += one.rgb[i] / static_cast<float>(times);
      theirs.variance[i] += one.variance[i] / static_cast<float>(times * times);
    }
  }
  const Figures figures = compare(ours, theirs);
  double sum = 0, variance = 0;
  for (std::size_t i = 0; i < ours.rgb.size(); ++i) {
    sum += theirs.rgb[i];
    variance += ours.variance[i] + theirs.variance[i];
  }
  const double error = std::sqrt(3 * variance) / sum;
  std::printf("mean %+.4f (error %.4f), z %.3f +- %.3f, beyond 3 %.4f\n", figures.mean, error,
              figures.z_mean, figures.z_sd, figures.beyond_3);
  EXPECT_LT(std::abs(figures.mean), 4 * error + 0.002);
  EXPECT_LT(error, 0.02);
  EXPECT_LT(std::abs(figures.z_mean), 0.25);
  EXPECT_LT(figures.z_sd, 1.3);
  EXPECT_LT(figures.beyond_3, 0.025);
}

const std::string in_front =
    "Scale -1 1 1\nLookAt 0 -6 3  0 0 0.3  0 0 1\nCamera \"perspective\" \"float fov\" 40\n"
    "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\n"
    "Integrator \"path\" \"integer maxdepth\" 5\nPixelFilter \"box\"\n";
const std::string ground =
    "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\nShape \"disk\" \"float radius\" 8\n";

// Lamps of every kind of sampling: triangles by solid angle, disks, capsules and cylinders by area,
// others by a ball.
TEST(MotionPictures, OfLampsOfAllKindsAreTheMeanOfFrozenOnes) {
  expect_mean_of_frozen(
      in_front + "WorldBegin\n" + ground +
          "AreaLightSource \"diffuse\" \"rgb L\" [8 8 8]\nTranslate 0 0 1.5\n"
          "ActiveTransform EndTime\nTranslate 1 0 0.3\nRotate 70 0 1 0\nActiveTransform All\n"
          "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [-2 0 0 -1 0 0 -1.5 1 "
          "0]\n"
          "Shape \"capsule\" \"point3 p0\" [0 0 0] \"point3 p1\" [1 0 0] \"float radius\" 0.2\n"
          "Shape \"cylinder\" \"float radius\" 0.2 \"float zmin\" -0.3 \"float zmax\" 0.3\n"
          "Shape \"box\" \"point3 p0\" [-0.2 0.8 -0.2] \"point3 p1\" [0.2 1.2 0.2]\n"
          "AttributeBegin\nTranslate -1 1 0\nScale 0.3 0.15 0.4\nShape \"sphere\"\nAttributeEnd\n"
          "AttributeBegin\nTranslate 1 1.5 0\nShape \"disk\" \"float radius\" 0.3\nAttributeEnd\n",
      512);
}

// Trees are for parts of the shutter's time, beside what rests and together with it. Rods that go
// far, in rows of leaves of their own, cast shadows of lamps that move and of one that rests.
TEST(MotionPictures, OfWhatMovesFarAreTheMeanOfFrozenOnes) {
  // Kernels for all rows know alpha, and so another stage traces their shadow rays.
  const ScopedVariable rows("CAPLET_ROWS", "scene");
  const auto moving = [](int count, double reach, double height, double radius) {
    std::string p0, p1, radii;
    for (const double side : {-1, 1})
      for (int i = 0; i < count; ++i) {
        const double at = 6.0 * (i + 0.5) / count - 3, x = (i % 2 == 0 ? side : -side) * reach;
        p0 += fmt::format("{} {} {} ", x, at, height);
        p1 += fmt::format("{} {} {} ", x + 0.3, at + 0.1 * side, height + 0.1);
        radii += fmt::format("{} ", radius);
      }
    return fmt::format(
        "Shape \"capsules\" \"float times\" [0 1] \"point3 p0\" [{}] \"point3 p1\" [{}] "
        "\"float radius\" [{}]\n",
        p0, p1, radii);
  };
  std::string text = in_front + "WorldBegin\n" + ground + moving(40, 3, 0.3, 0.1) +
                     "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [9 9 9]\n" +
                     moving(4, 1, 1.2, 0.1) +
                     "Translate 0.3 1 1.2\nShape \"sphere\" \"float radius\" 0.2\nAttributeEnd\n";
  EXPECT_GE(lower(scene_of_text(text)).world.intervals, 8u);
  expect_mean_of_frozen(text, 1024, 128);
  for (int i = 0; i < 60; ++i)
    text += "Translate 0.05 -0.01 0.005\nShape \"sphere\" \"float radius\" 0.1\n";
  EXPECT_GE(lower(scene_of_text(text)).world.intervals, 8u);
  expect_mean_of_frozen(text, 1024, 128);
  expect_mean_of_frozen(
      in_front + "WorldBegin\n" + ground + moving(40, 3, 0.3, 0.15) +
          "LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0]\n",
      512, 128);
}

// A light tree has boxes and cones of lights.
TEST(MotionPictures, OfManyLampsAreTheMeanOfFrozenOnes) {
  std::string text = in_front + "WorldBegin\n" + ground;
  for (int i = 0; i < 24; ++i)
    text +=
        "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [6 6 6]\nRotate " +
        std::to_string(15 * i) +
        " 0 0 1\nTranslate 2.5 0 0.5\nActiveTransform EndTime\nTranslate -1.5 0 0.5\n"
        "Rotate 100 1 0 0\nActiveTransform All\nShape \"trianglemesh\" \"integer indices\" [0 1 "
        "2] \"point3 P\" [0 0 0 0.3 0 0 0 0.3 0]\nAttributeEnd\n";
  expect_mean_of_frozen(text, 1024, 64);
}

TEST(MotionPictures, OfGlassFogAndHolesAreTheMeanOfFrozenOnes) {
  expect_mean_of_frozen(
      in_front +
          "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [2 2 2] \"rgb "
          "sigma_a\" [0.2 0.2 0.2]\nWorldBegin\n"
          "LightSource \"infinite\" \"rgb L\" [0.6 0.6 0.6]\n"
          "LightSource \"point\" \"rgb I\" [20 20 20] \"point3 from\" [2 -3 4]\n" +
          ground +
          "AttributeBegin\nTranslate -1.2 0 0.7\nActiveTransform EndTime\nTranslate 0.8 0 0.2\n"
          "Rotate 90 0 0 1\nActiveTransform All\nMaterial \"interface\"\n"
          "MediumInterface \"fog\" \"\"\n"
          "Shape \"box\" \"point3 p0\" [-0.5 -0.5 -0.5] \"point3 p1\" [0.5 0.5 0.5]\nAttributeEnd\n"
          "AttributeBegin\nTranslate 1.2 0 0.6\nActiveTransform EndTime\nTranslate 0 0 0.7\n"
          "Rotate 60 0 1 0\nActiveTransform All\nMaterial \"dielectric\"\n"
          "Shape \"capsule\" \"point3 p0\" [-0.4 0 0] \"point3 p1\" [0.4 0 0] \"float radius\" "
          "0.3\n"
          "AttributeEnd\n"
          "AttributeBegin\nTranslate 0.3 1 0.2\nActiveTransform StartTime\nTranslate -0.8 0 0\n"
          "ActiveTransform All\nMaterial \"diffuse\" \"rgb reflectance\" [0.7 0.2 0.2]\n"
          "Shape \"sphere\" \"float radius\" 0.8 \"float alpha\" 0.5\nAttributeEnd\n",
      512);
}

// A lamp, a glass rod, one of fog, and one with holes whose ends move; the last one also turns.
TEST(MotionPictures, OfCapsulesWhoseEndsMoveAreTheMeanOfFrozenOnes) {
  const auto moving = [](const std::string& p0, const std::string& p1, const std::string& radii) {
    return "Shape \"capsules\" \"float times\" [0 1] \"point3 p0\" [" + p0 + "] \"point3 p1\" [" +
           p1 + "] \"float radius\" [" + radii + "]";
  };
  expect_mean_of_frozen(
      in_front +
          "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [2 2 2] \"rgb "
          "sigma_a\" [0.2 0.2 0.2]\nWorldBegin\n"
          "LightSource \"infinite\" \"rgb L\" [0.4 0.4 0.4]\n" +
          ground + "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [8 8 8]\n" +
          moving("0 1 1.5  1 1 1", "0 1 1.5  2 0 1.5", "0.1 0.3") +
          "\nAttributeEnd\nAttributeBegin\nMaterial \"dielectric\"\n" +
          moving("1 -1 0.4  1 -1 0.6", "1.5 -1 0.4  0.5 -1 1.5", "0.3 0.3") +
          "\nAttributeEnd\nAttributeBegin\nMaterial \"interface\"\nMediumInterface \"fog\" \"\"\n" +
          moving("-1.5 0 0.7  -1 0 0.7", "-1 0 0.7  -1 0 1.5", "0.5 0.4") +
          "\nAttributeEnd\nActiveTransform EndTime\nRotate 60 0 0 1\nActiveTransform All\n"
          "Material \"diffuse\" \"rgb reflectance\" [0.7 0.2 0.2]\n" +
          moving("-0.5 -1.5 0.3  0 -1.5 0.3", "0 -1.5 0.3  0 -1.5 0.9", "0.3 0.2") +
          " \"float alpha\" 0.5\n",
      thorough() ? 8192 : 512, thorough() ? 4096 : 32);
}

// A lamp that bends, a smooth tent of glazed paint with a bump, a sheet with holes that turns, and
// a closed glass block that grows.
TEST(MotionPictures, OfMeshesWhoseVerticesMoveAreTheMeanOfFrozenOnes) {
  expect_mean_of_frozen(
      in_front + "WorldBegin\nLightSource \"infinite\" \"rgb L\" [0.4 0.4 0.4]\n" + ground +
          "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [8 8 8]\n"
          "Shape \"trianglemesh\" \"float times\" [0 1] \"integer indices\" [0 1 2 1 3 2]\n"
          "  \"point3 P\" [0 1 1.5  0 2 1.5  1 1 1.5  1 2 1.5   0 1 1  0 2 1.5  1 1 2  2 2 1]\n"
          "AttributeEnd\nAttributeBegin\n"
          "Material \"coateddiffuse\" \"rgb reflectance\" [0.2 0.6 0.2] \"float roughness\" 0.3\n"
          "Shape \"trianglemesh\" \"float times\" [0 1] \"integer indices\" [0 1 2 0 2 3]\n"
          "  \"point3 P\" [-1 -1 1  -1.8 -1 0.2  -1 -1.8 0.2  -0.2 -1 0.2\n"
          "               -1 -1 0.4  -1.8 -1 0.2  -1 -1.8 0.8  -0.2 -1 0.2]\n"
          "  \"normal N\" [0 0 1  -0.7 0 0.7  0 -0.7 0.7  0.7 0 0.7\n"
          "               0 -1 1  -0.7 0 0.7  0 -0.2 0.7  0.7 0 2]\n"
          "  \"point2 uv\" [0 0 1 0 1 1 0 1]\n"
          "AttributeEnd\nAttributeBegin\nMaterial \"dielectric\"\n"
          "Shape \"trianglemesh\" \"float times\" [0 1]\n"
          "  \"integer indices\" [0 2 1 0 1 3 1 2 3 2 0 3]\n"
          "  \"point3 P\" [0.5 -1 0.1  1.5 -1 0.1  1 0 0.1  1 -0.7 0.9\n"
          "               0.5 -1 0.1  1.5 -1 0.1  1 0 0.1  1 -0.7 1.5]\n"
          "AttributeEnd\nActiveTransform EndTime\nRotate 60 0 0 1\nActiveTransform All\n"
          "Material \"diffuse\" \"rgb reflectance\" [0.7 0.2 0.2]\n"
          "Shape \"trianglemesh\" \"float times\" [0 1] \"integer indices\" [0 1 2 1 3 2]\n"
          "  \"point3 P\" [-1.5 0.5 0.2  -0.5 0.5 0.2  -1.5 0.5 1  -0.5 0.5 1\n"
          "               -1.5 0 0.2  -0.5 1 0.2  -1.5 0 1.4  -0.5 1 1.4] \"float alpha\" 0.5\n",
      512);
}

// A lamp of balls that part, a glass of two, and a block of fog through which a drill goes.
TEST(MotionPictures, OfCsgWhoseOperandsMoveAreTheMeanOfFrozenOnes) {
  const auto object = [](const std::string& name, const std::string& material,
                         const std::string& shape, const std::string& motion) {
    return "ObjectBegin \"" + name + "\"\nMaterial \"" + material +
           "\"\nActiveTransform EndTime\n" + motion + "\nActiveTransform All\nShape " + shape +
           "\nObjectEnd\n";
  };
  const auto csg = [](const std::string& operation, const std::string& operands) {
    return "Shape \"csg\" \"string operation\" \"" + operation + "\" \"string operands\" [" +
           operands + "]\n";
  };
  const std::string ball = "\"sphere\" \"float radius\" 0.4", part = "Translate 0.5 0 0.2";
  expect_mean_of_frozen(
      in_front +
          "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [2 2 2] \"rgb "
          "sigma_a\" [0.2 0.2 0.2]\nWorldBegin\nLightSource \"infinite\" \"rgb L\" [0.4 0.4 "
          "0.4]\n" +
          ground + object("still", "diffuse", ball, "") + object("apart", "diffuse", ball, part) +
          object("glass", "dielectric", ball, "") + object("more", "dielectric", ball, part) +
          object("block", "interface",
                 "\"box\" \"point3 p0\" [-0.5 -0.5 -0.5] \"point3 p1\" [0.5 0.5 0.5]",
                 "Rotate 60 0 0 1") +
          object("drill", "interface",
                 "\"capsule\" \"point3 p0\" [0 0 -1] \"point3 p1\" [0 0 1] \"float radius\" 0.3",
                 "Translate 0.6 0 0\nRotate 40 1 0 0") +
          "AttributeBegin\nTranslate 0 1 1.5\nAreaLightSource \"diffuse\" \"rgb L\" [8 8 8]\n" +
          csg("intersection", "\"still\" \"apart\"") +
          "AttributeEnd\nAttributeBegin\nTranslate 1 -1 0.5\n" +
          csg("union", "\"glass\" \"more\"") + "AttributeEnd\nTranslate -1 0 0.6\n" +
          "MediumInterface \"fog\" \"\"\n" + csg("difference", "\"block\" \"drill\""),
      512);
}

TEST(MotionPictures, OfACameraThatTurnsAreTheMeanOfFrozenOnes) {
  std::string text = in_front;
  text.insert(0,
              "ActiveTransform EndTime\nRotate 20 0 1 0\nTranslate 0.3 0.4 1\nActiveTransform "
              "All\n");
  expect_mean_of_frozen(
      text + "WorldBegin\nLightSource \"infinite\" \"rgb L\" [0.6 0.6 0.6]\n" + ground +
          "AttributeBegin\nTranslate 0 0 0.5\nActiveTransform EndTime\nTranslate 1 0 0\n"
          "ActiveTransform All\nMaterial \"diffuse\" \"rgb reflectance\" [0.1 0.1 0.8]\n"
          "Shape \"sphere\" \"float radius\" 0.5\nAttributeEnd\n",
      512);
}

// A camera in a fog that moves away is within it for a time.
TEST(MotionPictures, OfACameraThatFogLeavesAreTheMeanOfFrozenOnes) {
  expect_mean_of_frozen(
      in_front +
          "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0.5 0.5 0.5] "
          "\"rgb sigma_a\" [0.5 0.5 0.5]\nWorldBegin\n"
          "LightSource \"infinite\" \"rgb L\" [1 1 1]\n" +
          ground +
          "AttributeBegin\nTranslate 0 -6 3\nActiveTransform EndTime\nTranslate 0 0 4\n"
          "ActiveTransform All\nMaterial \"interface\"\nMediumInterface \"fog\" \"\"\n"
          "Shape \"sphere\" \"float radius\" 1.5\nAttributeEnd\n",
      512);
}

// What moves is seen at one time by all of a path: a mirror shows the ball where it is.
TEST(MotionPictures, ArePicturesOfTheSamplesAlone) {
  const Scene scene = scene_of_text(
      in_front + "WorldBegin\nLightSource \"infinite\" \"rgb L\" [1 1 1]\n" + ground +
      "ActiveTransform EndTime\nTranslate 1 0 0\nRotate 90 0 0 1\nActiveTransform All\n"
      "Translate 0 0 0.5\nShape \"box\" \"point3 p0\" [-0.5 -0.5 -0.5] \"point3 p1\" [0.5 0.5 "
      "0.5]\n");
  RenderOptions small, large;
  small.batch_paths = 333;
  large.batch_paths = 100'000;
  const Picture a = picture_of(render_model(scene, 8, small).image),
                b = picture_of(render_model(scene, 8, large).image);
  EXPECT_EQ(a.rgb, b.rgb);
}

}  // namespace
}  // namespace caplet::test
