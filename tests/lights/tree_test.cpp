// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The light tree: that its chances add to one and are what it does, that no light that can be seen
// is without one, and that they go by the light that comes. Expectations are closed forms.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

#include "light_bench.h"
#include "lower/light_tree.h"
#include "lower/lower.h"
#include "support/chi_square.h"

namespace caplet::test::tree_test {

namespace {

using glm::dvec3;

using std::numbers::pi;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double unit() { return static_cast<double>(engine_() >> 8) * 0x1p-24; }
  double in(double low, double high) { return low + (high - low) * unit(); }
  dvec3 in_box(double half) { return {in(-half, half), in(-half, half), in(-half, half)}; }
  dvec3 direction() {
    for (;;) {
      const dvec3 v = in_box(1);
      if (const double l = glm::length(v); l > 0.1 && l < 1) return v / l;
    }
  }
  std::vector<std::uint32_t> numbers(std::size_t n) {
    std::vector<std::uint32_t> out(n);
    for (std::uint32_t& x : out) x = static_cast<std::uint32_t>(engine_());
    return out;
  }

 private:
  std::mt19937 engine_;
};

Light point_light(const dvec3& at, double scale) {
  Light light;
  PointLight model;
  model.position = at;
  light.model = model;
  light.scale = scale;
  return light;
}

/// A floor far below, which nothing here asks for.
Scene ground() {
  Scene scene;
  scene.materials.emplace_back();
  Shape shape;
  shape.geometry = SphereShape{1};
  shape.world_from_object = glm::translate(glm::dmat4(1), dvec3(0, 0, -30));
  scene.shapes = {shape};
  return scene;
}

/// Points and spots in a box of +-5.
Scene lamps(std::size_t count, unsigned seed) {
  Random random(seed);
  Scene scene = ground();
  for (std::size_t i = 0; i < count; ++i) {
    scene.lights.push_back(point_light(random.in_box(5), std::exp(random.in(-4, 4))));
    if (i % 3 == 0) {
      SpotLight spot;
      spot.position = random.in_box(5);
      spot.direction = random.direction();
      spot.total_angle = random.in(0.2, 1.5);
      spot.falloff_start_angle = spot.total_angle * random.in(0.3, 1);
      scene.lights.back().model = spot;
    }
  }
  return scene;
}

Receiver random_receiver(Random& random, bool sided) {
  return {random.in_box(6), sided ? random.direction() : dvec3(0)};
}

/// How far above the horizon of the receiver a direction is, by its sine.
double above(const Receiver& at, const dvec3& direction) {
  return at.normal == dvec3(0) ? 1 : glm::dot(at.normal, direction);
}

}  // namespace

// Where only parts of a node's bounds can be seen, none of its lights may be: such a choice comes
// to nothing.
TEST(LightTree, ChancesAreWhatItDoes) {
  const Scene scene = lamps(300, 1);
  const FlatScene flat = lower(scene);
  ASSERT_GT(flat.light_nodes.size() / CAPLET_LIGHT_NODE, 30u);
  LightBench bench(flat);
  Random random(2);
  for (int i = 0; i < 12; ++i) {
    const Receiver at = random_receiver(random, i % 2 == 0);
    const std::vector<double> chances = bench.chances(at, 300);
    double sum = 0;
    for (const double chance : chances) sum += chance;
    EXPECT_LT(sum, 1 + 1e-5);
    constexpr std::size_t draws = 200000;
    std::vector<double> seen(301, 0), expected;
    for (const Choice& choice : bench.choose(at, random.numbers(draws))) {
      if (choice.light == CAPLET_NONE) {
        seen[300] += 1;
        continue;
      }
      ASSERT_LT(choice.light, 300u);
      seen[choice.light] += 1;
      ASSERT_NEAR(choice.chance, chances[choice.light], 1e-5 * chances[choice.light]);
    }
    for (const double chance : chances) expected.push_back(chance * draws);
    expected.push_back(std::max(0.0, 1 - sum) * draws);
    // 12 tests: fails by accident once in 10^5 runs.
    EXPECT_GT(chi_square(seen, expected).p_value, 1e-6);
  }
}

