// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Cameras with lenses of several surfaces, against the formulas of thick lenses and of radiometry.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "camera_rays.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace caplet::test::realistic_camera_test {
namespace {

using sampling_test::camera_ray;
using sampling_test::camera_rays;
using sampling_test::WeighedRay;

constexpr double mm = 0.001;

/// A meniscus, the stop, a thicker meniscus.
std::shared_ptr<const Lens> two_elements() {
  return std::make_shared<const Lens>(Lens{
      "",
      {{30, 4, 1.62, 24}, {60, 6, 1, 22}, {0, 6, 0, 10}, {-70, 4, 1.62, 20}, {-32, 40, 1, 22}}});
}

Scene scene_with(const RealisticProjection& camera, double diagonal = 24) {
  Scene scene;
  scene.view.film.width = 200;
  scene.view.film.height = 150;
  scene.view.film.diagonal = diagonal;
  scene.view.camera.projection = camera;
  return scene;
}

glm::dvec3 origin_of(const RayRecord& ray) { return {ray.ox, ray.oy, ray.oz}; }
glm::dvec3 direction_of(const RayRecord& ray) { return {ray.dx, ray.dy, ray.dz}; }

/// Lens samples in 16 x 16 cells' middles, of a point of the raster.
std::vector<glm::vec4> lens_samples(const glm::vec2& raster, int cells = 16) {
  std::vector<glm::vec4> out;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      out.emplace_back(raster, (static_cast<float>(i) + 0.5f) / static_cast<float>(cells),
                       (static_cast<float>(j) + 0.5f) / static_cast<float>(cells));
  return out;
}

/// The lens of cameras without a file, by the formulas of a thick lens (Hecht, "Optics", 6.1).
struct ThickLens {
  double n = 1.5168, r = 51.68 * mm, d = 4 * mm;
  double f = 1 / ((n - 1) * (2 / r - (n - 1) * d / (n * r * r)));
  double inward = f * (n - 1) * d / (n * r);  // from each vertex to its principal plane
  /// The distance from a principal plane to the film, where film and object are `focus` apart.
  double image_distance(double focus) const {
    const double apart = focus - (d - 2 * inward);
    return (apart - std::sqrt(apart * apart - 4 * f * apart)) / 2;
  }
};

TEST(RealisticCamera, FocusesAsAThickLensDoes) {
  const ThickLens thick;
  for (const double focus : {0.25, 1.0, 20.0}) {
    RealisticProjection camera;
    camera.aperture_diameter = 1;
    camera.focus_distance = focus;
    std::string problem;
    const auto lens = camera.focused(problem);
    ASSERT_TRUE(lens) << problem;
    const double image = thick.image_distance(focus);
    EXPECT_NEAR(lens->image_distance(), image, 1e-12);
    // The film lies behind the rear principal plane, which is inside the lens.
    EXPECT_NEAR(lens->rear_z(), image - thick.inward, 1e-12);
    EXPECT_NEAR(lens->principal_z(), image + thick.d - 2 * thick.inward, 1e-12);

    // Rays of the film's middle meet at the distance of focus. A stop of 1 mm is f / 50: what
    // aberration leaves is the angle's cube.
    const Scene scene = scene_with(camera);
    for (const WeighedRay& each : camera_rays(scene, lens_samples({100, 75}))) {
      const glm::dvec3 o = origin_of(each.ray), d = direction_of(each.ray);
      const glm::dvec3 there = o + d * ((focus - o.z) / d.z);
      EXPECT_LT(std::hypot(there.x, there.y), 2e-5 * focus);
    }
    // A place near the middle is seen where the magnification says, with the picture's right on the
    // right: x / object distance = place / image distance.
    const double across = 24 * mm / std::hypot(200, 150);
    const CameraRay seen = unproject(scene.view.camera, scene.view.film, {101, 74});
    const double t = (focus - seen.origin.z) / seen.direction.z;
    const double object = focus - image - (thick.d - 2 * thick.inward);
    EXPECT_NEAR(seen.origin.x + t * seen.direction.x, across * object / image,
                1e-3 * across * object / image);
    EXPECT_NEAR(seen.origin.y + t * seen.direction.y, across * object / image,
                1e-3 * across * object / image);
  }
}

// The light that a point of the film gathers from a white world is that of the stop, seen from the
// object, over the square of the magnification: pi (a / distance)^2 (distance / image)^2 near the
// axis.
TEST(RealisticCamera, GathersTheLightOfItsStop) {
  const ThickLens thick;
  for (const double diameter : {0.02, 2.0, 4.0}) {
    RealisticProjection camera;
    camera.aperture_diameter = diameter;
    camera.focus_distance = 3;
    const double image = thick.image_distance(3), object = 3 - image - thick.d + 2 * thick.inward;
    // From the object to the stop, which stands 1 mm before the first vertex.
    const double to_stop = object - thick.inward - 1 * mm;
    const double radius = diameter / 2 * mm, sine = radius / std::hypot(radius, to_stop);
    const double wanted = std::numbers::pi * sine * sine * (object / image) * (object / image);
    double sum = 0;
    const auto samples = lens_samples({100, 75}, 128);
    int stopped = 0;
    for (const WeighedRay& each : camera_rays(scene_with(camera), samples)) {
      sum += double{each.weight};
      stopped += each.weight == 0 ? 1 : 0;
      EXPECT_GT(each.ray.t_max, 0);
    }
    // The stop's edge crosses cells: 128 cells across give 0.2 %.
    EXPECT_NEAR(sum / static_cast<double>(samples.size()), wanted, 4e-3 * wanted) << diameter;
    // The rectangle around a disk, and a little more: most of a small one is how far the pupil
    // moves between two of the 65 places of the film for which it is known.
    const double share = stopped / static_cast<double>(samples.size());
    EXPECT_GT(share, 1 - std::numbers::pi / 4);
    EXPECT_LT(share, diameter < 1 ? 0.6 : 0.3);
  }
}

// The device's rays are the host's, in floats.
TEST(RealisticCamera, RaysOfDevicesAreTheHosts) {
  RealisticProjection camera;
  camera.lens = two_elements();
  camera.aperture_diameter = 9;
  camera.focus_distance = 7;
  const Scene scene = scene_with(camera);
  std::string problem;
  const auto lens = camera.focused(problem);
  ASSERT_TRUE(lens) << problem;
  const std::array<double, 4> plane = image_plane_of(scene.view.camera, scene.view.film);
  const double most = 12 * mm;
  const auto pupils = lens->pupils(most, 64);
  int passed = 0, stopped = 0;
  for (const glm::vec2 raster : {glm::vec2(120, 75), {20, 30}, {199, 3}, {140, 149}}) {
    const glm::dvec2 film = -glm::dvec2(plane[0] + raster.x / 200 * (plane[1] - plane[0]),
                                        plane[3] + raster.y / 150 * (plane[2] - plane[3]));
    const double r = glm::length(film);
    const glm::dvec2 across = r > 0 ? film / r : glm::dvec2(1, 0);
    const auto& pupil = pupils[std::min<std::size_t>(63, static_cast<std::size_t>(64 * r / most))];
    const auto samples = lens_samples(raster);
    const auto rays = camera_rays(scene, samples);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const glm::dvec2 on(pupil.x0 + double{samples[i].z} * (pupil.x1 - pupil.x0),
                          pupil.y0 + double{samples[i].w} * (pupil.y1 - pupil.y0));
      const glm::dvec3 from(film, 0),
          to(across * on.x + glm::dvec2(-across.y, across.x) * on.y, lens->rear_z());
      const glm::dvec3 inside = glm::normalize(to - from);
      const auto out = lens->trace({from, inside});
      if (!out) {
        ++stopped;
        EXPECT_EQ(rays[i].weight, 0);
        continue;
      }
      if (rays[i].weight == 0) {
        // A rounding away from an edge.
        const auto wider = lens->trace({from, glm::normalize(to + glm::dvec3(2e-8) - from)});
        const auto closer = lens->trace({from, glm::normalize(to - glm::dvec3(2e-8) - from)});
        EXPECT_FALSE(wider && closer);
        continue;
      }
      ++passed;
      EXPECT_LT(glm::length(direction_of(rays[i].ray) - out->direction), 3e-6);
      EXPECT_LT(glm::length(origin_of(rays[i].ray) - out->origin), 1e-7);
      const double weight = std::pow(inside.z, 4) * (pupil.x1 - pupil.x0) * (pupil.y1 - pupil.y0) /
                            (lens->rear_z() * lens->rear_z());
      EXPECT_NEAR(double{rays[i].weight}, weight, 1e-5 * weight);
    }
  }
  EXPECT_GT(passed, 500);
  EXPECT_GT(stopped, 100);
}

