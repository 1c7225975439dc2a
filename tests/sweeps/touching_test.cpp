// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Solids that touch: boxes and polyhedra with common faces, chains of capsules and cylinders with
// common ends, spheres that rest on boxes, triangles with common edges. A ray that begins in one of
// them goes on from surface to surface by offset_origin, as paths do: wherever the reference says
// that it crosses a surface, one of the solids there has to have seen it. 20,000 rays;
// CAPLET_TEST_SCALE=50 makes it a million.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <mutex>

#include "cases.h"
#include "reference/scene_reference.h"
#include "scene_probe.h"
#include "shared/kinds.h"

namespace caplet::test::touching_test {
namespace {

using glm::dvec3;

constexpr double eps = 0x1p-24;
constexpr std::uint32_t most_steps = 64;

// Shapes that touch, and the places where they do.
struct Touching {
  std::vector<Shape> shapes;
  std::vector<dvec3> places;  // on common faces, edges and ends
  std::vector<dvec3> inside;  // of the union, not near a surface
  double size = 1;            // of the whole
};

double rounded(double x) { return static_cast<float>(x); }
dvec3 rounded(const dvec3& v) { return {rounded(v.x), rounded(v.y), rounded(v.z)}; }

class TouchingMaker {
 public:
  explicit TouchingMaker(std::uint32_t seed) : maker(seed) {
    scale = std::pow(10.0, maker.uniform(-3, 3));
    center = (maker.below(2) == 0 ? 0.0 : scale * std::pow(10.0, maker.uniform(0, 3))) *
             maker.direction();
  }

  // A grid of boxes with common faces.
  Touching boxes() {
    std::array<std::array<double, 4>, 3> planes{};
    for (std::size_t k = 0; k < 3; ++k) {
      double at = center[static_cast<int>(k)];
      for (double& plane : planes[k]) plane = rounded(at), at += scale * maker.uniform(0.3, 1);
    }
    const auto corner = [&](std::size_t x, std::size_t y, std::size_t z) {
      return dvec3(planes[0][x], planes[1][y], planes[2][z]);
    };
    Touching out;
    for (std::size_t x = 0; x < 3; ++x)
      for (std::size_t y = 0; y < 3; ++y)
        for (std::size_t z = 0; z < 3; ++z) {
          const dvec3 low = corner(x, y, z), high = corner(x + 1, y + 1, z + 1);
          out.shapes.push_back(shape_of(BoxShape{low, high}));
          out.inside.push_back(0.5 * (low + high));
          for (const double s : {0.0, 0.5, 1.0})
            out.places.push_back(
                {low.x + s * (high.x - low.x), low.y, low.z + s * (high.z - low.z)});
          out.places.push_back({low.x, 0.3 * low.y + 0.7 * high.y, 0.4 * low.z + 0.6 * high.z});
        }
    out.size = 3 * scale;
    return out;
  }

  // A chain of capsules, every other time of varying radius.
  Touching capsules() {
    const double r = scale * maker.uniform(0.02, 0.3);
    const bool tapered = maker.below(2) == 0;
    Touching out;
    CapsulesShape chain;
    dvec3 at = rounded(center);
    double radius = rounded(r);
    for (int i = 0; i < 10; ++i) {
      const dvec3 next = rounded(at + scale * maker.uniform(0.3, 1) * maker.direction());
      const double end = tapered ? rounded(r * maker.uniform(0.5, 1)) : radius;
      chain.p0.push_back(glm::vec3(at));
      chain.p1.push_back(glm::vec3(next));
      chain.radius0.push_back(static_cast<float>(radius));
      if (tapered) chain.radius1.push_back(static_cast<float>(end));
      out.places.push_back(at);
      out.places.push_back(at + radius * maker.direction());
      out.inside.push_back(0.5 * (at + next));
      at = next;
      radius = end;
    }
    out.shapes.push_back(shape_of(chain));
    out.size = 5 * scale;
    return out;
  }

  // Cylinders with flat ends in a row, each beginning where the last one ends.
  Touching cylinders() {
    const dvec3 axis = maker.below(2) == 0 ? dvec3(0, 0, 1) : maker.direction();
    const double radius = rounded(scale * maker.uniform(0.05, 0.5));
    Touching out;
    dvec3 at = rounded(center);
    for (int i = 0; i < 6; ++i) {
      const dvec3 next = rounded(at + scale * maker.uniform(0.2, 1) * axis);
      out.shapes.push_back(shape_of(CylinderShape{at, next, radius, {Cap::flat, Cap::flat}}));
      const dvec3 around = maker.direction(),
                  across = glm::normalize(around - glm::dot(around, axis) * axis);
      for (const double s : {0.0, 0.5, 1.0}) out.places.push_back(at + s * radius * across);
      out.inside.push_back(0.5 * (at + next));
      at = next;
    }
    out.size = 4 * scale;
    return out;
  }

