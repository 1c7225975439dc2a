// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The patches of solvent-excluded surfaces against closed forms and against their definition: a
// point is in the molecule when no place where the probe's centre may be is nearer than its radius.
#include "scene/shapes/molecular_surface.h"
#include "base/error.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "support/test_scale.h"

namespace caplet::molecular_surface_test {
namespace {

using glm::dvec3;
using std::numbers::pi;
using BallPatch = SurfacePatches::BallPatch;
using TorusPatch = SurfacePatches::TorusPatch;
using Random = std::mt19937;

double uniform(Random& random, double from, double to) {
  return from + (to - from) * (static_cast<double>(random()) + 0.5) / 4294967296.0;
}

dvec3 random_direction(Random& random) {
  const double z = uniform(random, -1, 1), phi = uniform(random, 0, 2 * pi);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

struct Molecule {
  std::string name;
  std::vector<glm::vec3> centers;
  std::vector<float> radii;
  double probe;
  void add(const dvec3& center, double radius) {
    centers.emplace_back(center);
    radii.push_back(static_cast<float>(radius));
  }
  SurfacePatches surface() const { return molecular_surface(centers, radii, probe); }
};

/// Distances from the probe's free places by brute force. The nearest one lies on a sphere under
/// the point, on a circle of two spheres beside it, or where three meet. `slack` is how far a place
/// may lie inside a ball; a negative one keeps it off all other balls.
class FreeSpace {
 public:
  explicit FreeSpace(const Molecule& of, double slack = 1e-9) : slack_(slack) {
    for (std::size_t i = 0; i < of.centers.size(); ++i)
      balls_.push_back({dvec3(of.centers[i]), of.radii[i] + of.probe});
    for (std::size_t i = 0; i < balls_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) add_circle(i, j);
    for (const Circle& circle : circles_)
      for (std::size_t k = 0; k < circle.j; ++k) add_points(circle, k);
  }

  double distance(const dvec3& x) const {
    if (free(x, none, none, none, slack_)) return 0;
    double best = 1e300;
    for (const Place& p : points_) best = std::min(best, glm::length(x - p.at));
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      const dvec3 off = x - balls_[i].center;
      const dvec3 p = balls_[i].center + balls_[i].radius * glm::normalize(off);
      const double d = glm::length(x - p);
      if (d < best && free(p, i, none, none, slack_)) best = d;
    }
    for (const Circle& c : circles_) {
      const dvec3 off = x - c.center;
      const dvec3 p = c.center + c.radius * glm::normalize(off - glm::dot(off, c.axis) * c.axis);
      const double d = glm::length(x - p);
      if (d < best && free(p, c.i, c.j, none, slack_)) best = d;
    }
    return best;
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  struct Ball {
    dvec3 center;
    double radius;
  };
  struct Circle {
    std::size_t i, j;
    dvec3 center, axis;
    double radius;
  };
  struct Place {
    dvec3 at;
  };

  bool free(const dvec3& p, std::size_t i, std::size_t j, std::size_t k, double slack) const {
    for (std::size_t l = 0; l < balls_.size(); ++l)
      if (l != i && l != j && l != k &&
          glm::length(p - balls_[l].center) < balls_[l].radius - slack)
        return false;
    return true;
  }

  void add_circle(std::size_t i, std::size_t j) {
    const Ball &a = balls_[i], &b = balls_[j];
    const double d = glm::length(b.center - a.center);
    if (d == 0) return;
    const double h = (d * d + a.radius * a.radius - b.radius * b.radius) / (2 * d);
    if (std::abs(h) >= a.radius) return;
    const dvec3 axis = (b.center - a.center) / d;
    circles_.push_back({i, j, a.center + h * axis, axis, std::sqrt(a.radius * a.radius - h * h)});
  }

  /// The circle's points on the sphere k: cos(angle) has one value.
  void add_points(const Circle& c, std::size_t k) {
    const dvec3 m = balls_[k].center - c.center;
    const dvec3 flat = m - glm::dot(m, c.axis) * c.axis;
    const double q = glm::length(flat);
    if (q < 1e-9) return;
    const double cosine =
        (glm::dot(m, m) + c.radius * c.radius - balls_[k].radius * balls_[k].radius) /
        (2 * c.radius * q);
    if (std::abs(cosine) > 1) return;
    const dvec3 x = flat / q, y = glm::cross(c.axis, x);
    for (const double sign : {-1.0, 1.0}) {
      const double sine = sign * std::sqrt(1 - cosine * cosine);
      const dvec3 p = c.center + c.radius * (cosine * x + sine * y);
      if (free(p, c.i, c.j, k, slack_)) points_.push_back({p});
    }
  }

  double slack_;
  std::vector<Ball> balls_;
  std::vector<Circle> circles_;
  std::vector<Place> points_;
};

bool within(const SurfacePatches& of, const BallPatch& patch, const dvec3& x, double slack = 0) {
  for (std::uint32_t i = 0; i < patch.plane_count; ++i) {
    const SurfacePatches::Plane& plane = of.planes[patch.plane_begin + i];
    if (glm::dot(plane.normal, x - patch.center) > plane.offset + slack) return false;
  }
  return true;
}

dvec3 at(const TorusPatch& patch, double phi, double theta) {
  const dvec3 y = glm::cross(patch.axis, patch.start);
  return patch.center +
         (patch.major + patch.minor * std::cos(theta)) *
             (std::cos(phi) * patch.start + std::sin(phi) * y) +
         patch.minor * std::sin(theta) * patch.axis;
}

/// Where the probe's centre is when its ball touches the torus along an arc.
dvec3 tube_center(const TorusPatch& patch, double phi) {
  const dvec3 y = glm::cross(patch.axis, patch.start);
  return patch.center + patch.major * (std::cos(phi) * patch.start + std::sin(phi) * y);
}

/// Calls f(x, center of the probe, ball of the molecule) for random points of all patches. Patches
/// of balls of the molecule have the place where a probe touches x.
using OnPoint =
    std::function<void(const dvec3& x, const dvec3& probe, std::uint32_t ball, const Bounds&)>;
void sample(const SurfacePatches& of, double probe, Random& random, int tries, const OnPoint& f) {
  for (const BallPatch& patch : of.balls)
    for (int i = 0; i < tries; ++i) {
      const dvec3 d = random_direction(random);
      const dvec3 x = patch.center + patch.radius * d;
      if (!within(of, patch, x)) continue;
      f(x, patch.probe ? patch.center : x + probe * d, patch.ball, patch.bounds);
    }
  for (const TorusPatch& patch : of.tori)
    for (int i = 0; i < (tries + 9) / 10; ++i) {
      const double phi = uniform(random, 0, patch.phi_max);
      const double theta = uniform(random, patch.theta_min, patch.theta_max);
      f(at(patch, phi, theta), tube_center(patch, phi), patch.ball, patch.bounds);
    }
}

double area_of(const TorusPatch& t) {
  return t.minor * t.phi_max *
         (t.major * (t.theta_max - t.theta_min) +
          t.minor * (std::sin(t.theta_max) - std::sin(t.theta_min)));
}

/// The part of the points of a fine spiral that lie in the patch tells its area.
double area_of(const SurfacePatches& of, const BallPatch& patch) {
  constexpr int count = 200000;
  int found = 0;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, phi = 2.399963229728653 * i;
    const double r = std::sqrt(1 - z * z);
    found += within(of, patch,
                    patch.center + patch.radius * dvec3(r * std::cos(phi), r * std::sin(phi), z));
  }
  return 4 * pi * patch.radius * patch.radius * found / count;
}

Molecule cloud(Random& random, int count, double size, double probe, std::string name) {
  Molecule m{std::move(name), {}, {}, probe};
  for (int i = 0; i < count; ++i)
    m.add(dvec3(uniform(random, -size, size), uniform(random, -size, size),
                uniform(random, -size, size)),
          uniform(random, 0.5, 2));
  return m;
}

/// Clouds of all densities, flat ones, shells and rings that are not regular.
std::vector<Molecule> general_molecules() {
  Random random(41);
  std::vector<Molecule> all;
  for (int i = 0; i < 36 * test::test_scale(); ++i) {
    const int count = 3 + static_cast<int>(uniform(random, 0, 38));
    const double size = uniform(random, 0.5, 1.6) * std::cbrt(count) * (i % 3 ? 1 : 1.6);
    const double probe = i % 2 ? uniform(random, 0.2, 1) : uniform(random, 0.8, 3);
    Molecule m = cloud(random, count, size, probe, "cloud " + std::to_string(i));
    if (i % 4 == 1)
      for (auto& c : m.centers) c.z *= 0.1f;
    if (i % 9 == 2)
      for (auto& c : m.centers) c *= static_cast<float>(size) / glm::length(c);
    if (i % 9 == 5)
      for (auto& c : m.centers) {
        c.z = 0.3f * c.z;
        c = glm::vec3(glm::vec2(c) * static_cast<float>(size) / glm::length(glm::vec2(c)), c.z);
      }
    all.push_back(std::move(m));
  }
  return all;
}

/// Lattices, rings, rows and doubles, which touch and coincide in all ways.
std::vector<Molecule> special_molecules() {
  std::vector<Molecule> all;
  for (const double probe : {0.4, 0.5, 1.4, 2.5}) {
    Molecule cube{"cube", {}, {}, probe}, ring{"ring", {}, {}, probe}, row{"row", {}, {}, probe};
    Molecule sheet{"sheet", {}, {}, probe}, twice{"twice", {}, {}, probe};
    for (int i = 0; i < 27; ++i) cube.add({i % 3 * 2, i / 3 % 3 * 2, i / 9 * 2}, 1);
    for (int i = 0; i < 8; ++i)
      ring.add(3.0 * dvec3(std::cos(pi / 4 * i), std::sin(pi / 4 * i), 0), 1);
    for (int i = 0; i < 7; ++i) row.add({i, 0, 0}, 1);
    for (int i = 0; i < 25; ++i) sheet.add({i % 5 * 2 + i / 5, i / 5 * std::sqrt(3.0), 0}, 1);
    for (int i = 0; i < 8; ++i) twice.add({i % 2 * 2, i / 2 % 2 * 2, 0}, 1);
    all.insert(all.end(), {cube, ring, row, sheet, twice});
  }
  return all;
}

TEST(MolecularSurface, OneBallIsASphere) {
  Molecule one{"one", {}, {}, 1.4};
  one.add({1, 2, 3}, 1.5);
  const SurfacePatches surface = one.surface();
  ASSERT_EQ(surface.balls.size(), 1u);
  EXPECT_TRUE(surface.tori.empty());
  EXPECT_EQ(surface.balls[0].plane_count, 0u);
  EXPECT_EQ(surface.balls[0].probe, 0u);
  EXPECT_NEAR(surface.balls[0].radius, 1.5, 1e-7);
  EXPECT_NEAR(glm::length(surface.balls[0].bounds.max - dvec3(2.5, 3.5, 4.5)), 0, 1e-7);
  EXPECT_NEAR(glm::length(surface.balls[0].bounds.min - dvec3(-0.5, 0.5, 1.5)), 0, 1e-7);
  EXPECT_TRUE(molecular_surface({}, {}, 1).balls.empty());
}

/// Areas of two balls at a distance. The belt is that of a circular arc turned around the axis.
void check_two(double a, double b, double distance, double probe) {
  Molecule two{"two", {}, {}, probe};
  two.add({0, 0, 0}, a);
  two.add(distance * glm::normalize(dvec3(1, 2, -2)), b);
  const double ra = two.radii[0] + probe, rb = two.radii[1] + probe;
  const double h = (distance * distance + ra * ra - rb * rb) / (2 * distance);
  const double rho = std::sqrt(ra * ra - h * h);
  const SurfacePatches surface = two.surface();
  ASSERT_EQ(surface.balls.size(), 2u);
  for (const BallPatch& patch : surface.balls) {
    const bool first = patch.ball == 0;
    const double r = first ? two.radii[0] : two.radii[1];
    const double cosine = first ? h / ra : (distance - h) / rb;
    EXPECT_NEAR(area_of(surface, patch), 2 * pi * r * r * (1 + cosine), 2e-3 * r * r);
    EXPECT_EQ(patch.plane_count, 1u);
  }
  double belt = 0;
  for (const TorusPatch& patch : surface.tori) belt += area_of(patch);
  // Angles on the tube from the direction to the axis to both contacts, the cut ones left out.
  const double cut = rho < probe ? std::acos(rho / probe) : 0;
  double expected = 0;
  for (const double contact : {std::atan2(h, rho), std::atan2(distance - h, rho)}) {
    const double from = std::copysign(std::min(cut, std::abs(contact)), contact);
    expected +=
        2 * pi * probe * (rho * (contact - from) - probe * (std::sin(contact) - std::sin(from)));
  }
  EXPECT_NEAR(belt, expected, 1e-6 * expected);
}

TEST(MolecularSurface, TwoBallsHaveTheAreasOfTextbooks) {
  check_two(1, 1, 2, 1.4);
  check_two(1.5, 1, 1.2, 0.7);
  check_two(1, 1, 4.2, 1.4);    // the probe passes through the axis
  check_two(1.7, 0.6, 4, 1.5);  // and here
  check_two(2, 0.5, 1.7, 0.3);  // the circle lies beyond the small ball's centre
}

// Where the two halves of a tube meet, no patch of no extent is left by the rounding of angles.
TEST(MolecularSurface, EqualBallsHaveTwoHalvesOfATube) {
  std::mt19937 random(8);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 200; ++i) {
    Molecule two{"equal", {}, {}, 1.4};
    two.add({0, 0, 0}, 1.7F);
    two.add(2.5F * glm::normalize(glm::vec3(normal(random), normal(random), normal(random))), 1.7F);
    const SurfacePatches surface = two.surface();
    ASSERT_EQ(surface.tori.size(), 2u) << i;
    // Each is as wide as the contact's angle: sin = 1.25 / 3.1.
    for (const auto& patch : surface.tori)
      EXPECT_NEAR(patch.theta_max - patch.theta_min, std::asin(1.25 / 3.1), 1e-6) << i;
  }
}

TEST(MolecularSurface, BallsApartAreSpheres) {
  Molecule two{"apart", {}, {}, 1};
  two.add({0, 0, 0}, 1);
  two.add({4.5, 0, 0}, 1);
  const SurfacePatches surface = two.surface();
  EXPECT_EQ(surface.balls.size(), 2u);
  EXPECT_TRUE(surface.tori.empty() && surface.planes.empty());
}

TEST(MolecularSurface, BallsInsideOthersAndDoublesDoNotCount) {
  Molecule two{"inside", {}, {}, 1};
  two.add({0.5, 0, 0}, 0.25);
  two.add({0, 0, 0}, 1);
  two.add({0, 0, 0}, 1);
  const SurfacePatches surface = two.surface();
  ASSERT_EQ(surface.balls.size(), 1u);
  EXPECT_EQ(surface.balls[0].ball, 1u);
  EXPECT_TRUE(surface.tori.empty() && surface.planes.empty());
}

// A probe that passes exactly between two balls may be held to pass or not.
TEST(MolecularSurface, TouchingBallsKeepTheirAreas) {
  Molecule two{"touching", {}, {}, 1};
  two.add({0, 0, 0}, 1);
  two.add({4, 0, 0}, 1);
  const SurfacePatches surface = two.surface();
  double area = 0;
  for (const TorusPatch& patch : surface.tori) area += area_of(patch);
  for (const BallPatch& patch : surface.balls) area += area_of(surface, patch);
  EXPECT_NEAR(area, 8 * pi, 1e-3);
}

/// Checks that an atom touches the probe where it is nearest to x. The growth of radii of at most 5
/// is below 2e-8.
void check_ball(const Molecule& m, const dvec3& x, const dvec3& probe, std::uint32_t ball) {
  double least = 1e300;
  for (std::size_t i = 0; i < m.centers.size(); ++i) {
    const dvec3 to = dvec3(m.centers[i]) - probe;
    if (std::abs(glm::length(to) - m.probe - m.radii[i]) > 2e-8) continue;
    least = std::min(least, glm::length(x - probe - m.probe * glm::normalize(to)));
  }
  const dvec3 to = dvec3(m.centers[ball]) - probe;
  ASSERT_NEAR(glm::length(to), m.probe + m.radii[ball], 1e-6) << m.name;
  ASSERT_LE(glm::length(x - probe - m.probe * glm::normalize(to)), least + 1e-5) << m.name;
}

// The balls' growth moves a vertex by some 1e-8, over the sines of angles there.
TEST(MolecularSurface, PatchesLieAtTheProbesDistanceFromFreePlaces) {
  Random random(7);
  double worst = 0;
  std::size_t count = 0;
  for (const Molecule& m : general_molecules()) {
    const FreeSpace space(m);
    sample(m.surface(), m.probe, random, 60,
           [&](const dvec3& x, const dvec3& probe, std::uint32_t ball, const Bounds& bounds) {
             const double d = space.distance(x);
             ++count;
             worst = std::max(worst, std::abs(d - m.probe));
             EXPECT_NEAR(d, m.probe, 1e-6) << m.name << ", ball " << ball;
             check_ball(m, x, probe, ball);
             for (int k = 0; k < 3; ++k) {
               ASSERT_GE(x[k], bounds.min[k] - 1e-9) << m.name;
               ASSERT_LE(x[k], bounds.max[k] + 1e-9) << m.name;
             }
           });
    if (HasFailure()) break;
  }
  RecordProperty("points", std::to_string(count));
  RecordProperty("worst", std::to_string(worst * 1e9) + "e-9");
  EXPECT_GT(count, 10000u);
}

// Where places are free only just, they may count or not.
TEST(MolecularSurface, PatchesOfRegularMoleculesLieThereToo) {
  Random random(8);
  for (const Molecule& m : special_molecules()) {
    const FreeSpace most(m, 1e-6), least(m, -1e-6);
    const SurfacePatches surface = m.surface();
    sample(surface, m.probe, random, 60,
           [&](const dvec3& x, const dvec3&, std::uint32_t ball, const Bounds&) {
             EXPECT_LE(most.distance(x), m.probe + 1e-5) << m.name << " " << m.probe << " " << ball;
             EXPECT_GE(least.distance(x), m.probe - 1e-5) << m.name << " " << m.probe;
           });
    EXPECT_FALSE(surface.balls.empty()) << m.name;
    if (HasFailure()) break;
  }
}

struct Line {
  dvec3 origin, direction;
  double length;
  dvec3 at(double t) const { return origin + t * direction; }
};

struct Crossing {
  double t;
  double outward;  // the direction along the outward normal
};

double root(const std::function<double(double)>& f, double a, double b) {
  const bool below = f(a) < 0;
  for (int i = 0; i < 60; ++i) {
    const double middle = (a + b) / 2;
    ((f(middle) < 0) == below ? a : b) = middle;
  }
  return (a + b) / 2;
}

/// Calls found(a, b) for steps of an interval over which f changes its sign.
void sign_changes(const std::function<double(double)>& f, double from, double to, int steps,
                  const std::function<void(double, double)>& found) {
  double last = f(from);
  for (int i = 0; i < steps; ++i) {
    const double a = from + (to - from) * i / steps, b = from + (to - from) * (i + 1) / steps;
    const double value = f(b);
    if ((value < 0) != (last < 0)) found(a, b);
    last = value;
  }
}

void cross_ball(const SurfacePatches& of, const BallPatch& patch, const Line& line, double slack,
                std::vector<Crossing>& out) {
  const dvec3 off = line.origin - patch.center;
  const double b = glm::dot(off, line.direction);
  const double d = b * b - glm::dot(off, off) + patch.radius * patch.radius;
  if (d < 0) return;
  for (const double t : {-b - std::sqrt(d), -b + std::sqrt(d)}) {
    if (!within(of, patch, line.at(t), slack)) continue;
    const double out_of_sphere = glm::dot(line.direction, line.at(t) - patch.center) / patch.radius;
    out.push_back({t, patch.probe ? -out_of_sphere : out_of_sphere});
  }
}

/// The angles of a point near a torus.
bool in_range(const TorusPatch& patch, const dvec3& x, double slack) {
  const dvec3 y = glm::cross(patch.axis, patch.start), off = x - patch.center;
  double phi = std::atan2(glm::dot(off, y), glm::dot(off, patch.start));
  const double r = std::hypot(glm::dot(off, y), glm::dot(off, patch.start));
  double theta = std::atan2(glm::dot(off, patch.axis), r - patch.major);
  if (phi < -slack) phi += 2 * pi;
  if (theta < 0) theta += 2 * pi;
  return phi <= patch.phi_max + slack && theta >= patch.theta_min - slack &&
         theta <= patch.theta_max + slack;
}

void cross_torus(const TorusPatch& patch, const Line& line, double slack,
                 std::vector<Crossing>& out) {
  const auto f = [&](double t) {
    const dvec3 off = line.at(t) - patch.center;
    const double z = glm::dot(off, patch.axis);
    return std::hypot(glm::length(off - z * patch.axis) - patch.major, z) - patch.minor;
  };
  // The part of the line in the patch's box.
  double from = -1e300, to = 1e300;
  for (int k = 0; k < 3; ++k) {
    const double a = (patch.bounds.min[k] - 1e-3 - line.origin[k]) / line.direction[k];
    const double b = (patch.bounds.max[k] + 1e-3 - line.origin[k]) / line.direction[k];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  if (from >= to) return;
  sign_changes(f, from, to, 200, [&](double a, double b) {
    const double t = root(f, a, b);
    if (in_range(patch, line.at(t), slack)) out.push_back({t, (f(t - 1e-6) - f(t + 1e-6)) / 2e-6});
  });
}

std::vector<Crossing> crossings(const SurfacePatches& of, const Line& line, double slack) {
  std::vector<Crossing> all;
  for (const BallPatch& patch : of.balls) cross_ball(of, patch, line, slack, all);
  for (const TorusPatch& patch : of.tori) cross_torus(patch, line, slack, all);
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  return all;
}

Line random_line(const Molecule& m, Random& random) {
  dvec3 min(1e300), max(-1e300);
  for (std::size_t i = 0; i < m.centers.size(); ++i) {
    min = glm::min(min, dvec3(m.centers[i]) - double(m.radii[i]));
    max = glm::max(max, dvec3(m.centers[i]) + double(m.radii[i]));
  }
  const dvec3 d = random_direction(random);
  const dvec3 share(uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1));
  const double reach = glm::length(max - min) + 1;
  return {min + share * (max - min) - reach * d, d, 2 * reach};
}

/// The molecule's boundary on a line, by the definition alone.
std::vector<double> definition(const FreeSpace& space, double probe, const Line& line) {
  std::vector<double> found;
  const auto f = [&](double t) { return space.distance(line.at(t)) - probe; };
  sign_changes(f, 0, line.length, 150, [&](double a, double b) { found.push_back(root(f, a, b)); });
  return found;
}

/// Checks that the molecule begins or ends at a crossing: a step of 1e-4 leads across where the
/// line does not graze.
void check_crossing(const FreeSpace& space, const Molecule& m, const Line& line,
                    const Crossing& crossing) {
  if (std::abs(crossing.outward) < 0.05) return;
  const double before = space.distance(line.at(crossing.t - 1e-4)) - m.probe;
  const double after = space.distance(line.at(crossing.t + 1e-4)) - m.probe;
  EXPECT_EQ((before < 0), (crossing.outward < 0)) << m.name << ": it does not change here";
  EXPECT_EQ(after<0, crossing.outward> 0) << m.name << ": it does not change here";
}

/// Compares both ways; returns how many crossings there are.
std::size_t check_line(const FreeSpace& space, const Molecule& m, const SurfacePatches& surface,
                       const Line& line) {
  const std::vector<Crossing> exact = crossings(surface, line, 0);
  const std::vector<Crossing> wide = crossings(surface, line, 1e-5);
  EXPECT_EQ(exact.size() % 2, 0u) << m.name;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    EXPECT_EQ(exact[i].outward > 0, i % 2 == 1) << m.name << ": in and out do not alternate";
    const bool apart = (i == 0 || exact[i].t - exact[i - 1].t > 3e-4) &&
                       (i + 1 == exact.size() || exact[i + 1].t - exact[i].t > 3e-4);
    if (apart) check_crossing(space, m, line, exact[i]);
  }
  const std::vector<double> expected = definition(space, m.probe, line);
  for (const double t : expected) {
    double nearest = 1e300;
    for (const Crossing& c : wide) nearest = std::min(nearest, std::abs(c.t - t));
    EXPECT_LT(nearest, 1e-5) << m.name << ": the surface has a hole at " << t;
  }
  // Steps can miss two crossings of the line, but find none too many.
  EXPECT_GE(exact.size(), expected.size()) << m.name;
  return exact.size();
}