// Points, which shine everywhere, for a receiver that takes all: nothing comes to nothing.
TEST(LightTree, ChancesOfPointsAddToOne) {
  Random random(11);
  Scene scene = ground();
  for (int i = 0; i < 500; ++i)
    scene.lights.push_back(point_light(random.in_box(5), std::exp(random.in(-4, 4))));
  LightBench bench(lower(scene));
  for (int i = 0; i < 12; ++i) {
    double sum = 0;
    for (const double chance : bench.chances(random_receiver(random, false), 500)) sum += chance;
    // A few roundings of 2^-24 for each of the levels.
    EXPECT_NEAR(sum, 1, 1e-5);
  }
}

// Light that comes has a chance: intensities in closed form.
TEST(LightTree, NoLightThatShinesIsWithoutAChance) {
  const Scene scene = lamps(300, 3);
  LightBench bench(lower(scene));
  Random random(4);
  int dark = 0, lit = 0;
  for (int i = 0; i < 60; ++i) {
    const Receiver at = random_receiver(random, i % 3 != 0);
    const std::vector<double> chances = bench.chances(at, scene.lights.size());
    for (std::size_t k = 0; k < scene.lights.size(); ++k) {
      dvec3 position{0};
      double angle = 0, reach = pi;
      if (const auto* point = std::get_if<PointLight>(&scene.lights[k].model))
        position = point->position;
      if (const auto* spot = std::get_if<SpotLight>(&scene.lights[k].model)) {
        position = spot->position;
        angle = std::acos(
            std::clamp(glm::dot(spot->direction, glm::normalize(at.p - position)), -1.0, 1.0));
        reach = spot->total_angle;
      }
      const bool shines = angle < reach && above(at, glm::normalize(position - at.p)) > 1e-6;
      if (shines) {
        EXPECT_GT(chances[k], 0) << "receiver " << i << ", light " << k;
      }
      (shines ? lit : dark) += 1;
      // Spots that look away are passed over, but for the breadth of the boxes and cones.
      if (angle > reach + 0.3 && angle > pi / 2 + 0.3) {
        EXPECT_LT(chances[k], 0.02) << "receiver " << i << ", light " << k;
      }
    }
  }
  EXPECT_GT(lit, 5000);
  EXPECT_GT(dark, 5000);
}

// Two lights in one node, which are points, have chances in proportion to the irradiances: I cos /
// d^2.
TEST(LightTree, SiblingsShareByTheirIrradiance) {
  Random random(5);
  Scene scene = ground();
  for (int i = 0; i < 400; ++i)
    scene.lights.push_back(point_light(random.in_box(5), std::exp(random.in(-1, 1))));
  const FlatScene flat = lower(scene);
  LightBench bench(flat);
  int compared = 0;
  for (int i = 0; i < 20; ++i) {
    const Receiver at = random_receiver(random, true);
    const std::vector<double> chances = bench.chances(at, 400);
    const auto irradiance = [&](std::size_t k) {
      const dvec3 d = std::get<PointLight>(scene.lights[k].model).position - at.p;
      return scene.lights[k].scale * glm::dot(d, at.normal) / std::pow(glm::length(d), 3);
    };
    for (std::size_t k = 1; k < 400; ++k)
      for (std::size_t other = 0; other < k; ++other) {
        if (flat.light_places[k] / 8 != flat.light_places[other] / 8 ||
            flat.light_places[k] / 8 == 0)
          continue;
        const double a = irradiance(k), b = irradiance(other);
        const double far =
            std::min(glm::length(std::get<PointLight>(scene.lights[k].model).position - at.p),
                     glm::length(std::get<PointLight>(scene.lights[other].model).position - at.p));
        if (far < 1 || a < 0.05 * scene.lights[k].scale / (far * far) ||
            b < 0.05 * scene.lights[other].scale / (far * far))
          continue;
        // Boxes are whole cells of 10 / 65535: 3e-4 of the distance, which counts twice, and as an
        // angle against a sine of 0.05.
        EXPECT_NEAR(chances[k] / chances[other] / (a / b), 1, 0.02);
        ++compared;
      }
  }
  EXPECT_GT(compared, 1000);
}

