// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Linked capsules against the same capsules each by itself, which other tests compare with the
// reference: what rays see must be the same to the bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "film/develop.h"
#include "lower/encode.h"
#include "lower/geometry_pages.h"
#include "lower/live_scene.h"
#include "lower/lower.h"
#include "render/device_scene.h"
#include "render/query.h"
#include "render_scene.h"
#include "support/rays.h"

namespace caplet::test {
namespace {

using glm::dmat4;
using glm::dvec3;
using glm::vec3;

const Linking all_links{0, 1};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  float number() { return static_cast<float>(engine_() >> 8) * 0x1p-23f - 1; }  // in [-1, 1)
  vec3 vector() { return {number(), number(), number()}; }
  std::size_t below(std::size_t n) { return engine_() % n; }

 private:
  std::mt19937 engine_;
};

/// Walks of up to 30 capsules: of one radius, tapered, and now and then a sphere. `chain`: with u.
CapsulesShape walks(Random& random, int count, bool chain) {
  CapsulesShape out;
  for (int walk = 0; walk < count; ++walk) {
    vec3 at = 2.5f * random.vector();
    float radius = 0.1f, u = 0;
    const std::size_t length = 1 + random.below(30);
    for (std::size_t i = 0; i < length; ++i) {
      const vec3 next = !chain && random.below(12) == 0 ? at : at + 0.35f * random.vector();
      const float thin = random.below(2) == 0 ? radius : 0.06f + 0.04f * random.number();
      out.p0.push_back(at);
      out.p1.push_back(next);
      out.radius0.push_back(radius);
      out.radius1.push_back(thin);
      out.materials.push_back(static_cast<std::uint32_t>(random.below(2)));
      if (chain) out.u.emplace_back(u, u + 0.1f);
      at = next;
      radius = thin;
      u += 0.1f;
    }
  }
  return out;
}

Shape shape_of(CapsulesShape capsules) {
  Shape out;
  out.geometry = std::move(capsules);
  return out;
}

/// Walks in the world, turned, stretched, one-sided, of chains, and in instances.
Scene walking_scene() {
  Random random(3);
  Scene scene;
  scene.materials.resize(2);
  scene.shapes.push_back(shape_of(walks(random, 40, false)));
  scene.shapes.push_back(shape_of(walks(random, 20, true)));
  scene.shapes.push_back(shape_of(walks(random, 10, true)));
  scene.shapes.back().world_from_object =
      glm::rotate(glm::scale(dmat4(1), dvec3(0.8)), 0.7, dvec3(1, 2, 3));
  scene.shapes.push_back(shape_of(walks(random, 10, false)));
  scene.shapes.back().world_from_object = glm::scale(dmat4(1), dvec3(1.1, 0.6, 0.8));
  scene.shapes.push_back(shape_of(walks(random, 10, false)));
  scene.shapes.back().one_sided = true;
  scene.objects.emplace_back().shapes.push_back(shape_of(walks(random, 10, false)));
  scene.objects.back().shapes.push_back(shape_of(walks(random, 5, true)));
  scene.objects.back().shapes.back().reverse_orientation = true;
  for (int i = 0; i < 3; ++i)
    scene.instances.push_back(
        {0, glm::rotate(glm::translate(dmat4(1), dvec3(i - 1)), 0.5 * i, dvec3(0, 1, 1)), {}});
  return scene;
}

std::vector<RayRecord> random_rays(std::size_t count) {
  Random random(17);
  std::vector<RayRecord> out;
  for (std::size_t i = 0; i < count; ++i) {
    const dvec3 o = 6.0 * dvec3(random.vector());
    out.push_back(make_ray(o, 2.5 * dvec3(random.vector()) - o));
  }
  return out;
}

bool same_bits(const PickRecord& a, const PickRecord& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

constexpr std::uint64_t linked_bit = shape_bit(shape_linked_capsule);
constexpr std::uint64_t single_bits = shape_bit(shape_capsule) | shape_bit(shape_tapered_capsule);

void expect_same_hits(const FlatScene& linked, const FlatScene& single) {
  const std::vector<RayRecord> rays = random_rays(8000);
  for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
    Query found_by(linked, test_device(encoding)), expected_by(single, test_device(encoding));
    const std::vector<PickRecord> found = found_by.closest(rays),
                                  expected = expected_by.closest(rays);
    int hits = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_TRUE(same_bits(found[i], expected[i])) << "ray " << i;
      hits += std::isfinite(found[i].t) ? 1 : 0;
    }
    EXPECT_GT(hits, 4000);
    const HitLists lists = found_by.all(rays, 64), all = expected_by.all(rays, 64);
    ASSERT_EQ(lists.begin, all.begin);
    EXPECT_GT(lists.crossings.size(), 20000u);
    for (std::size_t i = 0; i < lists.crossings.size(); ++i)
      ASSERT_TRUE(same_bits(lists.crossings[i], all.crossings[i])) << "crossing " << i;
  }
}

