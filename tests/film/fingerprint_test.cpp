// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Hashes of what is rendered: another one for whatever changes a picture.
#include "lower/fingerprint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "lower/lower.h"
#include "scene/scene.h"

namespace caplet {
namespace {

Scene scene_of(double radius) {
  Scene scene;
  scene.materials.emplace_back();
  Shape shape;
  shape.geometry = SphereShape{radius};
  shape.material = 0;
  scene.shapes.push_back(shape);
  return scene;
}

TEST(Fingerprint, IsTheSameForTheSame) {
  EXPECT_EQ(fingerprint(lower(scene_of(1))), fingerprint(lower(scene_of(1))));
  EXPECT_EQ(fingerprint(lower_view(scene_of(1))), fingerprint(lower_view(scene_of(2))));
  EXPECT_EQ(fingerprint(lower(scene_of(1))).size(), 32u);
}

TEST(Fingerprint, DiffersForAnyOtherScene) {
  std::set<std::string> seen;
  std::size_t count = 0;
  const auto add = [&](const std::function<void(FlatScene&)>& change) {
    FlatScene flat = lower(scene_of(1));
    change(flat);
    EXPECT_TRUE(seen.insert(fingerprint(flat)).second) << count;
    ++count;
  };
  add([](FlatScene&) {});
  add([](FlatScene& flat) { flat.shapes ^= 1; });
  add([](FlatScene& flat) { flat.sky_is_unseen = !flat.sky_is_unseen; });
  add([](FlatScene& flat) { flat.has_chains = !flat.has_chains; });
  add([](FlatScene& flat) { flat.has_moving_operands = !flat.has_moving_operands; });
  add([](FlatScene& flat) { flat.leaf_kind_bits += 1; });
  // Each buffer, and which of them a value is in.
#define GROUP_BEGIN(Type, group)
#define GROUP_END(Type)
#define ONE(name) reinterpret_cast<unsigned char*>(&flat.name)[3] ^= 1;
#define IN(name) flat.name.emplace_back();
#define BUFFER(name, type, access) add([](FlatScene& flat) { access(name) });
  SCENE_GROUPS
#undef BUFFER
#undef IN
#undef ONE
  EXPECT_GT(count, 30u);
  // A bit of a buffer of more than a piece.
  std::vector<std::string> long_ones;
  for (const std::size_t place : {0u, 299'999u, 600'000u})
    for (const float value : {0.0f, 1.0f}) {
      FlatScene flat = lower(scene_of(1));
      flat.texture_data.assign(600'001, 0.0f);
      flat.texture_data[place] = value;
      long_ones.push_back(fingerprint(flat));
    }
  EXPECT_EQ(std::set<std::string>(long_ones.begin(), long_ones.end()).size(), 4u);
}

// A buffer that is not noted keeps its hash, so that what is read again can be told.
TEST(Fingerprint, ReadsWhatHasChangedAgain) {
  FlatScene flat = lower(scene_of(1));
  flat.texture_data.assign(600'001, 0.0f);
  SceneFingerprint kept;
  const std::string first = kept.of(flat);
  EXPECT_EQ(first, fingerprint(flat));
  flat.texture_data[400'000] = 1;
  EXPECT_EQ(kept.of(flat), first);
  SceneChanges changes;
  changes.leaves.add(0, 1);
  kept.note(changes);
  EXPECT_EQ(kept.of(flat), first);
  changes.texture_data.add(400'000, 1);
  kept.note(changes);
  EXPECT_EQ(kept.of(flat), fingerprint(flat));
  flat.texture_data.pop_back();  // another length is read in any case
  EXPECT_EQ(kept.of(flat), fingerprint(flat));
  flat.texture_data[3] = flat.leaves[0] = 2;
  SceneChanges all;
  all.all = true;
  kept.note(all);
  EXPECT_EQ(kept.of(flat), fingerprint(flat));
}

TEST(Fingerprint, DiffersForAnyOtherView) {
  std::set<std::string> seen;
  std::size_t count = 0;
  const auto add = [&](const std::function<void(Scene&)>& change) {
    Scene scene = scene_of(1);
    change(scene);
    EXPECT_TRUE(seen.insert(fingerprint(lower_view(scene))).second) << count;
    ++count;
  };
  add([](Scene&) {});
  add([](Scene& scene) { scene.view.sampler.seed = 1; });
  add([](Scene& scene) { scene.view.sampler.kind = SamplerSettings::Kind::independent; });
  add([](Scene& scene) { scene.view.integrator.max_depth += 1; });
  add([](Scene& scene) { scene.view.filter.radius_x = 1.25; });
  add([](Scene& scene) { scene.view.film.max_component_value = 3; });
  add([](Scene& scene) { scene.view.film.width += 1; });
  add([](Scene& scene) { scene.view.camera.world_from_camera[3].x += 1; });
}

}  // namespace
}  // namespace caplet
