// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Animations of glTF files: keys at the file's times, ways between them by closed forms.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <numbers>

#include "import/import.h"
#include "support/import_files.h"

namespace caplet::gltf_animation_test {
namespace {

using testing::HasSubstr;

constexpr double pi = std::numbers::pi;
const double half_angle = std::sqrt(0.5);  // sine and cosine of half a right angle

/// A channel, and the floats of its sampler.
struct Channel {
  int node;
  std::string path;
  std::vector<float> times, values;
  std::string way = "LINEAR";
};

/// A file whose mesh 0 is a triangle, with the nodes and an animation.
std::string text_of(const std::string& nodes, const std::vector<Channel>& channels,
                    const std::string& more = "") {
  std::vector<float> floats{0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::string views = R"({"buffer":0,"byteLength":36})",
              accessors = R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})",
              targets, samplers;
  int count = 1;
  const auto add = [&](const std::vector<float>& values, std::size_t components) {
    const char* const types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    views += fmt::format(R"(,{{"buffer":0,"byteOffset":{},"byteLength":{}}})", 4 * floats.size(),
                         4 * values.size());
    accessors += fmt::format(R"(,{{"bufferView":{},"componentType":5126,"count":{},"type":"{}"}})",
                             count, values.size() / components, types[components - 1]);
    floats.insert(floats.end(), values.begin(), values.end());
    return count++;
  };
  for (const Channel& channel : channels) {
    const std::size_t components = channel.path == "rotation"  ? 4
                                   : channel.path == "weights" ? 1
                                                               : 3;
    const int input = add(channel.times, 1), output = add(channel.values, components);
    targets += fmt::format(R"({}{{"sampler":{},"target":{{"node":{},"path":"{}"}}}})",
                           targets.empty() ? "" : ",", (count - 3) / 2, channel.node, channel.path);
    samplers += fmt::format(R"({}{{"input":{},"output":{},"interpolation":"{}"}})",
                            samplers.empty() ? "" : ",", input, output, channel.way);
  }
  std::string bytes(4 * floats.size(), '\0');
  std::memcpy(bytes.data(), floats.data(), bytes.size());
  test::write_beside("animation.bin", bytes);
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":{},)"
      R"("meshes":[{{"name":"tri","primitives":[{{"attributes":{{"POSITION":0}}}}]}}],)"
      R"("buffers":[{{"byteLength":{},"uri":"animation.bin"}}],"bufferViews":[{}],"accessors":[{}],)"
      R"("animations":[{{"channels":[{}],"samplers":[{}]}}]{}}})",
      nodes, bytes.size(), views, accessors, targets, samplers, more);
}

Scene scene_of(const std::string& nodes, const std::vector<Channel>& channels,
               const std::string& more = "") {
  const std::string text = text_of(nodes, channels, more);
  return import_scene(test::write_beside("animation.gltf", text), test::OneTexel());
}

glm::dvec3 place(const glm::dmat4& m, const glm::dvec3& p) {
  return glm::dvec3(m * glm::dvec4(p, 1));
}
void expect_point(const glm::dvec3& is, const glm::dvec3& should, double within = 1e-6) {
  EXPECT_LE(glm::length(is - should), within) << is.x << " " << is.y << " " << is.z;
}

TEST(GltfAnimation, KeysAreThoseOfTheFile) {
  const auto h = static_cast<float>(half_angle);
  const Scene scene = scene_of(R"([{"mesh":0,"name":"it","translation":[9,9,9],"scale":[2,1,1]}])",
                               {{0, "translation", {1.5F, 2.5F}, {0, 0, 1, 4, 0, 1}},
                                {0, "rotation", {0.5F, 2.5F}, {0, 0, 0, 1, 0, 0, h, h}}});
  ASSERT_EQ(scene.instances.size(), 1U);
  ASSERT_TRUE(scene.shapes.empty());
  EXPECT_EQ(scene.objects.at(0).shapes.at(0).name, "it");
  const Instance& it = scene.instances[0];
  ASSERT_EQ(it.motion.size(), 3U);
  EXPECT_EQ(it.motion[0].time, 0.5);
  EXPECT_EQ(it.motion[1].time, 1.5);
  EXPECT_EQ(it.motion[2].time, 2.5);
  EXPECT_EQ(it.world_from_object, it.motion[0].matrix);
  expect_point(place(it.motion[0].matrix, {1, 0, 0}), {2, 0, 1});
  // After half of the turn x points along the diagonal; its scale stays.
  expect_point(place(it.motion[1].matrix, {1, 0, 0}), {2 * half_angle, 2 * half_angle, 1});
  expect_point(place(it.motion[2].matrix, {1, 0, 0}), {4, 2, 1});
  // The exposure is short, and the picture as bright as that of a file that rests.
  EXPECT_EQ(scene.view.film.shutter_open, 0);
  EXPECT_EQ(scene.view.film.exposure_time, 0.02);
  EXPECT_NEAR(scene.view.film.exposure_time * scene.view.film.iso, 100, 1e-9);
}