TEST(MolecularSurface, LinesCrossItWhereTheMoleculeBeginsAndEnds) {
  Random random(9);
  std::size_t count = 0;
  for (const Molecule& m : general_molecules()) {
    const FreeSpace space(m);
    const SurfacePatches surface = m.surface();
    for (int i = 0; i < 40; ++i) count += check_line(space, m, surface, random_line(m, random));
    if (HasFailure()) break;
  }
  RecordProperty("crossings", std::to_string(count));
  EXPECT_GT(count, 2000u);
}

TEST(MolecularSurface, RegularMoleculesAreClosedToo) {
  Random random(10);
  for (const Molecule& m : special_molecules()) {
    const SurfacePatches surface = m.surface();
    for (int i = 0; i < 20; ++i) {
      const std::vector<Crossing> found = crossings(surface, random_line(m, random), 0);
      EXPECT_EQ(found.size() % 2, 0u) << m.name << " " << m.probe;
      for (std::size_t j = 0; j < found.size(); ++j)
        EXPECT_EQ(found[j].outward > 0, j % 2 == 1) << m.name << " " << m.probe;
    }
  }
}

/// A box of points of the patch, and how many there are.
std::pair<Bounds, int> sampled_box(const SurfacePatches& of, const BallPatch& patch) {
  std::pair<Bounds, int> found;
  for (int i = 0; i < 20000; ++i) {
    const double z = 1 - (2 * i + 1.0) / 20000, phi = 2.399963229728653 * i;
    const double r = std::sqrt(1 - z * z);
    const dvec3 x = patch.center + patch.radius * dvec3(r * std::cos(phi), r * std::sin(phi), z);
    if (!within(of, patch, x)) continue;
    found.first.extend(x);
    ++found.second;
  }
  return found;
}

