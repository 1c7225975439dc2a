// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Queries against the reference: which crossing, where, of what; batches, capacities and camera
// rays.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "import/import.h"
#include "lower/camera.h"
#include "lower/identity.h"
#include "lower/lower.h"
#include "lower/worlds.h"
#include "reference/scene_reference.h"
#include "render/query.h"
#include "render/world_query.h"
#include "render_scene.h"
#include "support/data.h"
#include "support/rays.h"

namespace caplet {
namespace {

using glm::dvec3;

dvec3 origin_of(const RayRecord& ray) { return {ray.ox, ray.oy, ray.oz}; }
dvec3 direction_of(const RayRecord& ray) { return {ray.dx, ray.dy, ray.dz}; }
dvec3 to_dvec3(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

Scene scene_file(const std::string& name) {
  return import_scene(test::source_folder() / name, FileImageReader());
}

/// Origins around the scene and within it, directions towards its middle half and of lengths from
/// 1/8 to 8.
std::vector<RayRecord> random_rays(const Scene& scene, std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const Bounds bounds = bounds_of(scene);
  const dvec3 center = (bounds.min + bounds.max) * 0.5;
  const double radius = std::min(20.0, glm::length(bounds.max - bounds.min) *
                                           0.5);  // a ground disk is no scale for what stands on it
  const auto in_cube = [&] { return dvec3(unit(random), unit(random), unit(random)); };
  std::vector<RayRecord> out;
  for (std::size_t i = 0; i < count; ++i) {
    const dvec3 o = center + in_cube() * radius * (i % 2 == 0 ? 2.0 : 0.2);
    out.push_back(
        test::make_ray(o, (center + in_cube() * radius * 0.2 - o) * std::exp2(3 * unit(random))));
  }
  return out;
}

std::vector<RayRecord> pixel_rays(const Scene& scene, std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<RayRecord> out;
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<int>(random() % static_cast<std::uint64_t>(scene.view.film.width));
    const auto y = static_cast<int>(random() % static_cast<std::uint64_t>(scene.view.film.height));
    out.push_back(ray_of_pixel(scene, x, y));
  }
  return out;
}

struct Tally {
  int hits = 0, grazing = 0;
};

/// Without an inside. Cylinders and cones with open ends have one.
bool is_sheet(const Shape& shape) {
  return !is_closed(shape) && !std::holds_alternative<CylinderShape>(shape.geometry) &&
         !std::holds_alternative<ConeShape>(shape.geometry);
}

/// Both are crossings of the same surface of the same primitive, from the same side.
bool is_on(const Scene& scene, const PickRecord& pick, const reference::SceneHit& hit) {
  const bool placed = hit.instance != reference::no_instance;
  const Identity identity = identity_of(scene, pick);
  const Shape& shape =
      placed ? scene.objects[hit.object].shapes[hit.shape] : scene.shapes[hit.shape];
  // The reference knows the normal of an open shape as stored, without ReverseOrientation.
  const bool leaving = hit.leaving != (is_sheet(shape) && shape.reverse_orientation);
  return identity.shape == &shape &&
         identity.instance == (placed ? std::optional(hit.instance) : std::nullopt) &&
         pick.primitive == hit.primitive && pick.surface == hit.surface &&
         pick.material == hit.material && (pick.leaving != 0) == leaving;
}

/// How far device and reference may be apart along the surface's normal: `error` for the point and
/// as much for the parameter, which the same bound covers (docs/numerics.md), 16 eps of the
/// origin's distance, and the rounding of the shape's own numbers to floats, 8 eps of their size.
double bound_of(const RayRecord& ray, const PickRecord& pick) {
  constexpr double eps = 0x1p-24;
  const double scale = glm::length(origin_of(ray)) + glm::length(to_dvec3(pick.point)) +
                       pick.t * glm::length(direction_of(ray));
  return 2 * static_cast<double>(pick.error) + (16 + 8) * eps * scale;
}

double cosine_of(const RayRecord& ray, const PickRecord& pick) {
  return std::abs(glm::dot(to_dvec3(pick.normal), direction_of(ray))) /
         glm::length(direction_of(ray));
}

/// The same crossing on the device and by the reference, in the same place. A surface seen at an
/// angle stretches the bound by 1 / cos; within 3 degrees of grazing, where its curvature would
/// count too, only the identity is compared.
void expect_same(const Scene& scene, const RayRecord& ray, const PickRecord& pick,
                 const reference::SceneHit& hit, Tally& tally) {
  EXPECT_TRUE(is_on(scene, pick, hit));
  ++tally.hits;
  const dvec3 o = origin_of(ray), d = direction_of(ray), n = to_dvec3(pick.normal),
              p = to_dvec3(pick.point);
  EXPECT_NEAR(glm::length(n), 1, 1e-6);
  EXPECT_LE(glm::dot(n, d), 1e-6 * glm::length(d));
  const double cosine = cosine_of(ray, pick), bound = bound_of(ray, pick);
  if (cosine < 0.05) {
    ++tally.grazing;
    return;
  }
  EXPECT_LE(std::abs(pick.t - hit.t) * glm::length(d) * cosine, bound);
  EXPECT_LE(std::abs(glm::dot(n, p - (o + hit.t * d))), bound);
  EXPECT_LE(glm::length(p - (o + hit.t * d)) * cosine, bound);
}

/// The reference's crossing of the same surface nearest to the device's; the end when there is
/// none.
std::vector<reference::SceneHit>::iterator counterpart_of(const Scene& scene,
                                                          const PickRecord& pick,
                                                          std::vector<reference::SceneHit>& hits) {
  auto out = hits.end();
  for (auto hit = hits.begin(); hit != hits.end(); ++hit)
    if (is_on(scene, pick, *hit) &&
        (out == hits.end() || std::abs(hit->t - pick.t) < std::abs(out->t - pick.t)))
      out = hit;
  return out;
}

class QueryOfScene : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Files, QueryOfScene,
                         testing::Values("scenes/capsules.pbrt", "scenes/instances.pbrt",
                                         "scenes/gallery.pbrt", "tests/query/solids.pbrt",
                                         "tests/render/everything.pbrt"));

void expect_nearest(const Scene& scene, const reference::SceneReference& reference,
                    std::span<const RayRecord> rays, std::span<const PickRecord> picks,
                    Tally& tally) {
  ASSERT_EQ(picks.size(), rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    SCOPED_TRACE(i);
    const reference::Ray ray{origin_of(rays[i]), direction_of(rays[i])};
    const auto hit = reference.closest(ray);
    ASSERT_EQ(picks[i].object != CAPLET_NONE, hit.has_value());
    EXPECT_EQ(std::isfinite(picks[i].t), hit.has_value());
    if (!hit) continue;
    // Where surfaces lie on each other, either is the nearest.
    std::vector<reference::SceneHit> hits = reference.all(ray);
    const auto counterpart = counterpart_of(scene, picks[i], hits);
    ASSERT_NE(counterpart, hits.end());
    EXPECT_LE((counterpart->t - hit->t) * glm::length(ray.direction) * cosine_of(rays[i], picks[i]),
              bound_of(rays[i], picks[i]));
    expect_same(scene, rays[i], picks[i], *counterpart, tally);
  }
}

TEST_P(QueryOfScene, NearestCrossingsAreTheReferences) {
  const Scene scene = scene_file(GetParam());
  const reference::SceneReference reference(scene);
  const FlatScene flat = lower(scene);
  std::vector<RayRecord> rays = pixel_rays(scene, 200, 1);
  const auto more = random_rays(scene, 1000, 2);
  rays.insert(rays.end(), more.begin(), more.end());
  for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
    Query query(flat, test::test_device(encoding));
    Tally tally;
    expect_nearest(scene, reference, rays, query.closest(rays), tally);
    EXPECT_GT(tally.hits, 300);
    EXPECT_LT(tally.grazing, tally.hits / 10);
  }
}

