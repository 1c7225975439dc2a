// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Leaves in parts against the same leaves in one buffer: hits and pictures are the same to the bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <numeric>
#include <optional>
#include <random>
#include <utility>

#include "import/import.h"
#include "lower/live_scene.h"
#include "lower/lower.h"
#include "lower/tree_file.h"
#include "render/detail/leaf_parts.h"
#include "render/device_scene.h"
#include "render/query.h"
#include "render_scene.h"
#include "support/data.h"
#include "support/import_files.h"
#include "support/rays.h"

namespace caplet::test {
namespace {

/// While an instance exists, a part has so many bytes at most.
class PartsOf {
 public:
  explicit PartsOf(std::size_t bytes) {
    ::setenv("CAPLET_LEAF_PART", std::to_string(bytes).c_str(), 1);
  }
  ~PartsOf() { ::unsetenv("CAPLET_LEAF_PART"); }
  PartsOf(const PartsOf&) = delete;
  PartsOf& operator=(const PartsOf&) = delete;
};

// All tests have parts of one size, so that they share kernels; leaves need from two to four.
constexpr std::size_t part_bytes = 1310720;

/// A scene; small ones with 60,000 capsules more.
Scene scene_named(const std::string& name) {
  Scene out = import_scene(source_folder() / "scenes" / name, FileImageReader());
  if (name != "hair.pbrt") add_cloud(out);
  return out;
}

std::vector<RayRecord> rays_through(const FlatScene& flat, int count) {
  std::mt19937 random(5);
  const auto number = [&] { return static_cast<double>(random() >> 8) * 0x1p-23 - 1; };
  const WorldRecord& world = flat.world;
  const auto point = [&](double radii) {
    return glm::dvec3(world.center_x, world.center_y, world.center_z) +
           radii * world.radius * glm::dvec3(number(), number(), number());
  };
  std::vector<RayRecord> out;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 from = point(2), to = point(0.5);
    out.push_back(make_ray(from, to - from));
  }
  return out;
}

bool same_bits(const std::vector<PickRecord>& a, const std::vector<PickRecord>& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), a.size() * sizeof(PickRecord)) == 0;
}

// --- How they are divided ---

TEST(LeafParts, CoverTheLeavesAndOverlap) {
  std::vector<float> leaves(1000000);
  std::iota(leaves.begin(), leaves.end(), 0.0f);
  const Device& device = test_device();
  EXPECT_EQ(leaf_parts(device, leaves).distance, 0U);
  EXPECT_EQ(leaf_parts(device, leaves).parts[0].size(), leaves.size());
  for (const std::size_t bytes : {1100000U, 1500000U, 2000000U, 3999999U}) {
    SCOPED_TRACE(bytes);
    const PartsOf limit(bytes);
    const LeafParts divided = leaf_parts(device, leaves);
    ASSERT_GT(divided.distance, 0U);
    EXPECT_EQ(divided.distance % 1024, 0U) << "parts begin at pages";
    std::size_t end = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto part = divided.parts[i];
      EXPECT_LE(part.size_bytes(), bytes);
      if (part.empty()) continue;
      EXPECT_EQ(part[0], static_cast<float>(i * divided.distance));
      end = i * divided.distance + part.size();
      if (end < leaves.size()) {
        EXPECT_GE(part.size(), divided.distance + divided.distance / 9);  // they overlap
      }
    }
    EXPECT_EQ(end, leaves.size());
  }
  {
    const PartsOf limit(4000000);
    EXPECT_EQ(leaf_parts(device, leaves).distance, 0U) << "they fit";
  }
  {
    const PartsOf limit(1048576);
    EXPECT_EQ(leaf_parts(device, leaves).distance, 0U) << "four parts are too few";
  }
  ::setenv("CAPLET_LEAF_PART", "1048575", 1);
  EXPECT_THAT(complaint([&] { leaf_parts(device, leaves); }),
              testing::HasSubstr("CAPLET_LEAF_PART: '1048575' is no number of bytes"));
  ::unsetenv("CAPLET_LEAF_PART");
}

// --- What rays see ---

class Parts : public testing::TestWithParam<const char*> {};

TEST_P(Parts, AreHitAlike) {
  const FlatScene flat = lower(scene_named(GetParam()));
  const std::vector<RayRecord> rays = rays_through(flat, 2000);
  std::vector<float> times;
  if (flat.moves())
    for (std::size_t i = 0; i < rays.size(); ++i) times.push_back(static_cast<float>(i % 16) / 16);
  for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
    const Device device = test_device(encoding);
    Query whole(flat, device);
    const HitLists expected = whole.all(rays, 64, times);
    const std::vector<PickRecord> nearest = whole.closest(rays, times);
    const PartsOf limit(part_bytes);
    ASSERT_FALSE(leaf_parts(device, flat.leaves).parts[1].empty());
    Query divided(flat, device);
    EXPECT_TRUE(same_bits(divided.closest(rays, times), nearest));
    const HitLists found = divided.all(rays, 64, times);
    EXPECT_EQ(found.begin, expected.begin);
    EXPECT_TRUE(same_bits(found.crossings, expected.crossings));
    EXPECT_GT(found.crossings.size(), 100U);
  }
}

TEST(LeafParts, SomeSceneHasFour) {
  const FlatScene flat = lower(scene_named("hair.pbrt"));
  const PartsOf limit(part_bytes);
  EXPECT_FALSE(leaf_parts(test_device(), flat.leaves).parts[3].empty());
}