// Neighbours of a spiral's 20000 points on a sphere are about sqrt(4 pi / 20000) = 0.025 radii
// apart. In a corner's tip, none may lie for some times that.
TEST(MolecularSurface, BoundsAreTight) {
  Random random(11);
  int count = 0;
  for (int i = 0; i < 6; ++i) {
    const Molecule m = cloud(random, 12, 2.5, uniform(random, 0.3, 2), "cloud");
    const SurfacePatches surface = m.surface();
    for (const BallPatch& patch : surface.balls) {
      const auto [box, found] = sampled_box(surface, patch);
      if (found < 100) continue;
      ++count;
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(box.min[k], patch.bounds.min[k], 0.1 * patch.radius);
        EXPECT_NEAR(box.max[k], patch.bounds.max[k], 0.1 * patch.radius);
      }
    }
    for (const TorusPatch& patch : surface.tori) {
      Bounds box;
      for (int a = 0; a <= 200; ++a)
        for (int b = 0; b <= 200; ++b)
          box.extend(at(patch, patch.phi_max * a / 200,
                        patch.theta_min + (patch.theta_max - patch.theta_min) * b / 200));
      const double slack = 1e-3 * (patch.major + patch.minor);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(box.min[k], patch.bounds.min[k], slack);
        EXPECT_NEAR(box.max[k], patch.bounds.max[k], slack);
        EXPECT_GE(box.min[k], patch.bounds.min[k] - 1e-12);
        EXPECT_LE(box.max[k], patch.bounds.max[k] + 1e-12);
      }
    }
  }
  EXPECT_GT(count, 50);
}