TEST(Links, HitsAreThoseOfTheSameCapsulesUnlinked) {
  const Scene scene = walking_scene();
  const FlatScene linked = lower(scene, all_links), single = lower(scene, Linking::none());
  EXPECT_EQ(linked.shapes & single_bits, 0u);  // runs of one, too
  EXPECT_NE(linked.shapes & linked_bit, 0u);
  EXPECT_EQ(single.shapes & linked_bit, 0u);
  EXPECT_NE(linked.shapes & shape_bit(shape_sphere), 0u);
  expect_same_hits(linked, single);
  // Here short runs stay unlinked, so that a shape has both and keeps its u.
  const FlatScene both = lower(scene, {0, 6});
  EXPECT_NE(both.shapes & single_bits, 0u);
  EXPECT_NE(both.shapes & linked_bit, 0u);
  expect_same_hits(both, single);
}

void expect_same_pictures(const Scene& scene) {
  std::array<LayeredImage, 2> images;
  for (const bool linked : {false, true}) {
    const FlatScene flat = lower(scene, linked ? all_links : Linking::none());
    EXPECT_EQ((flat.shapes & linked_bit) != 0, linked);
    RenderOptions options;
    options.samples_per_pixel = 8;
    const RenderResult result = render(flat, lower_view(scene), test_device(), options, {});
    images[linked ? 1 : 0] = develop(result.film, scene.view.film, options.layers);
  }
  EXPECT_GT(mean_of(images[0], "R").value, 0.1);
  for (const Channel& of : images[0].channels) {
    const std::vector<float>& other = channel(images[1], of.name).floats;
    ASSERT_EQ(of.floats.size(), other.size());
    EXPECT_TRUE(of.floats.empty() ||
                std::memcmp(of.floats.data(), other.data(), 4 * other.size()) == 0)
        << of.name;
  }
}

TEST(Links, PicturesAreThoseOfTheSameCapsulesUnlinked) {
  Scene scene = scene_of_text(R"(
LookAt 0 -9 0  0 0 0  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 60 "integer yresolution" 60
Sampler "independent"
Integrator "volpath" "integer maxdepth" 6
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
LightSource "point" "rgb I" [40 40 40] "point3 from" [4 -6 5]
Texture "stripes" "spectrum" "checkerboard" "float uscale" 20 "float vscale" 4
    "rgb tex1" [0.8 0.2 0.1] "rgb tex2" [0.1 0.2 0.8]
Material "diffuse" "texture reflectance" "stripes"
Shape "sphere" "float radius" 0.01
Material "hair" "float eumelanin" 0.3
Shape "sphere" "float radius" 0.01
)");
  Scene with = walking_scene();
  for (Shape& shape : with.shapes) scene.shapes.push_back(std::move(shape));
  scene.objects = std::move(with.objects);
  scene.instances = std::move(with.instances);
  // Rays among shapes with alpha are traced one by one, others many at once.
  for (const bool alpha : {false, true}) {
    if (alpha) scene.shapes[3].alpha = TextureOperand(0.5);
    expect_same_pictures(scene);
  }
}

