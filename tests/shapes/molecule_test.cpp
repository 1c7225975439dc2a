// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Molecular surfaces as the kernels see them: areas and volumes of two balls by their closed forms,
// whole molecules by what a closed surface must be. molecular_surface_test.cpp has the patches
// themselves, the tests over shapes each patch against the reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "list_tracer.h"
#include "scene_probe.h"
#include "widths.h"

namespace caplet::test {
namespace {

constexpr std::uint32_t capacity = 64;

// Two balls of radius r at z = +-half, and a probe.
struct Dumbbell {
  double r, half, probe;
  double major() const {
    return std::sqrt((r + probe) * (r + probe) - half * half);  // NaN: the probe passes between
  }
  bool is_joined() const { return half < r + probe; }
  // The heights at which the probe touches the balls, and where its own two sides meet.
  double contact() const { return half * probe / (r + probe); }
  double cusp() const { return major() < probe ? std::sqrt(probe * probe - major() * major()) : 0; }
  double area() const {
    if (!is_joined()) return 8 * pi * r * r;
    const double from = std::asin(cusp() / probe), to = std::asin(contact() / probe);
    const double belt =
        2 * pi * probe * (major() * (to - from) - probe * (std::sin(to) - std::sin(from)));
    return 2 * (2 * pi * r * (half + r - contact()) + belt);
  }
  double volume() const {
    const auto cap = [&](double z) { return pi * (r * r * z - z * z * z / 3); };  // from the centre
    if (!is_joined()) return 2 * (cap(r) - cap(-r));
    // Simpson's rule over the belt.
    constexpr int steps = 2000;
    const double step = (contact() - cusp()) / steps;
    double belt = 0;
    for (int i = 0; i <= steps; ++i) {
      const double z = cusp() + i * step,
                   rho = major() - std::sqrt(std::max(0.0, probe * probe - z * z));
      belt += (i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2) * pi * rho * rho * step / 3;
    }
    return 2 * (cap(r) - cap(contact() - half) + belt);
  }
  Shape shape() const {
    const auto z = static_cast<float>(half), radius = static_cast<float>(r);
    return shape_of(make_molecule({{0, 0, z}, {0, 0, -z}}, {radius, radius}, probe));
  }
};

// Lines through the ball of radius `size`, each equally likely, that begin outside of it.
std::vector<RayRecord> lines_through(double size, int count, Random& random) {
  std::vector<RayRecord> out;
  for (int i = 0; i < count; ++i) {
    const dvec3 d = random.direction(), around = random.direction();
    const dvec3 across = glm::normalize(around - glm::dot(around, d) * d);
    out.push_back(make_ray(size * std::sqrt(random(0, 1)) * across - 1.5 * size * d, d));
  }
  return out;
}

struct Mean {
  double sum = 0, squares = 0;
  int count = 0;
  void add(double x) {
    sum += x;
    squares += x * x;
    ++count;
  }
  double mean() const { return sum / count; }
  double error() const { return std::sqrt((squares / count - mean() * mean()) / count); }
};

// Whether entering and leaving take turns, from the outside to the outside.
bool takes_turns(const std::vector<HitRecord>& hits) {
  for (std::size_t i = 0; i < hits.size(); ++i)
    if (is_leaving(hits[i]) != (i % 2 == 1)) return false;
  return hits.size() % 2 == 0;
}

// Without what is crossed a second time in the same direction at the same place.
std::vector<HitRecord> once(const std::vector<HitRecord>& hits) {
  std::vector<HitRecord> out;
  for (const HitRecord& hit : hits)
    if (out.empty() || is_leaving(out.back()) != is_leaving(hit) || hit.t - out.back().t > 1e-3f)
      out.push_back(hit);
  return out;
}

INSTANTIATE_TEST_SUITE_P(Real, Widths, testing::Values(8, 1));

// By Cauchy and Crofton a surface's area is twice the area of the disk of all lines of one
// direction times the mean number of crossings, and the volume that area times the mean length
// within.
TEST_P(Widths, TwoBallsHaveTheirAreaAndVolume) {
  const ListTracer& tracer = list_tracer(GetParam());
  Random random(3);
  for (const Dumbbell& dumbbell :
       {Dumbbell{1, 1.25, 0.75}, Dumbbell{1, 1.5, 0.75}, Dumbbell{1, 1.8125, 0.75},
        Dumbbell{1, 0.5, 3}, Dumbbell{1, 0.75, 0.125}}) {
    SCOPED_TRACE(testing::Message() << dumbbell.half << " " << dumbbell.probe);
    const double size = dumbbell.half + dumbbell.r, disk = pi * size * size;
    const FlatScene scene = lower_shapes({dumbbell.shape()});
    Mean crossings, length;
    int astray = 0;
    for (const RayList& list : tracer.trace(scene, lines_through(size, 100000, random), capacity)) {
      const std::vector<HitRecord> hits = once(list.hits);
      if (!takes_turns(hits)) {
        ++astray;
        continue;
      }
      double within = 0;
      for (const HitRecord& hit : hits)
        within += (is_leaving(hit) ? 1 : -1) * static_cast<double>(hit.t);
      crossings.add(static_cast<double>(hits.size()));
      length.add(within);
    }
    EXPECT_EQ(astray, 0);
    EXPECT_NEAR(2 * disk * crossings.mean(), dumbbell.area(), 2 * disk * 4 * crossings.error());
    EXPECT_NEAR(disk * length.mean(), dumbbell.volume(), disk * 4 * length.error());
  }
}

MolecularSurfaceShape cluster(int count, double spread, double probe, Random& random) {
  std::vector<glm::vec3> centers;
  std::vector<float> radii;
  for (int i = 0; i < count; ++i) {
    centers.emplace_back(spread * random.point());
    radii.push_back(static_cast<float>(random(0.4, 1)));
  }
  return make_molecule(centers, radii, probe);
}

// A line goes in and out in turns wherever it crosses, also where patches meet and under maps that
// turn, mirror and stretch.
TEST_P(Widths, MoleculesAreClosed) {
  const ListTracer& tracer = list_tracer(GetParam());
  Random random(5);
  int lines = 0, crossings = 0, astray = 0, twice = 0;
  for (int i = 0; i < 12; ++i) {
    glm::dmat4 m = glm::rotate(glm::dmat4(1), random(0, 6), random.direction());
    if (i % 4 == 1) m = glm::scale(m, dvec3(1, -1, 1));
    if (i % 4 == 2) m = glm::scale(m, dvec3(1, 1.25, 0.75));
    const FlatScene scene =
        lower_shapes({shape_of(cluster(4 + 6 * i, 1 + 0.2 * i, random(0.2, 1.5), random), m)});
    for (const RayList& list : tracer.trace(scene, lines_through(5, 20000, random), capacity)) {
      ++lines;
      crossings += static_cast<int>(list.hits.size());
      twice += !takes_turns(list.hits) && takes_turns(once(list.hits));
      astray += !takes_turns(once(list.hits));
      EXPECT_EQ(list.hits.empty(), list.closest.slot == CAPLET_NONE);
      EXPECT_EQ(list.hits.empty(), !list.any);
      if (!list.hits.empty()) {
        EXPECT_EQ(list.hits[0].t, list.closest.t);
      }
    }
  }
  std::printf("%d lines, %d crossings, %d of them twice, %d astray\n", lines, crossings, twice,
              astray);
  EXPECT_GT(crossings, lines / 2);
  // Neighbours reach beyond their common border by some roundings, where a line crosses both.
  EXPECT_EQ(astray, 0);
  EXPECT_LE(twice, crossings / 10000);
}

// Every point has the material of the ball that it is nearest to.
TEST_P(Widths, PatchesHaveTheirBallsMaterial) {
  Random random(7);
  MolecularSurfaceShape molecule = cluster(12, 1.2, 0.6, random);
  Scene scene;
  for (std::uint32_t i = 0; i < 12; ++i) {
    molecule.materials.push_back(i);
    scene.materials.emplace_back();
  }
  Shape shape = shape_of(molecule);
  shape.material = 0;
  scene.shapes = {shape};
  int told = 0;
  for (const RayList& list :
       list_tracer(GetParam()).trace(lower(scene), lines_through(3, 4000, random), capacity))
    for (const CrossingSurface& surface : list.surfaces) {
      const dvec3 x = vec(surface.p);
      std::vector<double> away;
      for (std::size_t i = 0; i < 12; ++i)
        away.push_back(glm::length(x - dvec3(molecule.centers[i])) -
                       static_cast<double>(molecule.radii[i]));
      const double own = away[surface.material];
      std::ranges::sort(away);
      // On the balls it is exact; in between directions from the probe decide, not distances.
      if (away[0] > 1e-5) continue;
      EXPECT_NEAR(own, away[0], 1e-5);
      ++told;
    }
  EXPECT_GT(told, 1000);
}

TEST(Molecules, AreRefusedByWhatIsWrong) {
  const auto said = [](const MolecularSurfaceShape& molecule) {
    Scene scene;
    scene.materials.emplace_back();
    scene.shapes = {shape_of(molecule)};
    Diagnostics diagnostics;
    validate(scene, diagnostics);
    try {
      diagnostics.finish();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(said(make_molecule({{0, 0, 0}}, {1}, 1)), "");
  EXPECT_NE(said(make_molecule({{0, 0, 0}}, {}, 1)).find("number of radii"), std::string::npos);
  EXPECT_NE(said(make_molecule({{0, NAN, 0}}, {1}, 1)).find("not finite"), std::string::npos);
  EXPECT_NE(said(make_molecule({{0, 0, 0}}, {0}, 1)).find("positive"), std::string::npos);
  EXPECT_NE(said(make_molecule({{0, 0, 0}}, {1}, 0)).find("probe"), std::string::npos);
  EXPECT_NE(said(make_molecule({{0, 0, 0}}, {1}, 1, {1})).find("material 1"), std::string::npos);
  EXPECT_NE(said(make_molecule({{0, 0, 0}}, {1}, 1, {0, 0})).find("materials"), std::string::npos);
}

}  // namespace
}  // namespace caplet::test