/// What tells a patch, whatever the order of balls.
using Print = std::array<double, 8>;
std::vector<Print> prints(const SurfacePatches& of, const std::vector<std::uint32_t>& names) {
  std::vector<Print> all;
  for (const BallPatch& p : of.balls)
    all.push_back({double(names[p.ball]), double(p.plane_count), p.center.x, p.center.y, p.center.z,
                   p.bounds.min.x, p.bounds.min.y, p.bounds.max.z});
  for (const TorusPatch& p : of.tori)
    all.push_back({double(names[p.ball]), -p.phi_max, p.center.x, p.center.y, p.center.z,
                   p.theta_max - p.theta_min, p.bounds.min.y, p.bounds.max.z});
  return all;
}

TEST(MolecularSurface, OrderOfBallsDoesNotMatter) {
  Random random(12);
  const Molecule m = cloud(random, 60, 5, 1.4, "cloud");
  std::vector<std::uint32_t> order(m.centers.size()), names(order);
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = names[i] = std::uint32_t(i);
  std::shuffle(order.begin(), order.end(), random);
  Molecule other{"other", {}, {}, m.probe};
  for (const std::uint32_t i : order) other.add(dvec3(m.centers[i]), m.radii[i]);
  const std::vector<Print> a = prints(m.surface(), names), b = prints(other.surface(), order);
  ASSERT_EQ(a.size(), b.size());
  for (const Print& p : a)
    EXPECT_TRUE(std::any_of(b.begin(), b.end(), [&](const Print& q) {
      for (std::size_t k = 0; k < p.size(); ++k)
        if (std::abs(p[k] - q[k]) > 1e-6) return false;
      return true;
    }));
}