// Flat lamps that look one way, in every way that a side can be turned: what a point of them sends
// to the receiver has a chance.
TEST(LightTree, FlatLampsAreSeenFromTheSideThatShines) {
  for (const bool reversed : {false, true})
    for (const bool mirrored : {false, true})
      for (const bool both : {false, true}) {
        Random random(6);
        Scene scene = ground();
        struct Side {
          dvec3 at, normal;
        };
        std::vector<Side> sides;
        TriangleMeshShape mesh;
        const glm::dmat4 placed = glm::scale(glm::translate(glm::dmat4(1), dvec3(1, 2, 0)),
                                             dvec3(mirrored ? -1 : 1, 0.5, 1));
        for (int i = 0; i < 40; ++i) {
          const dvec3 corner = random.in_box(4), a = random.direction() * 0.3,
                      b = random.direction() * 0.3;
          for (const dvec3& v : {corner, corner + a, corner + b}) mesh.positions.emplace_back(v);
          const auto first = static_cast<std::uint32_t>(3 * i);
          mesh.triangles.push_back({first, first + 1, first + 2});
          const auto world = [&](const dvec3& v) { return dvec3(placed * glm::dvec4(v, 1)); };
          // pbrt's rule: by the winding of the vertices in the world, turned by a mirroring
          // transform and by ReverseOrientation.
          dvec3 n = glm::normalize(
              glm::cross(world(corner + a) - world(corner), world(corner + b) - world(corner)));
          if (mirrored) n = -n;
          if (reversed) n = -n;
          sides.push_back({world(corner + (a + b) / 3.0), n});
        }
        Shape lamp;
        lamp.geometry = mesh;
        lamp.world_from_object = placed;
        lamp.reverse_orientation = reversed;
        lamp.emission = AreaEmission{};
        lamp.emission->two_sided = both;
        scene.shapes.push_back(lamp);
        LightBench bench(lower(scene));
        int lit = 0, dark = 0;
        for (int i = 0; i < 30; ++i) {
          const Receiver at = random_receiver(random, true);
          const std::vector<double> chances = bench.chances(at, sides.size());
          for (std::size_t k = 0; k < sides.size(); ++k) {
            const dvec3 to = glm::normalize(sides[k].at - at.p);
            const double sends = -glm::dot(to, sides[k].normal);
            const bool shines = above(at, to) > 1e-3 && (both ? std::abs(sends) : sends) > 1e-3;
            if (shines) {
              EXPECT_GT(chances[k], 0) << reversed << mirrored << both;
            }
            (shines ? lit : dark) += 1;
            // What turns its back, farther than its size can make up for, is passed over.
            const double size = 0.6 / glm::length(sides[k].at - at.p);
            if (!both && sends < -std::min(0.999, 0.1 + size)) {
              EXPECT_EQ(chances[k], 0) << reversed << mirrored;
            }
          }
        }
        EXPECT_GT(lit, 200);
        EXPECT_GT(dark, 200);
      }
}

// Lamps that all look up, on a slope: seen from below its middle but above its lower end, the
// middle's direction says that none shines.
TEST(LightTree, LampsBelowTheMiddleOfTheirBoxAreSeen) {
  Random random(13);
  Scene scene = ground();
  TriangleMeshShape mesh;
  std::vector<dvec3> places;
  for (int i = 0; i < 64; ++i) {
    const double x = random.in(-4, 4);
    const dvec3 corner(x, random.in(-1, 1), 0.3 * x);
    for (const dvec3& v : {corner, corner + dvec3(0.01, 0, 0), corner + dvec3(0, 0.01, 0)})
      mesh.positions.emplace_back(v);
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.push_back({first, first + 1, first + 2});
    places.push_back(corner);
  }
  Shape lamp;
  lamp.geometry = mesh;
  lamp.emission = AreaEmission{};
  scene.shapes.push_back(lamp);
  LightBench bench(lower(scene));
  int lit = 0;
  for (int i = 0; i < 40; ++i) {
    const Receiver at{{random.in(5, 8), random.in(-1, 1), random.in(-1, -0.1)}, dvec3(0)};
    const std::vector<double> chances = bench.chances(at, places.size());
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (at.p.z < places[k].z + 0.01) continue;
      ++lit;
      EXPECT_GT(chances[k], 0);
    }
  }
  EXPECT_GT(lit, 300);
}

// A sun beside many lamps has its half of the choices that are even, and a share of those by power.
TEST(LightTree, IsOneChoiceBesideASun) {
  Random random(7);
  Scene scene = ground();
  for (int i = 0; i < 64; ++i) scene.lights.push_back(point_light(random.in_box(5), 1));
  Light sun;
  sun.model = DistantLight{};
  sun.scale = 1e-9;
  scene.lights.insert(scene.lights.begin() + 10, sun);
  const FlatScene flat = lower(scene);
  LightBench bench(flat);
  const Receiver at{{0.3, 0.1, 0.2}, {0, 0, 0}};
  const std::vector<double> chances = bench.chances(at, 65);
  EXPECT_NEAR(chances[10], 0.25, 1e-6);
  double others = 0;
  for (const double chance : chances) others += chance;
  EXPECT_NEAR(others, 1, 1e-5);
  int suns = 0;
  for (const Choice& choice : bench.choose(at, random.numbers(100000)))
    suns += choice.light == 10 ? 1 : 0;
  EXPECT_NEAR(suns, 25000, 5 * std::sqrt(100000 * 0.25 * 0.75));
}