// Whatever passes the lens from a point of the film lies in its exit pupil, and not much else.
TEST(RealisticCamera, PupilsHoldWhatPasses) {
  RealisticProjection camera;
  camera.lens = two_elements();
  camera.focus_distance = 7;
  for (const double aperture : {0.05, 4.0, 10.0}) {
    camera.aperture_diameter = aperture;
    std::string problem;
    const auto lens = camera.focused(problem);
    ASSERT_TRUE(lens) << problem;
    const double most = 12 * mm;
    const auto pupils = lens->pupils(most, 64);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    int passes = 0, tries = 0;
    for (int i = 0; i < 20000; ++i) {
      const double r = most * unit(random);
      const auto& pupil =
          pupils[std::min<std::size_t>(63, static_cast<std::size_t>(64 * r / most))];
      // Around the rectangle, at twice its size.
      const double x = pupil.x0 + (2 * unit(random) - 0.5) * (pupil.x1 - pupil.x0),
                   y = pupil.y0 + (2 * unit(random) - 0.5) * (pupil.y1 - pupil.y0);
      const glm::dvec3 from(r, 0, 0);
      const bool is_inside = x >= pupil.x0 && x <= pupil.x1 && y >= pupil.y0 && y <= pupil.y1;
      tries += is_inside ? 1 : 0;
      if (!lens->trace({from, glm::normalize(glm::dvec3(x, y, lens->rear_z()) - from)})) continue;
      ++passes;
      EXPECT_TRUE(is_inside) << "film " << r << ", pupil " << x << ", " << y;
    }
    EXPECT_GT(passes, (aperture < 1 ? 0.4 : 0.5) * tries) << aperture;
  }
}