TEST(MolecularSurface, TooManyBallsAtOnePlaceAreRefused) {
  std::vector<glm::vec3> centers;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j)
      for (int k = 0; k < 12; ++k) centers.emplace_back(0.01f * glm::vec3(i, j, k));
  const std::vector<float> radii(centers.size(), 1.7f);
  EXPECT_THROW(molecular_surface(centers, radii, 1.4), InputError);
  // As many at the same point are one.
  EXPECT_EQ(molecular_surface(std::vector<glm::vec3>(centers.size()), radii, 1.4).balls.size(), 1u);
}

TEST(MolecularSurface, ThreadsDoNotMatter) {
  Random random(13);
  const Molecule m = cloud(random, 700, 12, 1.4, "cloud");
  const SurfacePatches many = m.surface();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const SurfacePatches alone = m.surface();
  std::vector<std::uint32_t> names(m.centers.size());
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = std::uint32_t(i);
  EXPECT_EQ(prints(many, names), prints(alone, names));
  ASSERT_EQ(many.planes.size(), alone.planes.size());
  for (std::size_t i = 0; i < many.planes.size(); ++i) {
    EXPECT_EQ(many.planes[i].normal, alone.planes[i].normal);
    EXPECT_EQ(many.planes[i].offset, alone.planes[i].offset);
  }
}

}  // namespace
}  // namespace caplet::molecular_surface_test
