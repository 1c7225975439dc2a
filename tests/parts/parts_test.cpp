// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Trees in parts against the same trees in one buffer: hits and pictures are the same to the bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <optional>
#include <random>
#include <utility>

#include "import/import.h"
#include "lower/live_scene.h"
#include "lower/lower.h"
#include "lower/packed_nodes.h"
#include "lower/tree_file.h"
#include "parts_of.h"
#include "render/detail/array_parts.h"
#include "render/device_scene.h"
#include "render/query.h"
#include "render_scene.h"
#include "support/data.h"
#include "support/import_files.h"
#include "support/rays.h"

namespace caplet::test {
namespace {

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

/// Returns how many parts an array of a scene lies in.
std::size_t parts_of(const FlatScene& flat, const std::vector<float>& array) {
  const std::size_t distance =
      part_distance(most_buffer_bytes(test_device()), flat.arrays(), Encoding::wide);
  std::size_t count = 0;
  for (std::size_t i = 0; i < array_parts; ++i)
    if (!array_part(std::span(array), distance, i).empty()) ++count;
  return count;
}

// --- How they are divided ---

TEST(ArrayParts, CoverTheArrayAndOverlap) {
  std::vector<float> leaves(1000000);
  std::iota(leaves.begin(), leaves.end(), 0.0f);
  SceneArrays arrays;
  arrays.leaves = leaves;
  const auto distance_of = [&](std::uint64_t bytes) {
    return part_distance(bytes, arrays, Encoding::wide);
  };
  EXPECT_EQ(array_part(arrays.leaves, 0, 0).size(), leaves.size());
  EXPECT_TRUE(array_part(arrays.leaves, 0, 1).empty());
  for (const std::size_t bytes : {1100000U, 1500000U, 2000000U, 3999999U}) {
    SCOPED_TRACE(bytes);
    const std::size_t distance = distance_of(bytes);
    ASSERT_GT(distance, 0U);
    EXPECT_EQ(distance % 1024, 0U) << "parts begin at pages";
    std::size_t end = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto part = array_part(arrays.leaves, distance, i);
      EXPECT_LE(part.size_bytes(), bytes);
      if (part.empty()) continue;
      EXPECT_EQ(part[0], static_cast<float>(i * distance));
      end = i * distance + part.size();
      if (end < leaves.size()) {
        EXPECT_GE(part.size(), distance + distance / 9);  // they overlap
      }
    }
    EXPECT_EQ(end, leaves.size());
  }
  EXPECT_EQ(distance_of(4000000), 0U) << "they fit";
  EXPECT_EQ(distance_of(900000), 0U) << "four parts are too few";
}

// Packed nodes are shorter than those of the scene.
TEST(ArrayParts, AreThoseOfTheNodesThatTheDeviceHas) {
  const std::vector<float> nodes(std::size_t{CAPLET_NODE_FLOATS} * 10000);
  SceneArrays arrays;
  arrays.nodes = nodes;
  const std::uint64_t packed = packed_nodes(nodes).size() * sizeof(float);
  EXPECT_GT(part_distance(packed, arrays, Encoding::wide), 0U);
  EXPECT_EQ(part_distance(packed, arrays, Encoding::single), 0U);
  EXPECT_GT(part_distance(packed - 1, arrays, Encoding::single), 0U);
}

TEST(ArrayParts, AreAsTheVariableSays) {
  const Device& device = test_device();
  EXPECT_EQ(most_buffer_bytes(device), device.info().max_allocation_bytes);
  {
    const PartsOf limit(1048576);
    EXPECT_EQ(most_buffer_bytes(device), 1048576U);
  }
  ::setenv("CAPLET_BUFFER_BYTES", "99999999999999999", 1);
  EXPECT_EQ(most_buffer_bytes(device), device.info().max_allocation_bytes);
  ::setenv("CAPLET_BUFFER_BYTES", "1048575", 1);
  EXPECT_THAT(complaint([&] { most_buffer_bytes(device); }),
              testing::HasSubstr("CAPLET_BUFFER_BYTES: '1048575' is no number of bytes"));
  ::unsetenv("CAPLET_BUFFER_BYTES");
}

// Arrays without parts are sent as they are, also where others are divided.
TEST(ArrayParts, OthersAreWhole) {
  FlatScene flat = lower(scene_named("gallery.pbrt"));
  constexpr std::size_t most = part_bytes / sizeof(float);  // a part has up to 1,150 fewer
  flat.surface_materials.resize(most);
  const PartsOf limit(part_bytes);
  ASSERT_GT(parts_of(flat, flat.leaves), 1U);
  const DeviceScene scene(test_device(), flat);
  EXPECT_EQ(scene.bindings().surfaces->surface_materials.size(), most);
  EXPECT_LT(scene.bindings().tree->leaves.size(), most);
}

// What has no parts is refused by name.
TEST(ArrayParts, OthersAreRefused) {
  FlatScene flat = lower(scene_named("gallery.pbrt"));
  flat.surface_materials.resize(400000);
  const PartsOf limit(part_bytes);
  try {
    const DeviceScene scene(test_device(), flat);
    FAIL() << "it was sent";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("2 MB in one buffer (surface_materials)"));
  }
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
    ASSERT_GT(parts_of(flat, flat.leaves), 1U);
    Query divided(flat, device);
    EXPECT_TRUE(same_bits(divided.closest(rays, times), nearest));
    const HitLists found = divided.all(rays, 64, times);
    EXPECT_EQ(found.begin, expected.begin);
    EXPECT_TRUE(same_bits(found.crossings, expected.crossings));
    EXPECT_GT(found.crossings.size(), 100U);
  }
}