/// Lamps of one shape.
Shape capsule_lamps(std::size_t count, unsigned seed) {
  Random random(seed);
  CapsulesShape lamps;
  for (std::size_t i = 0; i < count; ++i) {
    const dvec3 at = random.in_box(5);
    lamps.p0.emplace_back(at);
    lamps.p1.emplace_back(at + 0.1 * random.direction());
    lamps.radius0.push_back(static_cast<float>(random.in(0.01, 0.05)));
  }
  Shape out;
  out.geometry = lamps;
  out.emission = AreaEmission{};
  return out;
}

// The table has rows for what stands in no tree, and none where all does.
TEST(LightTree, TheTableHasWhatTheTreeHasNot) {
  Scene scene = ground();
  scene.shapes.push_back(capsule_lamps(40, 21));
  scene.lights.emplace_back();
  scene.lights.back().model = InfiniteLight{};
  FlatScene flat = lower(scene);
  EXPECT_TRUE(flat.light_alias.empty());
  const Receiver at{{0.3, 0.1, 0.2}, {0, 0, 0}};
  EXPECT_EQ(LightBench(flat).chances(at, 41)[40], 0);

  // Three suns, of which one has no power, and a point, which is in the tree.
  for (const double scale : {1.0, 0.0, 3.0}) {
    Light sun;
    sun.model = DistantLight{};
    sun.scale = scale;
    scene.lights.insert(scene.lights.begin(), sun);
  }
  scene.lights.insert(scene.lights.begin() + 1, point_light({1, 2, 3}, 0.1));
  // An emitter that gives nothing is in neither.
  Shape dark = capsule_lamps(3, 22);
  dark.emission->scale = 0;
  scene.shapes.push_back(dark);
  flat = lower(scene);
  ASSERT_EQ(flat.lighting.table_begin, 43u);
  ASSERT_EQ(flat.light_alias.size(), 5u);
  LightBench bench(flat);
  const std::vector<double> chances = bench.chances(at, 48);
  double sum = 0;
  for (const double chance : chances) sum += chance;
  EXPECT_NEAR(sum, 1, 1e-5);
  for (const std::size_t none : {40u, 41u, 42u, 45u, 47u}) EXPECT_EQ(chances[none], 0) << none;
  EXPECT_GT(chances[44], 0);
  // By power and evenly: suns of 3 and of 1.
  const double suns = chances[43] + chances[46];
  EXPECT_NEAR(chances[43] / suns, 0.5 * 0.75 + 0.25, 1e-6);
  constexpr std::size_t draws = 200000;
  std::vector<double> seen(48, 0), expected;
  for (const Choice& choice : bench.choose(at, Random(23).numbers(draws))) {
    ASSERT_LT(choice.light, 48u);
    seen[choice.light] += 1;
    ASSERT_NEAR(choice.chance, chances[choice.light], 1e-5 * chances[choice.light]);
  }
  for (const double chance : chances) expected.push_back(chance * draws);
  EXPECT_GT(chi_square(seen, expected).p_value, 1e-6);
}

