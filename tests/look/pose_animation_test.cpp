// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Animations between poses that have times.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/error.h"
#include "import/import.h"
#include "import/poses.h"
#include "present/pose_animation.h"
#include "present/smooth_curve.h"
#include "support/import_files.h"

namespace caplet::pose_animation_test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;
using testing::Pointwise;

constexpr double pi = std::numbers::pi;

void expect_point(const SmoothCurve::Point& is, const SmoothCurve::Point& should) {
  EXPECT_THAT(is, Pointwise(DoubleNear(1e-12), should));
}

// The parabola x = t^2 has the velocities 2 t at its keys, also where these are not evenly far
// apart, and the cubic through values and velocities of a parabola is the parabola.
TEST(SmoothCurve, KeepsAParabolaBetweenInnerKeys) {
  SmoothCurve curve(SmoothCurve::Space::line);
  for (const double t : {0.0, 1.0, 3.0, 4.5, 5.0}) curve.add(t, {t * t, 7 - t});
  for (double t = 1; t <= 4.5; t += 0.125) expect_point(curve.at(t), {t * t, 7 - t});
}

TEST(SmoothCurve, GoesThroughItsKeysAndRestsBeyond) {
  SmoothCurve curve(SmoothCurve::Space::line);
  curve.add(-1, {3});
  curve.add(1, {5});
  expect_point(curve.at(-2), {3});
  expect_point(curve.at(-1), {3});
  expect_point(curve.at(-0.5), {3.5});  // two keys make a straight line
  expect_point(curve.at(1), {5});
  expect_point(curve.at(9), {5});
}

// Hermite's polynomials 3 u^2 - 2 u^3 and, for the velocity at the end, u^3 - u^2.
TEST(SmoothCurve, RestsBetweenEqualKeys) {
  SmoothCurve curve(SmoothCurve::Space::line);
  for (const auto& [t, x] : {std::pair{0.0, 2.0}, {1.0, 2.0}, {2.0, 6.0}}) curve.add(t, {x});
  for (const double t : {0.1, 0.5, 0.9}) expect_point(curve.at(t), {2});
  const double u = 0.25;
  expect_point(curve.at(1 + u), {2 + 4 * (3 * u * u - 2 * u * u * u) + 4 * (u * u * u - u * u)});
}

// Even steps on a great circle are an even turn, with keys close together or far apart.
TEST(SmoothCurve, TurnsEvenlyOnTheSphere) {
  for (const double step : {1e-5, 0.3, 1.5, 3.0}) {
    SmoothCurve curve(SmoothCurve::Space::sphere);
    for (int k = 0; k < 4; ++k) curve.add(2.0 * k, {std::cos(k * step), 0, std::sin(k * step)});
    for (double t = 0; t <= 6; t += 0.25)
      expect_point(curve.at(t), {std::cos(t / 2 * step), 0, std::sin(t / 2 * step)});
  }
}

TEST(SmoothCurve, StaysOnTheSphere) {
  SmoothCurve curve(SmoothCurve::Space::sphere);
  curve.add(0, {1, 0, 0});
  curve.add(1, {0, 1, 0});
  curve.add(3, {0, 0.6, -0.8});
  for (double t = 0; t <= 3; t += 0.0625) {
    const SmoothCurve::Point at = curve.at(t);
    EXPECT_NEAR(std::hypot(at[0], at[1], at[2]), 1, 1e-12) << t;
  }
}

Scene scene_with(const std::string& more) {
  return import_scene(
      test::write_file("scene.pbrt",
                       "LookAt 0 0 10 0 0 0 0 1 0\n"
                       "Camera \"perspective\" \"float fov\" 40 \"float shutteropen\" 3 "
                       "\"float shutterclose\" 5\n"
                       "WorldBegin\nLightSource \"infinite\"\n" +
                           more),
      test::NoImages());
}

constexpr const char* parts =
    "ObjectBegin \"o\"\nTranslate 1 0 0\nShape \"sphere\"\nObjectEnd\nObjectInstance \"o\"\n"
    "Shape \"capsule\" \"point3 p0\" [0 0 0] \"point3 p1\" [1 0 0] \"float radius\" 0.5\n"
    "Shape \"sphere\" \"string name\" \"ball\"\n";

PoseAnimation animation_of(const Scene& scene, const std::string& lines) {
  return {scene, read_poses(test::write_file("poses.jsonl", lines), scene)};
}