/// Returns the crossing as a query of `scene` itself reports it.
PickRecord as_of(const Scene& scene, const Worlds& worlds, PickRecord pick) {
  if (pick.object == CAPLET_NONE) return pick;
  const WorldsIdentity identity = worlds.identity_of(pick);
  const auto in_world = static_cast<std::uint32_t>(scene.shapes.size());
  pick.object = pick.shape = identity.shape;
  pick.primitive = identity.primitive;
  if (identity.instance == CAPLET_NONE) return pick;
  pick.object = in_world + identity.instance;
  for (std::size_t k = 0; k < scene.instances[identity.instance].object; ++k)
    pick.shape -= static_cast<std::uint32_t>(scene.objects[k].shapes.size());
  return pick;
}

TEST_P(QueryOfScene, ManyWorldsAreTheReferences) {
  constexpr std::size_t count = 5, rays_each = 300;
  const Scene scene = scene_file(GetParam());
  std::vector<std::uint32_t> moving;
  for (std::uint32_t i = 0; i < scene.shapes.size(); i += 2) moving.push_back(i);
  std::ranges::reverse(moving);
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Scene> poses(count, scene);
  std::vector<glm::dmat4> transforms;
  std::vector<RayRecord> rays;
  for (std::size_t w = 0; w < count; ++w) {
    for (const std::uint32_t i : moving) {
      glm::dmat4& m = poses[w].shapes[i].world_from_object;
      if (w > 0) {  // the first world is the scene's own
        const dvec3 axis = glm::normalize(dvec3(unit(random), unit(random), unit(random)));
        m = glm::translate(glm::dmat4(1), dvec3(unit(random), unit(random), unit(random))) * m *
            glm::rotate(glm::dmat4(1), 3 * unit(random), axis);
        if (w == 3) m = m * glm::scale(glm::dmat4(1), dvec3(1.2, 0.8, 1));
      }
      transforms.push_back(m);
    }
    const auto own = random_rays(poses[w], rays_each, static_cast<unsigned>(7 + w));
    rays.insert(rays.end(), own.begin(), own.end());
  }
  // A launch of one world's rays or less; of two worlds; of all.
  for (const std::size_t batch_rays : {std::size_t{70}, 2 * rays_each, std::size_t{0}})
    for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
      WorldQuery query(Worlds(scene, moving), test::test_device(encoding), batch_rays);
      // Others before them, of another number, leave nothing behind.
      query.place(2, std::span(transforms).last(2 * moving.size()));
      query.place(count, transforms);
      std::vector<PickRecord> picks(rays.size()), identities(rays.size());
      query.closest(rays, true, picks);
      query.closest(rays, false, identities);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        PickRecord bare = picks[i];
        bare.u = bare.v = bare.error = 0;
        std::ranges::fill(bare.point, 0.0F);
        std::ranges::fill(bare.normal, 0.0F);
        EXPECT_EQ(0, std::memcmp(&bare, &identities[i], sizeof(PickRecord))) << i;
      }
      Tally tally;
      for (std::size_t w = 0; w < count; ++w) {
        SCOPED_TRACE(testing::Message() << "world " << w << ", launches of " << batch_rays);
        std::vector<PickRecord> own;
        for (std::size_t i = 0; i < rays_each; ++i)
          own.push_back(as_of(poses[w], query.worlds(), picks[w * rays_each + i]));
        expect_nearest(poses[w], reference::SceneReference(poses[w]),
                       std::span(rays).subspan(w * rays_each, rays_each), own, tally);
      }
      EXPECT_GT(tally.hits, 300);
      EXPECT_LT(tally.grazing, tally.hits / 10);
    }
}