/// A straight chain along x: capsule i from i to i + 1.
CapsulesShape straight(std::size_t count, bool chain) {
  CapsulesShape out;
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<float>(i);
    out.p0.emplace_back(x, 2, 3);
    out.p1.emplace_back(x + 1, 2, 3);
    out.radius0.push_back(1 + x);
    out.radius1.push_back(2 + x);
    if (chain) out.u.emplace_back(10 * x, 10 * (x + 1));
  }
  return out;
}

TEST(Links, BlocksHoldPointsOnce) {
  for (const bool chain : {false, true}) {
    Scene scene;
    scene.materials.resize(1);
    scene.shapes.push_back(shape_of(straight(20, chain)));
    const FlatScene flat = lower(scene, all_links);
    // 20 capsules are three blocks: of 6, 7 and 7.
    EXPECT_EQ(flat.leaves.size(), 3u * 8 * (chain ? 6 : 5));
    EXPECT_TRUE(flat.mesh_uvs.empty());
    std::array<bool, 20> seen{};
    for (std::size_t block = 0; block < flat.leaves.size(); block += chain ? 48 : 40) {
      const float* at = &flat.leaves[block];
      const auto id = std::bit_cast<std::uint32_t>(at[0]),
                 count = std::bit_cast<std::uint32_t>(at[1]);
      EXPECT_THAT(count, testing::AnyOf(6u, 7u));
      for (std::uint32_t i = 0; i < count; ++i) {
        seen[id + i] = true;
        EXPECT_EQ(
            primitive_at(flat.leaves, CAPLET_SLOT_LINKED | (static_cast<std::uint32_t>(block) + i)),
            id + i);
      }
      for (std::uint32_t i = 0; i <= count; ++i) {
        const auto x = static_cast<float>(id + i);
        EXPECT_EQ(at[CAPLET_LINK_X + i], x);
        EXPECT_EQ(at[CAPLET_LINK_Y + i], 2);
        EXPECT_EQ(at[CAPLET_LINK_Z + i], 3);
        EXPECT_EQ(at[CAPLET_LINK_R + i], 1 + x);
        if (chain) {
          EXPECT_EQ(at[CAPLET_LINK_U + i], 10 * x);
        }
      }
    }
    EXPECT_THAT(seen, testing::Each(true));
  }
}

TEST(Links, AreOfRunsAlone) {
  const auto kinds = [](const CapsulesShape& capsules, const Linking& linking) {
    Scene scene;
    scene.materials.resize(1);
    scene.shapes.push_back(shape_of(capsules));
    return lower(scene, linking).shapes;
  };
  const CapsulesShape chain = straight(8, true);
  EXPECT_EQ(kinds(chain, {0, 8}), linked_bit);
  EXPECT_EQ(kinds(chain, {0, 9}), shape_bit(shape_tapered_capsule));
  EXPECT_EQ(kinds(chain, {8, 4}), linked_bit);
  EXPECT_EQ(kinds(chain, {9, 4}), shape_bit(shape_tapered_capsule));
  CapsulesShape broken = chain;
  broken.p0[4].y = 2.5f;
  EXPECT_EQ(kinds(broken, {0, 5}), shape_bit(shape_tapered_capsule));
  EXPECT_EQ(kinds(broken, {0, 4}), linked_bit);
  broken = chain;
  broken.radius0[4] = 7;
  EXPECT_EQ(kinds(broken, {0, 5}), shape_bit(shape_tapered_capsule));
  broken = chain;
  broken.u[4].x = 41;
  EXPECT_EQ(kinds(broken, {0, 5}), shape_bit(shape_tapered_capsule));
  // Lights are sampled one by one.
  Scene scene;
  scene.materials.resize(1);
  scene.shapes.push_back(shape_of(chain));
  scene.shapes[0].emission.emplace();
  EXPECT_EQ(lower(scene, all_links).shapes, shape_bit(shape_tapered_capsule));
}