// A child at (1, 0, 0) of a node that makes a quarter turn follows the circle.
TEST(GltfAnimation, AChildFollowsWhatItLiesWithin) {
  const auto h = static_cast<float>(half_angle);
  const Scene scene = scene_of(
      R"([{"children":[1]},{"children":[2],"translation":[1,0,0]},{"mesh":0,"scale":[3,3,3]}])",
      {{0, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, h, h}}});
  const TransformKeys& motion = scene.instances.at(0).motion;
  ASSERT_GE(motion.size(), 2U);
  const AnimatedTransform at(motion);
  for (double t = 0; t <= 1; t += 0.01) {
    const double angle = pi / 2 * t;
    // A chord of 1 / 32 of a quarter turn; 1e-6 for h as a float.
    expect_point(place(at.at(t), {0, 0, 0}), {std::cos(angle), std::sin(angle), 0},
                 1 - std::cos(pi / 128) + 1e-6);
    expect_point(place(at.at(t), {0, 0, 1}) - place(at.at(t), {0, 0, 0}), {0, 0, 3});
  }
}

// What turns within a node that is twice as wide follows an ellipse.
TEST(GltfAnimation, AChildIsStretchedByWhatItLiesWithin) {
  const auto h = static_cast<float>(half_angle);
  const Scene scene = scene_of(R"([{"children":[1],"scale":[2,1,1]},{"mesh":0}])",
                               {{1, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, h, h}}});
  const AnimatedTransform at(scene.instances.at(0).motion);
  for (double t = 0; t <= 1; t += 0.01) {
    const double angle = pi / 2 * t;
    expect_point(place(at.at(t), {1, 0, 0}), {2 * std::cos(angle), std::sin(angle), 0}, 1e-3);
  }
}

TEST(GltfAnimation, StepsHoldTheirValues) {
  const Scene scene = scene_of(
      R"([{"mesh":0}])", {{0, "translation", {1, 2, 4}, {0, 0, 0, 5, 0, 0, 7, 0, 0}, "STEP"}});
  const AnimatedTransform at(scene.instances.at(0).motion);
  for (const auto& [time, x] : {std::pair{0.0, 0.0},
                                {1.5, 0.0},
                                {1.9999, 0.0},
                                {2.0, 5.0},
                                {3.9999, 5.0},
                                {4.0, 7.0},
                                {9.0, 7.0}})
    EXPECT_NEAR(at.at(time)[3].x, x, 1e-9) << time;
}

// Hermite's cubic with the velocity 1 at the first key and 3 at the second, 2 seconds later.
TEST(GltfAnimation, SplinesHaveVelocities) {
  const Scene scene =
      scene_of(R"([{"mesh":0}])", {{0,
                                    "translation",
                                    {0, 2},
                                    {8, 8, 8, 5, 0, 0, 1, 0, 0, 3, 0, 0, 4, 0, 0, 8, 8, 8},
                                    "CUBICSPLINE"}});
  const AnimatedTransform at(scene.instances.at(0).motion);
  for (double t = 0; t <= 2; t += 0.0625) {  // where there are keys
    const double u = t / 2;
    EXPECT_NEAR(at.at(t)[3].x,
                5 * (1 - 3 * u * u + 2 * u * u * u) + 2 * (u * u * u - 2 * u * u + u) +
                    4 * (3 * u * u - 2 * u * u * u) + 6 * (u * u * u - u * u),
                1e-9)
        << t;
  }
}

// The triangle's corner (1, 0, 0) turns by up to 240 degrees about the origin: what is far from all
// keys' boxes is outside, and the keys' boxes are inside.
TEST(GltfAnimation, BoundsHoldTheWholeWay) {
  std::vector<float> times, turns;
  for (int i = 0; i <= 24; ++i) {
    const double half = pi / 180 * 10 * i / 2;
    times.push_back(static_cast<float>(i));
    for (const double v : {0.0, 0.0, std::sin(half), std::cos(half)})
      turns.push_back(static_cast<float>(v));
  }
  const Bounds bounds = bounds_of(scene_of(R"([{"mesh":0}])", {{0, "rotation", times, turns}}));
  // The box of the triangle is a square of side 1, whose corner (1, 1) is furthest.
  EXPECT_NEAR(bounds.min.x, -std::sqrt(2.0), 0.01);
  EXPECT_NEAR(bounds.max.y, std::sqrt(2.0), 0.01);
  EXPECT_NEAR(bounds.min.y, -std::sqrt(2.0), 0.01);
  EXPECT_NEAR(bounds.max.x, 1, 1e-6);
}

