// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Tree files say what the scene said that they were written of, bit for bit, or are refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>

#include "import/import.h"
#include "lower/fingerprint.h"
#include "lower/lower.h"
#include "lower/tree_file.h"
#include "render/device_scene.h"
#include "render/query.h"
#include "render_scene.h"
#include "support/data.h"
#include "support/import_files.h"
#include "support/rays.h"

namespace caplet::test {
namespace {

using testing::HasSubstr;

const TreeNotes notes{"first", std::string("a\0b", 3), ""};

Scene scene_named(const std::string& name) {
  return import_scene(source_folder() / "scenes" / name, FileImageReader());
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void replace_content(const std::filesystem::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary) << content;
}

class Trees : public testing::Test {
 protected:
  std::filesystem::path folder_ = temporary_folder();
  std::filesystem::path file_ = folder_ / "a.tree";
};

template <class T>
bool same_bytes(std::span<const T> a, std::span<const T> b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

void expect_same(const FlatScene& a, const FlatScene& b) {
  const SceneArrays of_a = a.arrays(), of_b = b.arrays();
#define GROUP_BEGIN(Type, group)
#define GROUP_END(Type)
#define BUFFER(name, type, access) EXPECT_TRUE(same_bytes(of_a.name, of_b.name)) << #name;
  SCENE_GROUPS
#undef BUFFER
#undef GROUP_END
#undef GROUP_BEGIN
  EXPECT_EQ(a.shapes, b.shapes);
  EXPECT_EQ(a.primitive_count, b.primitive_count);
  EXPECT_EQ(a.bvh_nodes, b.bvh_nodes);
  EXPECT_EQ(a.bvh_depth, b.bvh_depth);
  EXPECT_EQ(a.bvh_sah, b.bvh_sah);
  EXPECT_EQ(a.build_seconds, b.build_seconds);
  EXPECT_EQ(a.leaf_kind_bits, b.leaf_kind_bits);
  EXPECT_EQ(a.sky_is_unseen, b.sky_is_unseen);
  EXPECT_EQ(a.has_moving_operands, b.has_moving_operands);
  EXPECT_EQ(a.has_chains, b.has_chains);
  EXPECT_EQ(a.device_bytes(), b.device_bytes());
  EXPECT_EQ(a.geometry_bytes(), b.geometry_bytes());
  EXPECT_EQ(fingerprint(a), fingerprint(b));
  // What kernels are built by, also by functions of arrays.
  EXPECT_EQ(a.has_media(), b.has_media());
  EXPECT_EQ(a.moves(), b.moves());
  EXPECT_EQ(a.multiscatters(), b.multiscatters());
  EXPECT_EQ(a.material_kinds(), b.material_kinds());
  EXPECT_EQ(a.texture_kinds(), b.texture_kinds());
  EXPECT_EQ(a.light_kinds(), b.light_kinds());
  EXPECT_EQ(a.medium_kinds(), b.medium_kinds());
  for (const Encoding encoding : {Encoding::wide, Encoding::single})
    EXPECT_TRUE(stage_options(a, test_device(encoding)) == stage_options(b, test_device(encoding)));
}

TEST_F(Trees, HoldWhatWasLowered) {
  std::uint64_t kinds = 0;
  for (const char* name : {"gallery.pbrt", "smoke.pbrt", "hair.pbrt", "motion.pbrt",
                           "instances.pbrt", "materials.pbrt", "neuron.swc"}) {
    SCOPED_TRACE(name);
    FlatScene flat = lower(scene_named(name));
    flat.bvh_sah += 0.1;  // others than those of another scene
    write_tree(file_, flat, notes);
    const TreeFile tree = map_tree(file_);
    EXPECT_EQ(tree.notes, notes);
    EXPECT_EQ(tree.fingerprint, fingerprint(flat));
    expect_same(flat, tree.scene);
    EXPECT_NO_THROW(check_tree(file_, tree));
    EXPECT_TRUE(tree.scene.leaves.empty()) << "it is not mapped";
    kinds |= flat.shapes;
  }
  EXPECT_GT(std::popcount(kinds), 8);
}

TEST_F(Trees, KeepEachFlagByItself) {
  FlatScene flat = lower(scene_named("capsules.pbrt"));
  for (bool* flag : {&flat.sky_is_unseen, &flat.has_moving_operands, &flat.has_chains}) {
    *flag = !*flag;
    write_tree(file_, flat, notes);
    expect_same(flat, map_tree(file_).scene);
  }
}

TEST_F(Trees, KnowThatInstancesMove) {
  const FlatScene flat = lower(
      import_scene(write_file("moves.pbrt",
                              "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\n"
                              "ObjectBegin \"a\"\nShape \"sphere\"\nObjectEnd\n"
                              "ActiveTransform EndTime\nTranslate 1 0 0\nActiveTransform All\n"
                              "ObjectInstance \"a\"\n"),
                   FileImageReader()));
  ASSERT_TRUE(flat.moves());
  write_tree(file_, flat, notes);
  expect_same(flat, map_tree(file_).scene);
}

TEST_F(Trees, RaysHitTheSame) {
  for (const char* name : {"gallery.pbrt", "instances.pbrt", "hair.pbrt"}) {
    SCOPED_TRACE(name);
    const FlatScene flat = lower(scene_named(name));
    write_tree(file_, flat, notes);
    const TreeFile tree = map_tree(file_);
    std::mt19937 random(5);
    const auto number = [&] { return static_cast<double>(random() >> 8) * 0x1p-23 - 1; };
    std::vector<RayRecord> rays;
    const WorldRecord& world = flat.world;
    const auto point = [&](double radii) {
      return glm::dvec3(world.center_x, world.center_y, world.center_z) +
             radii * world.radius * glm::dvec3(number(), number(), number());
    };
    for (int i = 0; i < 2000; ++i) {
      const glm::dvec3 from = point(2), to = point(0.5);
      rays.push_back(make_ray(from, to - from));
    }
    for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
      Query expected_by(flat, test_device(encoding)), found_by(tree.scene, test_device(encoding));
      const HitLists expected = expected_by.all(rays, 64), found = found_by.all(rays, 64);
      ASSERT_EQ(found.begin, expected.begin);
      EXPECT_GT(found.crossings.size(), 500U);
      EXPECT_EQ(std::memcmp(found.crossings.data(), expected.crossings.data(),
                            found.crossings.size() * sizeof(PickRecord)),
                0);
    }
  }
}

TEST_F(Trees, StayInTheirFileOnCpus) {
  const Device device = test_device(Encoding::wide);
  if (!device.is_cpu()) GTEST_SKIP() << "the device is no CPU, which gets a copy";
  write_tree(file_, lower(scene_named("hair.pbrt")), notes);
  TreeFile tree = map_tree(file_);
  const std::uint64_t before = device.bytes_allocated(),
                      large = tree.scene.arrays().leaves.size_bytes() +
                              tree.scene.arrays().nodes.size_bytes();
  const DeviceScene scene(device, std::move(tree.scene));
  EXPECT_GT(large, 1U << 20);
  EXPECT_LT(device.bytes_allocated() - before, 1U << 16);
  EXPECT_EQ(tree.scene.arrays().leaves.size_bytes() + tree.scene.arrays().nodes.size_bytes(), large)
      << "what is mapped is not emptied";
}

TEST_F(Trees, OutliveTheirName) {
  const FlatScene flat = lower(scene_named("instances.pbrt"));
  write_tree(file_, flat, notes);
  const TreeFile tree = map_tree(file_);
  write_tree(file_, lower(scene_named("capsules.pbrt")), notes);
  expect_same(flat, tree.scene);
  std::filesystem::remove(file_);
  expect_same(flat, tree.scene);
}

TEST_F(Trees, AreWrittenWholeOrNotAtAll) {
  const FlatScene flat = lower(scene_named("capsules.pbrt"));
  std::vector<double> told;
  write_tree(file_, flat, notes, [&](double fraction) { told.push_back(fraction); });
  ASSERT_FALSE(told.empty());
  EXPECT_TRUE(std::ranges::is_sorted(told));
  EXPECT_EQ(told.back(), 1);
  const std::string before = content_of(file_);
  EXPECT_EQ(before.size(), std::filesystem::file_size(file_));
  EXPECT_THROW(write_tree(file_, lower(scene_named("hair.pbrt")), notes,
                          [](double fraction) {
                            if (fraction > 0.5) throw std::runtime_error("stop");
                          }),
               std::runtime_error);
  EXPECT_EQ(content_of(file_), before);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

// --- Files that are wrong ---

TEST_F(Trees, RefuseOtherFiles) {
  const auto complaint_of = [&](const std::string& content) {
    replace_content(file_, content);
    return complaint([&] { map_tree(file_); });
  };
  EXPECT_THAT(complaint([&] { map_tree(folder_ / "none.tree"); }), HasSubstr("No such file"));
  EXPECT_THAT(complaint([&] { map_tree(folder_); }), HasSubstr("folder"));
  EXPECT_THAT(complaint_of(""), HasSubstr("is no tree file"));
  EXPECT_THAT(complaint_of("WorldBegin\n"), HasSubstr("is no tree file"));
  EXPECT_THAT(complaint_of("caplet tree file"), HasSubstr("cut short"));
  write_tree(file_, lower(scene_named("capsules.pbrt")), notes);
  const std::string good = content_of(file_);
  EXPECT_THAT(complaint_of(good.substr(0, good.size() - 1)), HasSubstr("bytes in place of"));
  EXPECT_THAT(complaint_of(good + "x"), HasSubstr("bytes in place of"));
  std::string other = good;
  std::swap(other[16], other[19]);
  EXPECT_THAT(complaint_of(other), HasSubstr("byte order"));
  other = good;
  other[24] = other[24] == '0' ? '1' : '0';
  EXPECT_THAT(complaint_of(other), HasSubstr("another version of Caplet"));
}

// Whatever byte is changed: it is refused when it is read, or by check_tree.
TEST_F(Trees, RefuseWhatIsDamaged) {
  write_tree(file_, lower(scene_named("smoke.pbrt")), notes);
  const std::string good = content_of(file_);
  // Fillings between parts may be anything.
  const auto is_seen = [&](std::size_t at, char bit) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ bit);
    replace_content(file_, bad);
    try {
      check_tree(file_, map_tree(file_));
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  std::uint32_t header_bytes = 0;
  std::memcpy(&header_bytes, &good[20], sizeof(header_bytes));
  ASSERT_GT(header_bytes, 500U);
  for (std::size_t at = 0; at < header_bytes; at += 3) EXPECT_TRUE(is_seen(at, '\x04')) << at;
  std::mt19937 random(9);
  int seen = 0, in_filling = 0;
  for (int i = 0; i < 300; ++i) {
    const std::size_t at = random() % good.size();
    is_seen(at, '\x40') ? ++seen : ++in_filling;
    if (good[at] != '\0') {
      EXPECT_TRUE(is_seen(at, '\x01')) << at;
    }
  }
  EXPECT_GT(seen, 20);
  EXPECT_GT(in_filling, 20);
}

}  // namespace
}  // namespace caplet::test