TEST(RealisticCamera, ProjectIsTheInverseOfUnproject) {
  RealisticProjection camera;
  camera.lens = two_elements();
  camera.aperture_diameter = 9;
  camera.focus_distance = 7;
  const Scene scene = scene_with(camera);
  for (const glm::dvec2 raster : {glm::dvec2(100, 75), {20.5, 30.25}, {190, 3}, {140, 148}})
    for (const double distance : {0.3, 7.0, 400.0}) {
      const CameraRay ray = unproject(scene.view.camera, scene.view.film, raster);
      const auto back =
          project(scene.view.camera, scene.view.film, ray.origin + distance * ray.direction);
      ASSERT_TRUE(back);
      EXPECT_LT(glm::length(*back - raster), 1e-6);
    }
  EXPECT_FALSE(project(scene.view.camera, scene.view.film, {0, 0, -1}));
  EXPECT_FALSE(project(scene.view.camera, scene.view.film, {0, 0, 0.01})) << "inside the lens";
}

// By rays a pixel apart near the axis.
TEST(RealisticCamera, FootprintsAndSpreadsAreDistancesOfRays) {
  RealisticProjection camera;
  camera.lens = two_elements();
  camera.focus_distance = 7;
  const Scene scene = scene_with(camera);
  const auto at = [&](double x) {
    const CameraRay ray = unproject(scene.view.camera, scene.view.film, {x, 75});
    return ray.origin + ray.direction * ((7 - ray.origin.z) / ray.direction.z);
  };
  const double apart = at(100.5).x - at(99.5).x;
  EXPECT_NEAR(pixel_footprint(scene.view.camera, scene.view.film, {0, 0, 7}), apart, 0.01 * apart);
  EXPECT_NEAR(double{sampling_test::camera_spread(scene, {100, 75})[1]} * 7, apart, 0.02 * apart);
}