// From 65,536 on the builder goes by cells of a grid.
TEST(LightTree, EachOfVeryManyLightsHasOnePlace) {
  constexpr std::size_t n = 70000;
  Scene scene = ground();
  scene.shapes.push_back(capsule_lamps(n, 24));
  const FlatScene flat = lower(scene);
  const std::size_t nodes = flat.light_nodes.size() / CAPLET_LIGHT_NODE;
  ASSERT_EQ(flat.light_places.size(), n + nodes);
  std::vector<int> named(n + nodes, 0);
  std::vector<double> sums(nodes, 0), of_node(nodes, 0);
  for (std::size_t node = 0; node < nodes; ++node)
    for (std::uint32_t slot = 0; slot < 8; ++slot) {
      const std::uint32_t* const rows = &flat.light_nodes[node * CAPLET_LIGHT_NODE + slot];
      if (rows[48] == CAPLET_NONE) continue;
      const bool leaf = (rows[48] & CAPLET_LIGHT_LEAF) != 0;
      const std::size_t who = leaf ? rows[48] & ~CAPLET_LIGHT_LEAF : n + rows[48];
      ASSERT_LT(who, n + nodes);
      ++named[who];
      EXPECT_EQ(flat.light_places[who], node * 8 + slot);
      const double intensity = std::bit_cast<float>(rows[40]);
      sums[node] += intensity;
      if (!leaf) of_node[rows[48]] = intensity;
      // All around.
      EXPECT_EQ(rows[32] & 0xffff, 0u);
    }
  EXPECT_EQ(named[n], 0);  // the root
  for (std::size_t i = 0; i < n + nodes; ++i) {
    if (i != n) {
      EXPECT_EQ(named[i], 1) << i;
    }
  }
  for (std::size_t node = 1; node < nodes; ++node) EXPECT_NEAR(of_node[node] / sums[node], 1, 1e-6);
}

TEST(LightTree, FewLightsAreChosenByTheTable) {
  EXPECT_TRUE(lower(lamps(CAPLET_LIGHT_TREE_FROM - 1, 9)).light_nodes.empty());
  EXPECT_FALSE(lower(lamps(CAPLET_LIGHT_TREE_FROM, 9)).light_nodes.empty());
}

// The grid's boxes, read as the kernel does, hold the points that they are made of, all the way up.
TEST(LightTree, BoxesHoldTheirLights) {
  Random random(12);
  Scene scene = ground();
  for (int i = 0; i < 1000; ++i)
    scene.lights.push_back(point_light(random.in_box(5) * dvec3(1, 0.1, 20), 1));
  const FlatScene flat = lower(scene);
  const LightingRecord& grid = flat.lighting;
  for (std::size_t light = 0; light < 1000; ++light) {
    int levels = 0;
    for (std::uint32_t place = flat.light_places[light]; place != CAPLET_NONE; ++levels) {
      const std::uint32_t node = place / 8, slot = place % 8;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t ends = flat.light_nodes[node * CAPLET_LIGHT_NODE + 8 * k + slot];
        const double low = static_cast<double>(grid.tree_min[k]) +
                           static_cast<double>(grid.tree_cell[k]) * (ends & 0xffff),
                     high = static_cast<double>(grid.tree_min[k]) +
                            static_cast<double>(grid.tree_cell[k]) * (ends >> 16);
        const double at =
            std::get<PointLight>(scene.lights[light].model).position[static_cast<int>(k)];
        EXPECT_LE(low, at);
        EXPECT_GE(high, at);
        EXPECT_LE(high - low, levels == 0 ? 2.01 * grid.tree_cell[k] : 1000.0);
      }
      place = flat.light_places[1000 + node];
    }
    EXPECT_GE(levels, 3);
  }
}

// Cones that are put together hold both: directions of the two are within the one.
TEST(LightTree, UnitedConesHoldBoth) {
  Random random(10);
  for (int i = 0; i < 2000; ++i) {
    LightBounds bounds[2];
    for (LightBounds& of : bounds) {
      of.axis = random.direction();
      of.cos_cone = random.unit() < 0.2 ? 1 : std::cos(random.in(0, 2));
      of.cos_reach = std::cos(random.in(0, pi));
      of.intensity = random.unit();
    }
    if (i % 5 == 0) bounds[1].axis = bounds[0].axis * (i % 10 == 0 ? -1.0 : 1.0);
    const LightBounds both = united(bounds[0], bounds[1]);
    EXPECT_NEAR(glm::length(both.axis), 1, 1e-9);
    EXPECT_EQ(both.cos_reach, std::min(bounds[0].cos_reach, bounds[1].cos_reach));
    EXPECT_DOUBLE_EQ(both.intensity, bounds[0].intensity + bounds[1].intensity);
    for (const LightBounds& of : bounds)
      for (int k = 0; k < 20; ++k) {
        // A direction on the rim of the cone.
        const dvec3 across = glm::normalize(glm::cross(of.axis, random.direction()));
        const dvec3 v = of.axis * of.cos_cone +
                        across * std::sqrt(std::max(0.0, 1 - of.cos_cone * of.cos_cone));
        EXPECT_GE(glm::dot(v, both.axis), both.cos_cone - 1e-7);
      }
  }
}

}  // namespace caplet::test::tree_test