  // Spheres that rest on a box and on each other.
  Touching spheres() {
    Touching out;
    const dvec3 low = rounded(center), high = rounded(center + dvec3(4, 4, 1) * scale);
    out.shapes.push_back(shape_of(BoxShape{low, high}));
    out.inside.push_back(0.5 * (low + high));
    for (int i = 0; i < 4; ++i) {
      const double r = rounded(scale * maker.uniform(0.2, 0.5));
      const dvec3 c = rounded(dvec3(low.x + (0.5 + i) * scale, low.y + 2 * scale, high.z + r));
      out.shapes.push_back(shape_of(SphereShape{r}, glm::translate(glm::dmat4(1), c)));
      out.inside.push_back(c);
      out.places.push_back({c.x, c.y, high.z});
    }
    out.size = 4 * scale;
    return out;
  }

  // A box cut in two by a plane.
  Touching polyhedra() {
    const dvec3 n = maker.direction(), low = -0.5 * dvec3(scale), high = 0.5 * dvec3(scale),
                cut = center + 0.1 * scale * maker.direction();
    Touching out;
    for (const double side : {-1.0, 1.0}) {
      PolyhedronShape half;
      for (int k = 0; k < 3; ++k) {
        dvec3 axis(0);
        axis[k] = 1;
        half.points.insert(half.points.end(), {center + low, center + high});
        half.normals.insert(half.normals.end(), {-axis, axis});
      }
      half.points.push_back(cut);
      half.normals.push_back(-side * n);
      out.shapes.push_back(shape_of(half));
      out.inside.push_back(cut + 0.1 * side * scale * n);
    }
    for (int i = 0; i < 20; ++i) {
      const dvec3 around = maker.direction();
      out.places.push_back(cut +
                           0.4 * scale * maker.uniform(0, 1) * (around - glm::dot(around, n) * n));
    }
    out.size = 2 * scale;
    return out;
  }

  // A closed mesh of needles and other triangles: a cone of triangles on either side of a star.
  Touching triangles() {
    TriangleMeshShape mesh;
    Touching out;
    const int corners = 5 + maker.below(20);
    for (int i = 0; i < corners; ++i) {
      const double phi = (i + 0.4 * maker.uniform(0, 1)) * full_turn / corners,
                   r = scale * maker.uniform(0.5, 1);
      out.places.push_back(
          rounded(center + r * dvec3(std::cos(phi), std::sin(phi), 0.2 * maker.uniform(-1, 1))));
    }
    out.places.push_back(rounded(center + dvec3(0, 0, scale)));
    out.places.push_back(rounded(center - dvec3(0, 0, scale)));
    for (const dvec3& p : out.places) mesh.positions.push_back(glm::vec3(p));
    const auto top = static_cast<std::uint32_t>(corners), bottom = top + 1;
    for (std::uint32_t i = 0; i < top; ++i) {
      const std::uint32_t next = (i + 1) % top;
      mesh.triangles.push_back({i, next, top});
      mesh.triangles.push_back({next, i, bottom});
      // Points of the edges.
      out.places.push_back(0.5 * (out.places[i] + out.places[next]));
      out.places.push_back(0.7 * out.places[i] + 0.3 * out.places[top]);
    }
    out.shapes.push_back(shape_of(mesh));
    out.inside.push_back(center);
    out.size = 2 * scale;
    return out;
  }