/// Returns the scene at a time.
Scene scene_at(const Scene& scene, const PoseAnimation& animation, double time,
               double exposure = 0) {
  Scene out = scene;
  for (const SceneEdit& edit : animation.at(time, exposure, scene.view.film)) apply_edit(out, edit);
  return out;
}

void expect_matrix(const glm::dmat4& is, const glm::dmat4& should) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) EXPECT_NEAR(is[c][r], should[c][r], 1e-12) << r << " " << c;
}

// The camera goes around the point it looks at, at an even speed, and keeps its distance. Its right
// side stays on one side: the picture is not mirrored.
TEST(PoseAnimation, ACameraTurnsAroundItsTarget) {
  const Scene scene = scene_with("Shape \"sphere\"");
  const PoseAnimation animation =
      animation_of(scene,
                   "{\"time\": 0, \"camera\": {\"eye\": [1, 2, 13], \"target\": [1, 2, 3]}}\n"
                   "{\"time\": 2, \"camera\": {\"eye\": [11, 2, 3], \"target\": [1, 2, 3]}}\n"
                   "{\"time\": 4, \"camera\": {\"eye\": [1, 2, -7], \"target\": [1, 2, 3]}}\n");
  for (double t = 0; t <= 4; t += 0.25) {
    const double angle = pi / 4 * t, s = std::sin(angle), c = std::cos(angle);
    const glm::dmat4 is = scene_at(scene, animation, t).view.camera.world_from_camera;
    // As LookAt of the file: left-handed, so right is -x where the camera looks along -z.
    expect_matrix(is,
                  {{-c, 0, s, 0}, {0, 1, 0, 0}, {-s, 0, -c, 0}, {1 + 10 * s, 2, 3 + 10 * c, 1}});
  }
}

// The distance goes by factors: after half the time it is the geometric mean. The field of view
// goes by even steps, and the target by a line.
TEST(PoseAnimation, ACameraComesNearerByFactors) {
  const Scene scene = scene_with("Shape \"sphere\"");
  const PoseAnimation animation = animation_of(
      scene,
      "{\"time\": 1, \"camera\": {\"eye\": [0, 0, 16], \"target\": [0, 0, 0], \"fov\": 20}}\n"
      "{\"time\": 2, \"camera\": {\"eye\": [2, 0, 1], \"target\": [2, 0, 0], \"fov\": 60}}\n");
  const Camera camera = scene_at(scene, animation, 1.5).view.camera;
  EXPECT_NEAR(camera.world_from_camera[3].x, 1, 1e-12);
  EXPECT_NEAR(camera.world_from_camera[3].z, 4, 1e-12);
  EXPECT_NEAR(fov_of(camera), 40 * pi / 180, 1e-12);
  EXPECT_TRUE(camera.motion.empty());
}

// Over the pole the view goes along up.
TEST(PoseAnimation, ACameraGoesOverThePole) {
  const Scene scene = scene_with("Shape \"sphere\"");
  const PoseAnimation animation =
      animation_of(scene,
                   "{\"time\": 0, \"camera\": {\"eye\": [0, 6, 8], \"target\": [0, 0, 0]}}\n"
                   "{\"time\": 2, \"camera\": {\"eye\": [0, 6, -8], \"target\": [0, 0, 0]}}\n");
  const glm::dmat4 m = scene_at(scene, animation, 1).view.camera.world_from_camera;
  EXPECT_NEAR(m[3].y, 10, 1e-9);
  EXPECT_NEAR(m[2].y, -1, 1e-9);
}

// A camera of which one key is a transform turns about its own place.
TEST(PoseAnimation, ACameraOfTransformsGoesOnAsTransformsDo) {
  const Scene scene = scene_with("Shape \"sphere\"");
  const PoseAnimation animation = animation_of(
      scene,
      "{\"time\": 0, \"camera\": {\"eye\": [0, 0, 10], \"target\": [0, 0, 0]}}\n"
      "{\"time\": 2, \"camera\": {\"transform\": [0, 0, -1, 10,  0, 1, 0, 0,  1, 0, 0, 0]}}\n");
  const double h = std::sqrt(0.5);
  expect_matrix(scene_at(scene, animation, 1).view.camera.world_from_camera,
                {{-h, 0, h, 0}, {0, 1, 0, 0}, {-h, 0, -h, 0}, {5, 0, 5, 1}});
}