TEST(Links, AreOfLargeScenesByDefault) {
  Scene scene;
  scene.materials.resize(1);
  scene.shapes.push_back(shape_of(straight(65535, false)));
  EXPECT_EQ(lower(scene).shapes, shape_bit(shape_tapered_capsule));
  scene.shapes.push_back(shape_of(straight(1, false)));
  EXPECT_EQ(lower(scene).shapes, linked_bit | shape_bit(shape_tapered_capsule));
  // The first edit would have to unlink them.
  EXPECT_EQ(LiveScene(scene).flat().shapes, shape_bit(shape_tapered_capsule));
}

TEST(Links, EditsAreThoseOfTheSameCapsulesUnlinked) {
  const Scene scene = walking_scene();
  const auto expect_same = [](const LiveScene& live) {
    EXPECT_EQ(live.flat().shapes & linked_bit, 0u);
    expect_same_hits(live.flat(), lower(live.scene(), Linking::none()));
  };
  const CapsuleEdit one{{std::nullopt, 1}, 5, {vec3(0, 0, -1), vec3(0, 0, 1), 0.3f, 0.2f}};
  {
    LiveScene live(scene, all_links);
    EXPECT_NE(live.flat().shapes & linked_bit, 0u);
    EXPECT_EQ(live.lowerings(), 1u);
    live.edit(one);
    EXPECT_EQ(live.lowerings(), 2u);
    CapsuleEdit other = one;
    other.capsule = 8;
    other.to.p1.x = 1;
    live.edit(other);
    EXPECT_EQ(live.lowerings(), 2u);  // none are linked any more
    expect_same(live);
  }
  {
    // Where none is linked, a capsule moves in its place.
    LiveScene live(scene, {0, 100});
    const auto& walk = std::get<CapsulesShape>(scene.shapes[1].geometry);
    CapsuleEdit moved = one;
    moved.to = {walk.p0[5], walk.p1[5] + vec3(0.1f), walk.radius0[5], walk.radius1[5]};
    live.edit(moved);
    EXPECT_EQ(live.lowerings(), 1u);
    expect_same(live);
  }
  LiveScene live(scene, all_links);
  live.edit(TransformEdit{{std::nullopt, 0}, glm::translate(dmat4(1), dvec3(0.2, 0.1, 0))});
  expect_same(live);
}

TEST(LooseCapsules, AreThoseThatEditsKeepAsPrimitives) {
  Scene scene = walking_scene();
  // Others stand between them, some of which emit.
  scene.shapes.insert(scene.shapes.begin() + 1, shape_of(straight(3, true)));
  scene.shapes[1].emission.emplace();
  Shape ball;
  ball.geometry = SphereShape{0.5};
  scene.shapes.insert(scene.shapes.begin() + 3, ball);
  const Linking none_linked{scene.shapes.size() * 1000000};
  const FlatScene loose = lower(scene, none_linked), kept = lower(scene, Linking::none());
  EXPECT_EQ(loose.shapes, kept.shapes);
  EXPECT_EQ(kept.lights.size(), 3u);
  EXPECT_EQ(loose.lights.size(), 3u);
  EXPECT_EQ(loose.primitive_count, kept.primitive_count);
  expect_same_hits(loose, kept);
}

TEST(LooseCapsules, OfSeveralShapesAreAllCounted) {
  Scene scene;
  scene.materials.resize(1);
  CapsulesShape ball = straight(1, false);
  ball.p1 = ball.p0;
  scene.shapes = {shape_of(straight(3, false)), shape_of(ball)};
  EXPECT_EQ(lower(scene).shapes, shape_bit(shape_tapered_capsule) | shape_bit(shape_sphere));
}