  CaseMaker maker;
  double scale;
  dvec3 center;
};

struct Tally {
  std::mutex mutex;
  std::uint64_t rays = 0, places = 0, steep = 0, leaks = 0;
  int shown = 0;
};

// Every place where the reference's ray crosses something has been seen by a step of the walk.
void check(const Touching& touching, const reference::SceneReference& reference,
           const RayRecord& ray, const Walk& walk, const std::string& where, Tally& tally) {
  const reference::Ray exact = reference_ray(ray);
  const double speed = glm::length(exact.direction),
               reach = glm::length(exact.origin) + touching.size;
  // What the first hit is off by, and each step moves the ray by at most its `error`; twice that,
  // and the surface points' own.
  double drift = 32 * eps * reach;
  for (const WalkStep& step : walk.steps) drift += 4 * double(step.error);
  std::uint64_t places = 0, steep = 0, leaks = 0;
  dvec3 leak(0);
  const std::vector<reference::SceneHit> crossings = reference.all(exact);
  const auto at = [&](const reference::SceneHit& hit) {
    return exact.origin + hit.t * exact.direction;
  };
  const auto cosine_at = [&](const reference::SceneHit& hit) {
    return std::abs(glm::dot(reference.normal(hit, at(hit)), exact.direction)) / speed;
  };
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    const reference::SceneHit& hit = crossings[i];
    const dvec3 x = at(hit);
    const double cosine = cosine_at(hit);
    // The other end of the chord: moved by the drift, the ray has to meet this solid still.
    double chord = HUGE_VAL;
    for (std::size_t k = 0; k < crossings.size(); ++k) {
      const bool pair = hit.leaving ? k < i : k > i;
      if (!pair || crossings[k].index != hit.index || crossings[k].leaving == hit.leaving) continue;
      chord = std::min(chord, std::abs(hit.t - crossings[k].t) * speed *
                                  std::min(cosine, cosine_at(crossings[k])));
    }
    // The crossing may lie 100 times the drift away, or nowhere; and normals at edges have no
    // meaning.
    if (!(cosine > 0.01) || !(chord > 8 * drift)) {
      ++steep;
      continue;
    }
    ++places;
    const double allowed = 2 * drift / cosine;
    if (glm::length(x - exact.origin) < allowed) continue;  // begins there
    const bool seen = std::any_of(walk.steps.begin(), walk.steps.end(), [&](const WalkStep& step) {
      return glm::length(vec(step.p) - x) <= allowed;
    });
    if (!seen) ++leaks, leak = x;
  }
  const std::lock_guard lock(tally.mutex);
  ++tally.rays;
  tally.places += places;
  tally.steep += steep;
  tally.leaks += leaks;
  if (leaks > 0 && ++tally.shown <= 3) {
    std::string steps;
    for (const WalkStep& step : walk.steps)
      steps += "\n  " + std::to_string(step.p[0]) + " " + std::to_string(step.p[1]) + " " +
               std::to_string(step.p[2]);
    ADD_FAILURE() << where << ": nothing is seen at " << leak.x << " " << leak.y << " " << leak.z
                  << ", drift " << drift << "; ray " << ray.ox << " " << ray.oy << " " << ray.oz
                  << "  " << ray.dx << " " << ray.dy << " " << ray.dz << "; steps:" << steps;
  }
}

struct Row {
  const char* name;
  Touching (TouchingMaker::*make)();
};
void PrintTo(const Row& row, std::ostream* out) { *out << row.name; }

class Leaks : public testing::TestWithParam<Row> {};

TEST_P(Leaks, EveryCrossingIsSeen) {
  Tally tally;
  const int scenes = 12 * test_scale();
  for (int i = 0; i < scenes; ++i) {
    TouchingMaker made(4000 + static_cast<std::uint32_t>(i));
    const Touching touching = (made.*GetParam().make)();
    Scene scene;
    scene.materials.emplace_back();
    scene.shapes = touching.shapes;
    const reference::SceneReference reference(scene);
    CaseMaker& maker = made.maker;
    std::vector<RayRecord> rays;
    for (int k = 0; k < 300; ++k) {
      const dvec3 from = touching.inside[static_cast<std::size_t>(
                             maker.below(static_cast<int>(touching.inside.size())))] +
                         (maker.below(2) == 0 ? 0.0 : 0.01 * made.scale) * maker.direction();
      const dvec3 at = touching.places[static_cast<std::size_t>(
          maker.below(static_cast<int>(touching.places.size())))];
      const double aside =
          maker.below(2) == 0 ? 0.0 : made.scale * std::pow(10.0, maker.uniform(-8, -1));
      const dvec3 d =
          maker.below(4) == 0 ? maker.direction() : at + aside * maker.direction() - from;
      rays.push_back(make_ray(from, glm::normalize(d)));
    }
    const std::string where = "scene " + std::to_string(i);
    const auto walks = walk(lower_shapes(touching.shapes), rays, most_steps);
    tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t k) {
      check(touching, reference, rays[k], walks[k], where, tally);
    });
  }
  const auto number = [](std::uint64_t x) { return static_cast<unsigned long long>(x); };
  std::printf(
      "%s: %llu rays, %llu crossings, %llu of them not seen; %llu too oblique or shallow to ask\n",
      GetParam().name, number(tally.rays), number(tally.places), number(tally.leaks),
      number(tally.steep));
  EXPECT_EQ(tally.leaks, 0u);
  EXPECT_GT(tally.places, tally.rays / 2);
  EXPECT_LT(tally.steep, tally.places);
}

const Row rows[] = {
    {"boxes", &TouchingMaker::boxes},         {"capsules", &TouchingMaker::capsules},
    {"cylinders", &TouchingMaker::cylinders}, {"spheres", &TouchingMaker::spheres},
    {"polyhedra", &TouchingMaker::polyhedra}, {"triangles", &TouchingMaker::triangles}};
INSTANTIATE_TEST_SUITE_P(Kinds, Leaks, testing::ValuesIn(rows),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace caplet::test::touching_test