TEST(PoseAnimation, ACameraOfWhichOneKeyIsATransformGoesStraight) {
  const Scene scene = scene_with("Shape \"sphere\"");
  for (const char* lines :
       {"{\"time\": 0, \"camera\": {\"transform\": [-1, 0, 0, 0,  0, 1, 0, 0,  0, 0, -1, 10]}}\n"
        "{\"time\": 2, \"camera\": {\"eye\": [10, 0, 0], \"target\": [0, 0, 0]}}\n",
        "{\"time\": 0, \"camera\": {\"eye\": [0, 0, 10], \"target\": [0, 0, 0]}}\n"
        "{\"time\": 2, \"camera\": {\"transform\": [0, 0, -1, 10,  0, 1, 0, 0,  1, 0, 0, 0]}}\n"}) {
    const glm::dmat4 m =
        scene_at(scene, animation_of(scene, lines), 1).view.camera.world_from_camera;
    EXPECT_NEAR(m[3].x, 5, 1e-12) << lines;
    EXPECT_NEAR(m[3].z, 5, 1e-12) << lines;
  }
}

// Everything follows the poses that name it. Transforms turn about the middle of what they place.
TEST(PoseAnimation, PartsFollowThePosesThatNameThem) {
  const Scene scene = scene_with(parts);
  ASSERT_EQ(scene.shapes.size(), 2U);
  Scene named = scene;
  named.shapes[0].name = "rod";
  const PoseAnimation animation = animation_of(
      named,
      "{\"time\": 0, \"shapes\": {\"ball\": [1,0,0,0, 0,1,0,0, 0,0,1,0]}, \"instances\": {\"0\": "
      "[1,0,0,0, 0,1,0,0, 0,0,1,0]}}\n"
      "{\"time\": 1, \"capsules\": {\"rod\": {\"p0\": [[0, 0, 0]], \"radius\": [[1, 2]]}}}\n"
      "{\"time\": 2, \"shapes\": {\"ball\": [1,0,0,4, 0,1,0,0, 0,0,1,0]}, \"instances\": {\"0\": "
      "[0,0,1,0, 0,1,0,0, -1,0,0,0]}}\n"
      "{\"time\": 3, \"capsules\": {\"rod\": {\"p0\": [[0, 4, 0]], \"p1\": [[9, 0, 0]], "
      "\"radius\": [[3, 0]]}}}\n");
  const Scene at = scene_at(named, animation, 1.5);
  EXPECT_NEAR(at.shapes[1].world_from_object[3].x, 3, 1e-12);
  // The middle of the object, (1, 0, 0), goes straight to (0, 0, -1), while it turns by 67.5
  // degrees.
  const glm::dmat4 instance = at.instances[0].world_from_object;
  const glm::dvec4 middle = instance * glm::dvec4(1, 0, 0, 1);
  EXPECT_NEAR(middle.x, 0.25, 1e-12);
  EXPECT_NEAR(middle.z, -0.75, 1e-12);
  EXPECT_NEAR(instance[0].x, std::cos(0.375 * pi), 1e-12);
  const Capsule rod = capsule_at(at, {std::nullopt, 0}, 0);
  EXPECT_EQ(rod.p0, glm::vec3(0, 1, 0));
  EXPECT_EQ(rod.p1, glm::vec3(3, 0, 0));
  EXPECT_EQ(rod.radius0, 1.5F);
  EXPECT_EQ(rod.radius1, 1.5F);
  // Before its first pose and after its last one a part rests.
  EXPECT_EQ(capsule_at(scene_at(named, animation, 0.5), {std::nullopt, 0}, 0).radius1, 2.0F);
  EXPECT_EQ(scene_at(named, animation, 3).shapes[1].world_from_object[3].x, 4);
}