/// Capsules of one radius, tapered ones and balls, of two materials, on a ground; the second shape
/// of capsules rests where it is placed, and a brick moves.
const std::string limbs =
    "WorldBegin\nShape \"box\" \"point3 p0\" [-5 -5 -2] \"point3 p1\" [5 5 -1.5]\n"
    "Shape \"capsules\" \"point3 p0\" [0 0 0 1 0 0 2 0 0] \"point3 p1\" [1 0 0 2 0 0 2 0 0]\n"
    "  \"float radius\" [0.3 0.2 0.4] \"float radius1\" [0.3 0.1 0.4]\n"
    "Shape \"box\" \"point3 p0\" [-0.5 -0.4 -0.3] \"point3 p1\" [0.5 0.4 0.3]\n"
    "Material \"conductor\"\nTranslate 0 1 0\nRotate 90 0 0 1\nScale 0.5 0.5 0.5\n"
    "Shape \"capsule\" \"point3 p0\" [0 0 0] \"point3 p1\" [1 0 1] \"float radius\" 0.2\n";

/// Returns a random capsule: with one radius, two, or as a ball.
Capsule random_capsule(std::mt19937_64& random) {
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto point = [&] { return glm::vec3(unit(random), unit(random), unit(random)) * 1.5F; };
  Capsule out{point(), point(), 0.1F + 0.2F * std::abs(unit(random)), 0};
  out.radius1 = out.radius0;
  if (random() % 3 == 0) out.p1 = out.p0;
  if (random() % 2 == 0) out.radius1 *= 0.5F;
  return out;
}