TEST(GltfAnimation, ACameraMoves) {
  const Scene scene =
      scene_of(R"([{"mesh":0,"children":[1,2]},{"camera":0,"scale":[2,2,2]},{"mesh":0}])",
               {{1, "translation", {0, 1}, {0, 0, 4, 2, 0, 4}}},
               R"(,"cameras":[{"perspective":{"yfov":0.5},"type":"perspective"}])");
  ASSERT_EQ(scene.instances.size(), 2U);
  for (const Instance& one : scene.instances)
    EXPECT_TRUE(one.motion.empty()) << "what is around and beside the camera rests";
  const Camera& camera = scene.view.camera;
  ASSERT_EQ(camera.motion.size(), 2U);
  expect_point(place(camera.motion[1].matrix, {1, 2, 3}), {3, 2, 1});
  expect_point(place(camera.world_from_camera, {1, 2, 3}), {1, 2, 1});
  EXPECT_EQ(scene.view.film.exposure_time, 0.02);
}

// One key places a node; a scale of 0 hides it.
TEST(GltfAnimation, OneKeyIsAPlace) {
  const Scene scene = scene_of(R"([{"mesh":0}])", {{0, "translation", {3}, {1, 2, 3}}});
  expect_point(place(scene.shapes.at(0).world_from_object, {0, 0, 0}), {1, 2, 3});
  EXPECT_EQ(scene.view.film.exposure_time, 1);
  const Scene hidden = scene_of(R"([{"mesh":0}])", {{0, "scale", {0, 1}, {0, 0, 0, 1, 1, 1}}});
  const TransformKeys& motion = hidden.instances.at(0).motion;
  EXPECT_NEAR(motion.at(0).matrix[0].x, 0, 1e-5);
  EXPECT_EQ(motion.at(1).matrix[0].x, 1);
}

TEST(GltfAnimation, SaysWhatIsLeftOut) {
  const std::string text =
      text_of(R"([{"mesh":0}])", {{0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0}}});
  const std::string second = R"("animations":[{"channels":[],"samplers":[]},)";
  testing::internal::CaptureStderr();
  const std::size_t at = text.find("\"animations\":[");
  const Scene scene =
      import_scene(test::write_beside("animation.gltf", std::string(text).replace(at, 14, second)),
                   test::OneTexel());
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr("the first of 2 animations is read"));
  EXPECT_EQ(scene.shapes.size(), 1U);
}

TEST(GltfAnimation, RefusesWhatIsNone) {
  const auto error = [](const Channel& channel, const std::string& nodes = R"([{"mesh":0}])") {
    return test::complaint([&] { scene_of(nodes, {channel}); });
  };
  EXPECT_THAT(error({0, "translation", {1, 1}, {0, 0, 0, 1, 1, 1}}), HasSubstr("do not rise"));
  EXPECT_THAT(error({0, "translation", {1, 2}, {0, 0, 0}}), HasSubstr("2 times and 1 values"));
  EXPECT_THAT(error({0, "translation", {1, 2}, {0, 0, 0, 1, 1, 1}, "CUBICSPLINE"}),
              HasSubstr("2 times and 2 values"));
  EXPECT_THAT(error({0, "translation", {1}, {0, 0, 0}, "ROUND"}), HasSubstr("'ROUND'"));
  EXPECT_THAT(error({0, "color", {1}, {0, 0, 0}}), HasSubstr("animation of 'color'"));
  EXPECT_THAT(error({7, "translation", {1}, {0, 0, 0}}), HasSubstr("node 7: there are 1"));
  EXPECT_THAT(error({0, "rotation", {1}, {0, 0, 0, 0}}), HasSubstr("no quaternion"));
  EXPECT_THAT(error({0, "translation", {1}, {0, 0, 0}},
                    R"([{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}])"),
              HasSubstr("has a matrix and is animated"));
  EXPECT_THAT(error({0, "scale", {0, 1}, {1, 1, 1, -1, 1, 1}}), HasSubstr("mirror image"));
}

}  // namespace
}  // namespace caplet::gltf_animation_test