// While the shutter is open, here from 3 s to 5 s, camera and instances go on for the exposure.
TEST(PoseAnimation, CameraAndInstancesMoveWhileTheShutterIsOpen) {
  const Scene scene = scene_with(parts);
  const PoseAnimation animation = animation_of(
      scene,
      "{\"time\": 0, \"camera\": {\"eye\": [0, 0, 10], \"target\": [0, 0, 0]}, \"instances\": "
      "{\"0\": [1,0,0,0, 0,1,0,0, 0,0,1,0]}}\n"
      "{\"time\": 2, \"camera\": {\"eye\": [10, 0, 0], \"target\": [0, 0, 0]}, \"instances\": "
      "{\"0\": [1,0,0,8, 0,1,0,0, 0,0,1,0]}}\n");
  const Scene at = scene_at(scene, animation, 0.5, 1);
  const TransformKeys& camera = at.view.camera.motion;
  const TransformKeys& instance = at.instances[0].motion;
  ASSERT_EQ(camera.size(), instance.size());
  ASSERT_GE(camera.size(), 3U);
  EXPECT_EQ(camera.front().time, 3);
  EXPECT_EQ(camera.back().time, 5);
  EXPECT_EQ(camera.front().matrix, at.view.camera.world_from_camera);
  for (std::size_t i = 0; i < camera.size(); ++i) {
    const double time = 0.5 + (camera[i].time - 3) / 2;
    EXPECT_NEAR(camera[i].matrix[3].x, 10 * std::sin(pi / 4 * time), 1e-12);
    EXPECT_NEAR(instance[i].matrix[3].x, 4 * time, 1e-12);
  }
  EXPECT_TRUE(scene_at(scene, animation, 0.5).instances[0].motion.empty());
}

TEST(PoseAnimation, RefusesTurnsThatCanGoEitherWay) {
  const Scene scene = scene_with("Shape \"sphere\" \"string name\" \"ball\"");
  const auto error = [&](const std::string& lines) {
    return test::complaint([&] { animation_of(scene, lines); });
  };
  const std::string first =
      "{\"time\": 0, \"camera\": {\"eye\": [0, 0, 9], \"target\": [0, 0, 0]}}\n";
  EXPECT_THAT(
      error(first + "{\"time\": 1, \"camera\": {\"eye\": [0, 0, -5], \"target\": [0, 0, 0]}}\n"),
      testing::AllOf(HasSubstr(":2"), HasSubstr("place around its target makes half a turn")));
  EXPECT_THAT(error(first + "{\"time\": 1, \"camera\": {\"eye\": [0, 0, 9], \"target\": [0, 0, 0], "
                            "\"up\": [0, -2, 0]}}\n"),
              HasSubstr("up makes half a turn"));
  EXPECT_THAT(error("{\"time\": 0, \"shapes\": {\"ball\": [1,0,0,0, 0,1,0,0, 0,0,1,0]}}\n"
                    "{\"time\": 1, \"shapes\": {\"ball\": [-1,0,0,0, 0,1,0,0, 0,0,1,0]}}\n"),
              HasSubstr("mirrors"));
}

TEST(PoseTimes, AreCountedAndChecked) {
  const auto count = [](const std::string& lines) {
    return count_poses(test::write_file("poses.jsonl", lines));
  };
  EXPECT_EQ(count("{}\n\n{}\n").poses, 2U);
  EXPECT_FALSE(count("{}\n").seconds);
  const PoseCount timed = count("{\"time\": -1}\n{\"time\": 0.5}\n{\"time\": 4}\n");
  EXPECT_EQ(timed.poses, 3U);
  EXPECT_EQ(timed.seconds, std::pair(-1.0, 4.0));
  const Scene scene = scene_with("Shape \"sphere\"");
  const auto error = [&](const std::string& lines) {
    return test::complaint([&] {
      count(lines);
      read_poses(test::write_file("poses.jsonl", lines), scene);
    });
  };
  EXPECT_THAT(error("{\"time\": 1}\n{\"time\": 1}\n"), HasSubstr(":2: time: 1 is not after 1"));
  EXPECT_THAT(error("{\"time\": 2}\n{\"time\": 1}\n"), HasSubstr(":2: time: 1 is not after 2"));
  EXPECT_THAT(error("{\"time\": 1}\n{}\n"), HasSubstr(":2: time is missing"));
  EXPECT_THAT(error("{}\n{\"time\": 1}\n"), HasSubstr(":2: time is in all poses or in none"));
  EXPECT_THAT(error("{\"time\": \"1 s\"}\n"), HasSubstr("a number of seconds is needed"));
  EXPECT_THAT(error("{\"time\": 1}\n[\n"), HasSubstr("no JSON object"));
}

}  // namespace
}  // namespace caplet::pose_animation_test