void set_capsules(Shape& shape, std::span<const Capsule> to) {
  auto& capsules = std::get<CapsulesShape>(shape.geometry);
  capsules.radius1 = capsules.radius0;
  for (std::size_t i = 0; i < to.size(); ++i) {
    capsules.p0[i] = to[i].p0;
    capsules.p1[i] = to[i].p1;
    capsules.radius0[i] = to[i].radius0;
    capsules.radius1[i] = to[i].radius1;
  }
}

TEST(Worlds, CapsulesHaveOtherEndsInEachAsTheReferenceHas) {
  constexpr std::size_t count = 12, rays_each = 400;
  Scene scene = test::scene_of_text(limbs);
  ASSERT_GE(scene.materials.size(), 2u);
  std::get<CapsulesShape>(scene.shapes[1].geometry).materials = {1, 0, 1};
  const std::vector<std::uint32_t> moving = {2, 1}, deforming = {3, 1};
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Scene> poses(count, scene);
  std::vector<glm::dmat4> transforms;
  std::vector<Capsule> ends;
  std::vector<RayRecord> rays;
  for (std::size_t w = 0; w < count; ++w) {
    for (const std::uint32_t i : moving) {
      glm::dmat4& m = poses[w].shapes[i].world_from_object;
      const dvec3 axis = glm::normalize(dvec3(unit(random), unit(random), unit(random)));
      if (w > 1)  // two worlds are where the scene is
        m = glm::translate(glm::dmat4(1), dvec3(unit(random), unit(random), unit(random))) *
            glm::rotate(glm::scale(glm::dmat4(1), dvec3(0.7)), 3 * unit(random), axis);
      transforms.push_back(m);
    }
    for (int i = 0; i < 4; ++i) ends.push_back(random_capsule(random));
    set_capsules(poses[w].shapes[3], std::span(ends).subspan(4 * w, 1));
    set_capsules(poses[w].shapes[1], std::span(ends).subspan(4 * w + 1, 3));
    const auto own = random_rays(poses[w], rays_each, static_cast<unsigned>(20 + w));
    rays.insert(rays.end(), own.begin(), own.end());
  }
  std::vector<std::size_t> hits_of(4);
  for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
    WorldQuery query(Worlds(scene, moving, deforming), test::test_device(encoding),
                     3 * rays_each / 2);
    EXPECT_EQ(query.worlds().ends(), 4u);
    query.place(count, transforms, ends);
    std::vector<PickRecord> picks(rays.size());
    query.closest(rays, true, picks);
    Tally tally;
    for (std::size_t w = 0; w < count; ++w) {
      SCOPED_TRACE(testing::Message() << "world " << w);
      std::vector<PickRecord> own;
      for (std::size_t i = 0; i < rays_each; ++i)
        own.push_back(as_of(poses[w], query.worlds(), picks[w * rays_each + i]));
      const auto rays_of_it = std::span(rays).subspan(w * rays_each, rays_each);
      expect_nearest(poses[w], reference::SceneReference(poses[w]), rays_of_it, own, tally);
      // Capsules are stored in the world as they are, so that they are hit to the bit as in a
      // scene of that world alone.
      Query alone(lower(poses[w]), test::test_device(encoding));
      std::vector<PickRecord> expected = alone.closest(rays_of_it);
      for (std::size_t i = 0; i < rays_each; ++i) {
        if (expected[i].object != 1 && expected[i].object != 3) continue;
        expected[i].u = own[i].u;  // worlds do not know how a shape was turned, and tell none
        expected[i].v = own[i].v;
        EXPECT_EQ(0, std::memcmp(&own[i], &expected[i], sizeof(PickRecord))) << i;
        ++hits_of[expected[i].object];
      }
    }
    EXPECT_GT(tally.hits, 1500);
  }
  EXPECT_GT(hits_of[1], 300u);
  EXPECT_GT(hits_of[3], 40u);
}