INSTANTIATE_TEST_SUITE_P(Scenes, Parts,
                         testing::Values("hair.pbrt", "motion.pbrt", "instances.pbrt",
                                         "gallery.pbrt"),
                         [](const auto& name) {
                           const std::string text = name.param;
                           return text.substr(0, text.find('.'));
                         });

TEST(PartsOfPictures, AreSeenAlike) {
  Scene scene = scene_named("gallery.pbrt");
  scene.view.film.width = 60;
  scene.view.film.height = 40;
  scene.view.film.crop.reset();
  const FlatScene flat = lower(scene);
  const Rendered whole = render_model(scene, 4);
  const PartsOf limit(part_bytes);
  const Rendered divided = render_model(scene, 4);
  ASSERT_EQ(whole.image.channels.size(), divided.image.channels.size());
  for (const Channel& channel : whole.image.channels) {
    EXPECT_EQ(channel.floats, divided.image.find(channel.name)->floats) << channel.name;
    EXPECT_EQ(channel.uints, divided.image.find(channel.name)->uints) << channel.name;
  }
}

// The device gets parts when leaves outgrow one buffer, and one buffer again when they fit.
TEST(PartsOfEdits, GrowAndShrink) {
  Scene scene = scene_named("neuron.swc");
  LiveScene live(scene);
  const Device device = test_device(Encoding::automatic);
  DeviceScene on_device(device, live.flat());
  Query query(on_device);
  std::vector<RayRecord> rays = rays_through(live.flat(), 2000);
  const auto expect_same = [&] {
    on_device.update(live.flat(), live.take_changes());
    const HitLists found = query.all(rays, 64);
    ::unsetenv("CAPLET_LEAF_PART");
    const HitLists expected = Query(live.flat(), device).all(rays, 64);
    EXPECT_TRUE(same_bits(found.crossings, expected.crossings));
  };
  std::uint32_t shape = 0;  // the one of most capsules
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i)
    if (primitive_count(scene.shapes[i]) > primitive_count(scene.shapes[shape])) shape = i;
  const auto& capsules = std::get<CapsulesShape>(scene.shapes[shape].geometry);
  glm::dmat4 moved = scene.shapes[shape].world_from_object;
  bool divided = false;
  int round = 0;
  for (const bool is_divided : {false, true, true, false}) {
    ++round;
    std::optional<PartsOf> limit;
    if (is_divided) limit.emplace(part_bytes);
    // Some capsules, in all parts; then all of them.
    for (std::size_t i = 0; i < capsules.p0.size(); i += capsules.p0.size() / 9) {
      Capsule to{capsules.p0[i], capsules.p1[i], capsules.radius0[i], capsules.radius0[i]};
      to.p0.y += static_cast<float>(round) * 0.01f;
      live.edit(CapsuleEdit{{{}, shape}, i, to});
      const glm::dvec3 middle(moved * glm::dvec4(0.5f * (to.p0 + to.p1), 1));
      rays.push_back(make_ray(middle + glm::dvec3(0, 0, 1), {0, 0, -1}));
    }
    const std::uint64_t before = on_device.bytes_updated();
    const bool was_divided = std::exchange(divided, is_divided);
    expect_same();
    if (was_divided == is_divided) {
      EXPECT_LT(on_device.bytes_updated() - before, 100000U) << "more than what has changed";
    }
    if (is_divided) limit.emplace(part_bytes);
    moved[3][0] += 5;
    live.edit(TransformEdit{{{}, shape}, moved});
    expect_same();
  }
}

TEST(PartsOfFiles, StayInTheirFileOnCpus) {
  const Device device = test_device(Encoding::wide);
  if (!device.is_cpu()) GTEST_SKIP() << "the device is no CPU, which gets a copy";
  const std::filesystem::path file = temporary_folder() / "a.tree";
  const FlatScene flat = lower(scene_named("hair.pbrt"));
  write_tree(file, flat, {});
  TreeFile tree = map_tree(file);
  const PartsOf limit(part_bytes);
  const std::uint64_t before = device.bytes_allocated();
  DeviceScene scene(device, std::move(tree.scene));
  EXPECT_LT(device.bytes_allocated() - before, 1U << 16);
  const std::vector<RayRecord> rays = rays_through(flat, 2000);
  const std::vector<PickRecord> found = Query(scene).closest(rays);
  ::unsetenv("CAPLET_LEAF_PART");
  EXPECT_TRUE(same_bits(found, Query(flat, device).closest(rays)));
}

// A session of a scene whose memory it gives back.
TEST(PartsOfSessions, AreSentBeforeTheirMemoryIsGivenBack) {
  const FlatScene flat = lower(scene_named("hair.pbrt"));
  const Device device = test_device(Encoding::wide);
  FlatScene spent = flat;
  const PartsOf limit(part_bytes);
  DeviceScene scene(device, std::move(spent));
  EXPECT_TRUE(spent.leaves.empty());
  const std::vector<RayRecord> rays = rays_through(flat, 2000);
  const std::vector<PickRecord> found = Query(scene).closest(rays);
  ::unsetenv("CAPLET_LEAF_PART");
  EXPECT_TRUE(same_bits(found, Query(flat, device).closest(rays)));
}

}  // namespace
}  // namespace caplet::test