/// Compares what the trees and their geometries take.
void expect_same_trees(const FlatScene& a, const FlatScene& b) {
  // References and ids may be the bits of a NaN.
  const auto same = [](const std::vector<float>& x, const std::vector<float>& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0;
  };
  EXPECT_TRUE(same(a.nodes, b.nodes));
  EXPECT_TRUE(same(a.leaves, b.leaves));
  EXPECT_EQ(a.primitive_geometry, b.primitive_geometry);
  EXPECT_EQ(a.primitive_count, b.primitive_count);
  EXPECT_EQ(a.world.root, b.world.root);
  EXPECT_EQ(a.bvh_sah, b.bvh_sah);
}

TEST(LowerAndRelease, GivesTheSameTreesAndLeavesLinkedShapesEmpty) {
  const Scene scene = walking_scene();
  Scene spent = scene;
  const FlatScene flat = lower_and_release(spent, {0, 6});
  expect_same_trees(flat, lower(scene, {0, 6}));
  for (const Shape& shape : spent.shapes)
    EXPECT_EQ(count_of(std::get<CapsulesShape>(shape.geometry)), 0u);
  EXPECT_EQ(count_of(std::get<CapsulesShape>(spent.objects[0].shapes[0].geometry)), 0u);
  // Shapes that are not linked keep their capsules.
  spent = scene;
  expect_same_trees(lower_and_release(spent), lower(scene));
  EXPECT_EQ(count_of(std::get<CapsulesShape>(spent.shapes[0].geometry)),
            count_of(std::get<CapsulesShape>(scene.shapes[0].geometry)));
}

TEST(LowerAndRelease, GivesBackOnlyWhatIsWritten) {
  // Memory is given back after each 65,536 blocks: here within a shape, and between two of them.
  Random random(5);
  Scene scene;
  scene.materials.resize(2);
  for (const bool chain : {false, true, true})
    scene.shapes.push_back(shape_of(walks(random, 30000, chain)));
  Scene spent = scene;
  FlatScene flat = lower_and_release(spent, all_links);
  EXPECT_LT(std::size_t{3} * 65536 * 48, flat.leaves.size());
  const FlatScene kept = lower(scene, all_links);
  expect_same_trees(flat, kept);
  // They are sent in parts of 2^21 floats.
  DeviceScene own(test_device(), std::move(flat));
  Query found_by(own), expected_by(kept, test_device());
  const std::vector<RayRecord> rays = random_rays(8000);
  const std::vector<PickRecord> found = found_by.closest(rays),
                                expected = expected_by.closest(rays);
  for (std::size_t i = 0; i < rays.size(); ++i)
    ASSERT_TRUE(same_bits(found[i], expected[i])) << "ray " << i;
}

TEST(LowerAndRelease, KeepsCapsulesThatMediaAreOrderedBy) {
  Scene scene = walking_scene();
  scene.materials[1].model = InterfaceMaterial{};
  Scene spent = scene;
  expect_same_trees(lower_and_release(spent, all_links), lower(scene, all_links));
  for (std::size_t i = 0; i < scene.shapes.size(); ++i)
    EXPECT_EQ(std::get<CapsulesShape>(spent.shapes[i].geometry).p0,
              std::get<CapsulesShape>(scene.shapes[i].geometry).p0);
}

TEST(GeometryPages, TellTheGeometryOfEachPrimitive) {
  // Pages of 64: one geometry, two, another one, and the rest.
  std::vector<std::uint32_t> geometries(64, 7);
  geometries.insert(geometries.end(), 63, 8);
  geometries.push_back(9);
  geometries.insert(geometries.end(), 64, 5);
  geometries.insert(geometries.end(), {5, 6});
  const std::vector<std::uint32_t> pages = geometry_pages(geometries);
  ASSERT_EQ(pages.size(), 4u + 64 + 2);
  EXPECT_THAT(std::vector(pages.begin(), pages.begin() + 4),
              testing::ElementsAre(14, 2 * 4 + 1, 10, 2 * 68 + 1));
  for (std::uint32_t i = 0; i < geometries.size(); ++i)
    EXPECT_EQ(geometry_of(pages, i), geometries[i]) << i;
  EXPECT_TRUE(geometry_pages({}).empty());
}

}  // namespace
}  // namespace caplet::test