// Of 9 worlds with 200 rays each, at most 2 are in a launch.
TEST(Worlds, LaunchesHaveTheirOwnEnds) {
  const Scene scene = test::scene_of_text(limbs);
  const std::vector<std::uint32_t> deforming = {1};
  std::mt19937_64 random(10);
  std::vector<Capsule> ends(27);
  std::ranges::generate(ends, [&] { return random_capsule(random); });
  std::vector<Vector3> directions(200);
  std::uniform_real_distribution<float> unit(-0.3F, 0.3F);
  std::ranges::generate(directions, [&] { return Vector3{unit(random), unit(random), -1}; });
  const std::vector<glm::dmat4> cameras(9, glm::translate(glm::dmat4(1), dvec3(0, 0, 6)));
  std::vector<float> whole(1800), parts(1800), one(200);
  const auto look = [&](std::size_t batch_rays, std::span<const Capsule> of, std::span<float> t) {
    WorldQuery query(Worlds(scene, {}, deforming), test::test_device(), batch_rays);
    const std::size_t worlds = of.size() / 3;
    WorldHits out;
    out.t = t;
    query.look(worlds, {}, of, std::span(cameras).first(worlds), directions, out);
  };
  look(0, ends, whole);
  look(450, ends, parts);
  EXPECT_EQ(whole, parts);
  look(0, std::span(ends).last(3), one);
  EXPECT_TRUE(std::ranges::equal(one, std::span(whole).last(200)));
  EXPECT_FALSE(std::ranges::equal(one, std::span(whole).first(200)));
}

TEST(Worlds, RefuseEndsThatAreNone) {
  const Scene scene = test::scene_of_text(limbs);
  const std::vector<std::uint32_t> moving = {1}, deforming = {1, 3};
  Worlds worlds(scene, moving, deforming);
  std::vector<glm::dmat4> transforms(2, glm::dmat4(1));
  const Capsule good{{0, 0, 0}, {1, 0, 0}, 0.5F, 0};
  std::vector<Capsule> ends(8, good);
  const auto message = [&]() -> std::string {
    try {
      worlds.place(2, transforms, ends, 50);
    } catch (const InputError& error) {
      EXPECT_TRUE(worlds.roots().empty());
      return error.what();
    }
    return "placed";
  };
  EXPECT_EQ(message(), "placed");
  const std::string said = "world 51: capsule 0 of shape 3 is not finite or has a negative radius";
  for (const Capsule& wrong :
       {Capsule{{0, NAN, 0}, {}, 1, 1}, Capsule{{}, {0, 0, INFINITY}, 1, 1}, Capsule{{}, {}, -1, 1},
        Capsule{{}, {}, 1, -1}, Capsule{{}, {}, NAN, 1}}) {
    ends[7] = wrong;
    EXPECT_EQ(message(), said);
  }
  ends[7] = good;
  transforms[1] = glm::scale(glm::dmat4(1), dvec3(1, 2, 1));
  EXPECT_EQ(message(),
            "world 51: the transform of shape 1, whose ends change, is not a similarity (of one "
            "scale in all directions)");
  const auto refused = [&](const std::string& text, std::uint32_t shape) -> std::string {
    try {
      Worlds(test::scene_of_text(text), {}, std::vector{shape});
    } catch (const InputError& error) {
      return error.what();
    }
    return "made";
  };
  EXPECT_THAT(refused(limbs, 2), testing::HasSubstr("shape 2 has no capsules whose ends"));
  const std::string one_sided =
      "WorldBegin\nShape \"capsule\" \"bool onesided\" true \"point3 p0\" [0 0 0] "
      "\"point3 p1\" [1 0 0] \"float radius\" 0.2\n";
  EXPECT_THAT(refused(one_sided, 0), testing::HasSubstr("shape 0 shows one side alone"));
}