// The plain lens has its stop in front, where its rays begin.
TEST(RealisticCamera, MasksFormTheStop) {
  RealisticProjection round;
  round.aperture_diameter = 4;
  RealisticProjection square = round;
  square.aperture = aperture_mask("square");
  ASSERT_TRUE(square.aperture);
  const auto samples = lens_samples({100, 75}, 64);
  const auto all = camera_rays(scene_with(round), samples),
             some = camera_rays(scene_with(square), samples);
  double sum_round = 0, sum_square = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    sum_round += double{all[i].weight};
    sum_square += double{some[i].weight};
    if (all[i].weight == 0) continue;
    const glm::dvec2 at(all[i].ray.ox / (2 * mm), all[i].ray.oy / (2 * mm));
    const double far = std::max(std::abs(at.x), std::abs(at.y));
    // The mask lies between the middles of its 256 texels.
    if (far < 0.49) {
      EXPECT_NEAR(some[i].weight / all[i].weight, std::numbers::pi, 1e-4);
    } else if (far > 0.51) {
      EXPECT_EQ(some[i].weight, 0);
    }
  }
  EXPECT_NEAR(sum_square, sum_round, 0.01 * sum_round);
  for (const char* name : aperture_names) {
    const auto mask = aperture_mask(name);
    ASSERT_TRUE(mask) << name;
    double sum = 0, rising = 0, sideways = 0;
    for (int row = 0; row < mask->height; ++row)
      for (int column = 0; column < mask->width; ++column) {
        const double value =
            double{mask->values[static_cast<std::size_t>(row * mask->width + column)]};
        sum += value;
        rising += value * (127.5 - row);
        sideways += value * (column - 127.5);
      }
    EXPECT_NEAR(sum / (256 * 256), std::numbers::pi / 4, 1e-6) << name;
    // All are even from left to right but the star, and from top to bottom but the pentagon: its
    // corner points up, so its lower half, which ends at a side, is the heavier one.
    if (std::string(name) != "star") {
      EXPECT_NEAR(sideways, 0, 1) << name;
    }
    if (std::string(name) != "pentagon") {
      EXPECT_NEAR(rising, 0, 1) << name;
    }
  }
  EXPECT_FALSE(aperture_mask("hexagon"));
  // What passes is pi over the area, which is that of 5 triangles around a pentagon's middle, or of
  // 10 around a star's, whose inner corners lie at cos(72) / cos(36).
  const auto most = [](const char* name) {
    return double{std::ranges::max(aperture_mask(name)->values)};
  };
  const double degree = std::numbers::pi / 180;
  const double pentagon = 2.5 * 0.8 * 0.8 * std::sin(72 * degree),
               star = 5 * std::cos(72 * degree) / std::cos(36 * degree) * std::sin(36 * degree);
  EXPECT_NEAR(most("pentagon"), std::numbers::pi / pentagon, 0.01);
  EXPECT_NEAR(most("star"), std::numbers::pi / star, 0.03);
  ApertureMask dark{"", 2, 1, {0, -1}}, endless{"", 2, 1, {1, HUGE_VALF}}, half{"", 2, 1, {-1, 3}};
  EXPECT_FALSE(normalize(dark));
  EXPECT_FALSE(normalize(endless));
  EXPECT_TRUE(normalize(half));
  EXPECT_EQ(half.values[0], 0);
  EXPECT_NEAR(half.values[1], std::numbers::pi / 2, 1e-6);
  // A bell less its value at the rim.
  const auto bell = aperture_mask("gaussian");
  EXPECT_NEAR(double{bell->values[128 * 256 + 128]} / double{bell->values[128 * 256 + 192]},
              (1 - std::exp(-1)) / (std::exp(-0.25) - std::exp(-1)), 0.02);
  EXPECT_EQ(bell->values[0], 0);
}

TEST(RealisticCamera, SaysWhyItCannotBe) {
  const auto problem_of = [](std::vector<LensElement> elements, double focus) {
    RealisticProjection camera;
    camera.lens = std::make_shared<const Lens>(Lens{"", std::move(elements)});
    camera.focus_distance = focus;
    return camera.problem();
  };
  EXPECT_EQ(problem_of({{30, 4, 1.5, 20}, {-30, 40, 1, 20}}, 5), "");
  EXPECT_EQ(problem_of({{30, 4, 1.5, 20}, {-30, 40, 1, 20}}, 0.1), "the lens cannot focus so near");
  EXPECT_EQ(problem_of({{-30, 4, 1.5, 20}, {30, 40, 1, 20}}, 5), "the lens does not gather light");
  EXPECT_EQ(problem_of({{0, 40, 1, 20}}, 5), "the lens does not gather light");
  // A ball of glass whose index is above 2 has its focus inside.
  EXPECT_EQ(problem_of({{30, 60, 3, 20}, {-30, 40, 1, 20}}, 5),
            "the film would lie inside the lens");
}

}  // namespace
}  // namespace caplet::test::realistic_camera_test