TEST(ArrayParts, AreFourOfSomeScene) {
  const FlatScene flat = lower(scene_named("hair.pbrt"));
  const PartsOf limit(part_bytes);
  EXPECT_EQ(parts_of(flat, flat.leaves), 4U);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Parts,
                         testing::Values("hair.pbrt", "motion.pbrt", "instances.pbrt",
                                         "gallery.pbrt"),
                         [](const auto& name) {
                           const std::string text = name.param;
                           return text.substr(0, text.find('.'));
                         });

/// Puts so many nodes before those of the scene.
void move_nodes(FlatScene& flat, std::uint32_t count) {
  for (std::size_t node = 0; node < flat.nodes.size(); node += CAPLET_NODE_FLOATS)
    for (std::size_t i = 0; i < CAPLET_WIDTH; ++i) {
      float& child = flat.nodes[node + CAPLET_NODE_CHILDREN + i];
      const auto number = std::bit_cast<std::uint32_t>(child);
      if (number >> 31 == 0) child = std::bit_cast<float>(number + count);
    }
  const std::vector<float> first(flat.nodes.begin(), flat.nodes.begin() + CAPLET_NODE_FLOATS);
  std::vector<float> all;
  for (std::uint32_t i = 0; i < count; ++i) all.insert(all.end(), first.begin(), first.end());
  all.insert(all.end(), flat.nodes.begin(), flat.nodes.end());
  flat.nodes = std::move(all);
  flat.world.root += count;
  for (InstanceRecord& instance : flat.instances) instance.root += count;
}

// Nodes have a fifth of the leaves' bytes: those of the scene are put into the second part.
TEST(PartsOfNodes, AreHitAlike) {
  for (const char* const name : {"hair.pbrt", "instances.pbrt"}) {
    FlatScene flat = lower(scene_named(name));
    const std::vector<RayRecord> rays = rays_through(flat, 2000);
    const FlatScene before = flat;
    move_nodes(flat, 14000);
    for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
      const Device device = test_device(encoding);
      Query whole(before, device);
      const PartsOf limit(part_bytes);
      ASSERT_GT(parts_of(flat, flat.nodes), 1U);
      ASSERT_GT(parts_of(flat, packed_nodes(flat.nodes)), 1U);
      Query divided(flat, device);
      EXPECT_TRUE(same_bits(divided.closest(rays), whole.closest(rays)));
      EXPECT_TRUE(same_bits(divided.all(rays, 64).crossings, whole.all(rays, 64).crossings));
    }
  }
}

// Queries take as many rays at a time as fit into a buffer.
TEST(PartsOfQueries, TakeNoLargerBuffers) {
  const FlatScene flat = lower(scene_named("hair.pbrt"));
  const Device device = test_device(Encoding::wide);
  const std::vector<RayRecord> rays = rays_through(flat, 60000);
  Query whole(flat, device);
  const std::vector<PickRecord> expected = whole.closest(rays);
  const PartsOf limit(part_bytes);
  Query divided(flat, device);
  const std::uint64_t before = device.bytes_allocated();
  EXPECT_TRUE(same_bits(divided.closest(rays), expected));
  EXPECT_LE(device.bytes_allocated() - before, 2 * part_bytes);  // rays, and what they meet
}

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
class PartsOfEdits : public testing::TestWithParam<Encoding> {};

TEST_P(PartsOfEdits, GrowAndShrink) {
  Scene scene = scene_named("neuron.swc");
  LiveScene live(scene);
  const Device device = test_device(GetParam());
  DeviceScene on_device(device, live.flat());
  Query query(on_device);
  std::vector<RayRecord> rays = rays_through(live.flat(), 2000);
  const auto expect_same = [&] {
    on_device.update(live.flat(), live.take_changes());
    const HitLists found = query.all(rays, 64);
    ::unsetenv("CAPLET_BUFFER_BYTES");
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
      const glm::vec3 away(0, static_cast<float>(3 * round), 0);  // out of the boxes of before
      to.p0 += away;
      to.p1 += away;
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

INSTANTIATE_TEST_SUITE_P(Encodings, PartsOfEdits,
                         testing::Values(Encoding::wide, Encoding::single));

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
  ::unsetenv("CAPLET_BUFFER_BYTES");
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
  ::unsetenv("CAPLET_BUFFER_BYTES");
  EXPECT_TRUE(same_bits(found, Query(flat, device).closest(rays)));
}

}  // namespace
}  // namespace caplet::test