TEST(Worlds, RefuseWhatHasNoPlace) {
  const Scene scene = scene_file("scenes/capsules.pbrt");
  const std::vector<std::uint32_t> moving = {0, 1};
  Worlds worlds(scene, moving);
  std::vector<glm::dmat4> transforms(6, glm::dmat4(1));
  worlds.place(3, transforms);
  EXPECT_EQ(worlds.roots().size(), 3u);
  const auto message = [&](const glm::dmat4& wrong) -> std::string {
    transforms[3] = wrong;
    try {
      worlds.place(3, transforms, {}, 100);
    } catch (const InputError& error) {
      EXPECT_TRUE(worlds.roots().empty());
      return error.what();
    }
    return "placed";
  };
  const std::string said =
      "world 101: the transform of moving shape 1 is not affine, not finite, or singular (it "
      "flattens the shape)";
  EXPECT_EQ(message(glm::scale(glm::dmat4(1), dvec3(1, 0, 1))), said);
  for (const double far : {double{NAN}, double{INFINITY}}) {
    glm::dmat4 nowhere(1);
    nowhere[3][1] = far;
    EXPECT_EQ(message(nowhere), said);
  }
  glm::dmat4 perspective(1);
  perspective[2][3] = 0.5;
  EXPECT_EQ(message(perspective), said);
  EXPECT_EQ(message(glm::dmat4(1)), "placed");
  EXPECT_THROW(Worlds(scene_file("scenes/motion.pbrt"), moving), InputError);
}

TEST_P(QueryOfScene, ListsAreTheReferences) {
  const Scene scene = scene_file(GetParam());
  const reference::SceneReference reference(scene);
  const FlatScene flat = lower(scene);
  const std::vector<RayRecord> rays = random_rays(scene, 500, 3);
  for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
    Query query(flat, test::test_device(encoding));
    const HitLists lists = query.all(rays, 64);
    ASSERT_EQ(lists.begin.size(), rays.size() + 1);
    EXPECT_EQ(lists.begin.back(), lists.crossings.size());
    EXPECT_TRUE(lists.overflowed.empty());
    Tally tally;
    std::size_t longest = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      SCOPED_TRACE(i);
      std::vector<reference::SceneHit> expected =
          reference.all({origin_of(rays[i]), direction_of(rays[i])});
      const auto begin = lists.begin[i], end = lists.begin[i + 1];
      longest = std::max(longest, end - begin);
      ASSERT_EQ(end - begin, expected.size());
      for (std::size_t k = begin; k < end; ++k) {
        const PickRecord& pick = lists.crossings[k];
        EXPECT_LE(k > begin ? lists.crossings[k - 1].t : 0, pick.t);
        // Where surfaces lie on each other the order is the device's own: each crossing has its own
        // counterpart.
        const auto counterpart = counterpart_of(scene, pick, expected);
        ASSERT_NE(counterpart, expected.end())
            << "the reference has no such crossing near " << pick.t;
        expect_same(scene, rays[i], pick, *counterpart, tally);
        expected.erase(counterpart);
      }
    }
    EXPECT_GE(longest, 4u);
  }
}

TEST_P(QueryOfScene, BatchesDoNotMatter) {
  const FlatScene flat = lower(scene_file(GetParam()));
  const auto rays = random_rays(scene_file(GetParam()), 700, 4);
  const auto same = [](const std::vector<PickRecord>& a, const std::vector<PickRecord>& b) {
    return a.size() == b.size() &&
           std::memcmp(a.data(), b.data(), a.size() * sizeof(PickRecord)) == 0;
  };
  Query whole(flat, test::test_device()),
      pieces(flat, test::test_device(), {.batch_rays = 48, .batch_hits = 1000});
  EXPECT_TRUE(same(whole.closest(rays), pieces.closest(rays)));
  const HitLists all = whole.all(rays, 64);
  for (const std::size_t capacity : {64u, 100u, 2000u}) {  // 15, 10 rays and 1 ray a launch
    const HitLists lists = pieces.all(rays, capacity);
    EXPECT_TRUE(same(all.crossings, lists.crossings)) << capacity;
    EXPECT_EQ(all.begin, lists.begin) << capacity;
  }
  EXPECT_TRUE(whole.closest({}).empty());
  EXPECT_TRUE(whole.all({}, 5).crossings.empty());
}

TEST_P(QueryOfScene, OverflowIsReportedAndTheNearestAreKept) {
  const FlatScene flat = lower(scene_file(GetParam()));
  const auto rays = random_rays(scene_file(GetParam()), 700, 5);
  Query query(flat, test::test_device());
  const HitLists all = query.all(rays, 64);
  for (const std::size_t capacity : {1u, 2u, 3u}) {
    const HitLists lists = query.all(rays, capacity);
    std::vector<std::size_t> overflowed;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::size_t count = all.begin[i + 1] - all.begin[i];
      if (count > capacity) overflowed.push_back(i);
      ASSERT_EQ(lists.begin[i + 1] - lists.begin[i], std::min(count, capacity));
      EXPECT_EQ(0, std::memcmp(&lists.crossings[lists.begin[i]], &all.crossings[all.begin[i]],
                               std::min(count, capacity) * sizeof(PickRecord)));
    }
    EXPECT_EQ(lists.overflowed, overflowed);
    EXPECT_FALSE(overflowed.empty());
  }
  const HitLists first = query.all(rays, 1);
  const std::vector<PickRecord> nearest = query.closest(rays);
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (nearest[i].object != CAPLET_NONE) {
      EXPECT_EQ(0, std::memcmp(&first.crossings[first.begin[i]], &nearest[i], sizeof(PickRecord)));
    }
}

TEST(Query, RaysThatAreNoneMiss) {
  const FlatScene flat = lower(scene_file("scenes/capsules.pbrt"));
  const float inf = INFINITY, nan = NAN;
  const std::vector<RayRecord> rays = {{0, 0, 5, 0, 0, 0, 0, inf},    {nan, 0, 5, 0, 0, 0, -1, inf},
                                       {0, 0, 5, 0, 0, nan, -1, inf}, {0, 0, inf, 0, 0, 0, -1, inf},
                                       {0, 0, 5, 0, 0, 0, -inf, inf}, {0, 0, 5, 7, 0, 0, -1, 6}};
  Query query(flat, test::test_device());
  for (const PickRecord& pick : query.closest(rays)) EXPECT_EQ(pick.object, CAPLET_NONE);
  const HitLists lists = query.all(rays, 4);
  EXPECT_TRUE(lists.crossings.empty());
  EXPECT_TRUE(lists.overflowed.empty());
}

/// A difference of balls beside a disk: names, surfaces and materials.
Scene scene_of_csg() {
  Scene scene;
  for (const char* name : {"grey", "red", "blue", ""}) {
    Material material;
    material.name = name;
    material.model = DiffuseMaterial{};
    scene.materials.push_back(material);
  }
  CsgShape csg;
  csg.operation = CsgShape::Operation::set_difference;
  for (const double z : {0.0, 1.0}) {
    Shape ball;
    ball.geometry = SphereShape{1};
    ball.world_from_object[3] = glm::dvec4(0, 0, z, 1);
    ball.material = z == 0 ? 1 : 2;
    csg.operands.push_back(std::make_shared<const Shape>(ball));
  }
  Shape bowl;
  bowl.geometry = csg;
  bowl.name = "bowl";
  bowl.material = 1;
  Shape floor;
  floor.geometry = DiskShape{-2, 5};
  floor.material = 3;
  floor.reverse_orientation = true;
  scene.shapes = {floor, bowl};
  return scene;
}

TEST(Query, CsgReportsItsOwnNameAndTheOperandsSurface) {
  const Scene scene = scene_of_csg();
  Query query(lower(scene), test::test_device());
  const RayRecord down = test::make_ray({0.1, 0, 5}, {0, 0, -2});
  const HitLists lists = query.all(std::span(&down, 1), 8);
  ASSERT_EQ(lists.crossings.size(), 3u);
  // The hollow is the second ball's lower half, seen from within; the first ball's lower half is
  // left; then the floor, whose normal is turned down and which is therefore met from behind.
  const double side = std::sqrt(1 - 0.01);
  const double z[] = {1 - side, -side, -2};
  const char* names[] = {"bowl", "bowl", "0"};
  const char* materials[] = {"blue", "red", "3"};
  const unsigned surfaces[] = {1, 0, 0}, leaving[] = {0, 1, 1}, objects[] = {1, 1, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    SCOPED_TRACE(i);
    const PickRecord& pick = lists.crossings[i];
    const Identity identity = identity_of(scene, pick);
    EXPECT_EQ(object_label(scene, identity), names[i]);
    EXPECT_EQ(object_number(scene, identity), objects[i]);
    EXPECT_EQ(pick.object, objects[i]);
    EXPECT_FALSE(identity.instance);
    EXPECT_EQ(pick.surface, surfaces[i]);
    EXPECT_EQ(material_label(scene, pick.material), materials[i]);
    EXPECT_EQ(pick.leaving, leaving[i]);
    // 16 eps of the origin's distance, twice over.
    EXPECT_NEAR(pick.t, (5 - z[i]) / 2, 32 * 0x1p-24 * 5);
    EXPECT_NEAR(pick.point[2], z[i], 32 * 0x1p-24 * 5);
    EXPECT_GT(pick.normal[2], 0);  // against the ray
  }
}

TEST(RayOfPixel, IsTheDevicesCameraRay) {
  for (const char* name : {"scenes/capsules.pbrt", "tests/render/everything.pbrt"}) {
    Scene scene = scene_file(name);
    scene.view.film.width = 320;
    scene.view.film.height = 180;
    scene.view.film.crop = {8, 24, 5, 20};
    const FlatView flat = lower_view(scene);
    const std::string source = flatten_kernels(R"(
#include "camera/camera.cl"
__kernel void rays(__global const CameraRecord* camera, uint width, uint count, __global RayRecord* out) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  float weight;
  out[i] = camera_ray(camera, 0, (float2)((float)(i % width) + 0.5f, (float)(i / width) + 0.5f), (float2)(0.5f, 0.5f), &weight);
}
)");
    const Device& device = test::test_device();
    Program program = Program::from_source(device, "camera_test", source, "");
    cl::Kernel kernel = program.kernel("rays");
    const std::size_t count = std::size_t{flat.view.width} * flat.view.height;
    const Buffer<CameraRecord> camera(device, std::span(&flat.camera, 1));
    const Buffer<RayRecord> out(device, count);
    set_arguments(device, kernel, camera, cl_uint{flat.view.width}, static_cast<cl_uint>(count),
                  out);
    launch(device, kernel, count, 64);
    const std::vector<RayRecord> rays = out.read();
    for (std::size_t i = 0; i < count; i += 7) {
      const auto width = static_cast<std::size_t>(scene.view.film.width);
      const RayRecord ours =
          ray_of_pixel(scene, static_cast<int>(i % width), static_cast<int>(i / width));
      EXPECT_EQ(origin_of(ours), origin_of(rays[i]));
      // The image plane within 2 roundings of numbers below 2, turned by 3 products and 2 sums of
      // numbers below 2, normalised by a length of 5 roundings and a division of 5: fewer than 32
      // eps of a unit vector.
      EXPECT_LE(glm::length(direction_of(ours) - direction_of(rays[i])), 32 * 0x1p-24) << i;
    }
  }
}

TEST(RayOfPixel, HitsWhatTheRenderShowsThere) {
  // A filter of a thousandth of a pixel: every sample is the middle of its pixel.
  const auto through_the_middle = [](Scene& scene) {
    scene.view.filter = {.kind = PixelFilter::Kind::box, .radius_x = 0.0005, .radius_y = 0.0005};
    scene.view.camera.lens_radius = 0;
    scene.view.film.width = 96;
    scene.view.film.height = 54;
  };
  for (const char* name : {"scenes/capsules.pbrt", "scenes/instances.pbrt"}) {
    Scene scene = scene_file(name);
    through_the_middle(scene);
    const test::Rendered rendered = test::render_model(scene, 1);
    Query query(lower(scene), test::test_device());
    std::vector<RayRecord> rays;
    for (int y = 0; y < scene.view.film.height; ++y)
      for (int x = 0; x < scene.view.film.width; ++x) rays.push_back(ray_of_pixel(scene, x, y));
    const std::vector<PickRecord> picks = query.closest(rays);
    const auto& objects = test::channel(rendered.image, "object.id").uints;
    const auto& primitives = test::channel(rendered.image, "primitive.id").uints;
    // Half a thousandth of a pixel off may cross an outline: fewer than one pixel in a thousand.
    std::size_t different = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
      different += picks[i].object != objects[i] ||
                   (objects[i] != CAPLET_NONE && picks[i].primitive != primitives[i]);
    EXPECT_LE(different, rays.size() / 1000) << name;
  }
}

}  // namespace
}  // namespace caplet
