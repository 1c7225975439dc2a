// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Surface points on the device: on the surface within the claimed error, inside the box, normals
// and parametrisation against differences, and rays that leave a surface without meeting it again.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "cases.h"
#include "floats.h"
#include "shared/kinds.h"
#include "support/test_device.h"

namespace caplet::test::surface_test {
namespace {

using glm::dvec3;

constexpr double two_pi = 6.283185307179586;

bool is_hit(const Probed& probed) { return probed.hit.slot != CAPLET_NONE; }

class SurfacePoints : public testing::TestWithParam<ShapeKind> {};

// How far (about) one may go from a surface point of a solid or of a curved open shape before the
// normal turns by a radian: the least radius of curvature, the distance from a cone's axis, the
// distance from an edge.
double feature_size(const reference::Primitive& reference, const dvec3& x) {
  const double ball = reference::bounding_ball(reference).radius;
  if (const auto* sphere = std::get_if<reference::Sphere>(&reference)) return sphere->radius;
  if (const auto* sphere = std::get_if<reference::PartialSphere>(&reference)) return sphere->radius;
  if (const auto* cylinder = std::get_if<reference::OpenCylinder>(&reference))
    return cylinder->radius;
  if (const auto* capsule = std::get_if<reference::Capsule>(&reference))
    return std::min(capsule->radius0, capsule->radius1);
  if (const auto* patch = std::get_if<reference::MolecularPatch>(&reference)) {
    if (patch->major == 0) return patch->minor;
    // Its radii of curvature are that of the tube and one that vanishes on the axis.
    return std::min(patch->minor, glm::length(glm::cross(x - patch->center, patch->axis)));
  }
  const reference::SurfaceAt at = reference::surface_at(reference, x);
  if (const auto* s = std::get_if<reference::Frustum>(&reference)) {
    const double across = glm::length(glm::cross(x - s->p0, s->axis));
    const auto end = static_cast<std::size_t>(std::max(at.surface - 1, 0));
    return std::min(at.margin, at.surface == 0      ? across
                               : s->ends[end].round ? s->ends[end].radius
                                                    : ball);
  }
  if (const auto* csg = std::get_if<reference::Csg>(&reference))
    for (const reference::CsgOperand& operand : csg->body->operands) {
      const int surface = at.surface - operand.surface_begin;
      if (surface < 0 || surface >= reference::surface_count(operand.primitive)) continue;
      const dvec3 local = dvec3(operand.operand_from_csg * glm::dvec4(x, 1));
      // An anisotropic map may sharpen curvature by the square of its condition.
      const glm::dmat3 inward(operand.operand_from_csg), outward = glm::inverse(inward);
      double least = 0;
      for (int c = 0; c < 3; ++c) least += glm::dot(outward[c], outward[c]);
      const double condition = operand.stretch * std::sqrt(least);
      return std::min(at.margin, feature_size(operand.primitive, local) /
                                     (operand.stretch * condition * condition));
    }
  return std::min(at.margin, ball);
}

// Molecular patches reach beyond their borders by what depends on the ray: their points are on the
// whole sphere or torus.
reference::Primitive surface_around(const reference::Primitive& reference) {
  return std::holds_alternative<reference::MolecularPatch>(reference)
             ? reference::carrier_of(reference)
             : reference;
}

bool is_flat(const FlatPrimitive& p) {
  return p.shape == shape_triangle || p.shape == shape_disk || p.shape == shape_partial_disk;
}

std::string described(const FlatPrimitive& p) {
  std::string out = fmt::format("shape {}:", p.shape);
  for (const float x : p.data) out += fmt::format(" {:a}", x);
  return out;
}

// How much the normal of a bilinear patch may be off where its point is off by `error`: by the
// rounding of the edges, eps |e| |e| over the area they span there, and by moving over the patch,
// whose tangents change by the twist.
double bilinear_normal_limit(const reference::Bilinear& b, const dvec3& n, double error) {
  const dvec3 twist = b.p11 - b.p01 - b.p10 + b.p00;
  const double u = std::max(glm::length(b.p10 - b.p00), glm::length(b.p11 - b.p01));
  const double v = std::max(glm::length(b.p01 - b.p00), glm::length(b.p11 - b.p10));
  // The least area over the patch bounds the area at the point.
  double area = HUGE_VAL;
  for (const dvec3& du : {b.p10 - b.p00, b.p11 - b.p01})
    for (const dvec3& dv : {b.p01 - b.p00, b.p11 - b.p10})
      area = std::min(area, glm::dot(glm::cross(du, dv), n));
  if (!(area > 0 && area < HUGE_VAL))
    return HUGE_VAL;  // no normal where the patch is a point or a line
  const double moved = error * std::max(u, v) / area;  // in u or v
  const double bend = glm::length(twist);
  return 32 * eps * (u + bend) * (v + bend) / area + 4 * moved * bend * std::max(u, v) / area;
}

TEST_P(SurfacePoints, LieOnTheSurfaceAndInTheBox) {
  CaseMaker maker(41);
  const CaseSet cases = maker.set(GetParam().shape, true, 1000 * test_scale(), 20);
  const Probe probe(test_device(), test_width(), cases.primitives, cases.leaves);
  const auto probed = probe.trace(cases.which, cases.rays);
  double worst = 0;
  int hits = 0, normals = 0;
  for (std::size_t i = 0; i < probed.size(); ++i) {
    if (!is_hit(probed[i])) continue;
    ++hits;
    const SurfaceOut& s = probed[i].surface;
    const FlatPrimitive& p = cases.primitive(i);
    const reference::Primitive& reference = cases.reference(i);
    const dvec3 x = point(s.p), ng = point(s.ng);
    const double distance = std::abs(reference::value(surface_around(reference), x));
    ASSERT_LE(distance, s.error) << i;
    worst = std::max(worst, distance / double(s.error));
    // Molecular patches reach beyond their border by what depends on the ray.
    const double beyond =
        p.shape == shape_molecular_patch ? surface_bound(p, reference, cases.rays[i]) : 0;
    for (int k = 0; k < 3; ++k) {
      ASSERT_GE(double(s.p[k]) + beyond, double(probe.tree(cases.which[i]).min[k])) << i;
      ASSERT_LE(double(s.p[k]) - beyond, double(probe.tree(cases.which[i]).max[k])) << i;
    }
    ASSERT_NEAR(glm::length(ng), 1, 8 * eps);
    ASSERT_EQ(s.primitive, cases.which[i]);
    ASSERT_EQ(s.geometry, cases.which[i]);
    ASSERT_EQ(s.leaving, probed[i].hit.surface >> 16);
    ASSERT_EQ(s.surface, probed[i].hit.surface & CAPLET_SURFACE_MASK);
    ASSERT_LT(static_cast<int>(s.surface), reference::surface_count(reference));
    ASSERT_EQ(s.light, cases.which[i] % 2 == 0 ? CAPLET_NONE : cases.which[i]);
    ASSERT_TRUE(s.u >= 0 && s.u <= 1 && s.v >= 0 && s.v <= 1) << s.u << " " << s.v;
    if (is_flat(p)) {
      // The edges of a triangle are rounded: its normal turns by eps |e1| |e2| / (2 area) at most
      // twice.
      double limit = 4 * eps;
      if (p.shape == shape_triangle) {
        const dvec3 e1 = point(p.data + 3) - point(p.data), e2 = point(p.data + 6) - point(p.data);
        limit = 8 * eps * glm::length(e1) * glm::length(e2) / glm::length(glm::cross(e1, e2));
      }
      ASSERT_LE(glm::length(ng - reference::normal_at(reference, x, 1)), limit) << i;
    } else if (const auto* patch = std::get_if<reference::Bilinear>(&reference)) {
      const dvec3 expected = reference::normal_at(reference, x, 1);
      const double limit = bilinear_normal_limit(*patch, expected, double(s.error));
      if (!(limit < 0.1)) continue;
      ASSERT_LE(glm::length(ng - expected), limit) << i << described(p) << "\nat " << x.x << " "
                                                   << x.y << " " << x.z << " error " << s.error;
    } else {
      // A point that is off by `error` turns the normal by error / radius; central differences over
      // 1e-4 radius have an error of 1e-8.
      const double radius = feature_size(reference, x);
      if (!(double(s.error) <= 0.01 * radius)) continue;
      // On another surface than the hit's the normal is another one.
      if (static_cast<int>(s.surface) != reference::surface_at(reference, x).surface) continue;
      const dvec3 expected = reference::normal_at(reference, x, 1e-4 * radius);
      // The differences themselves are rounded: 2^-52 of the coordinates over the step.
      ASSERT_LE(glm::length(ng - expected),
                4 * double(s.error) / radius + 3e-5 + 0x1p-50 * glm::length(x) / (1e-4 * radius))
          << i;
    }
    ++normals;
  }
  std::printf("%d hits, %d normals, worst %.3f of the claimed error\n", hits, normals, worst);
  EXPECT_GT(hits, 4000);
  EXPECT_GT(normals, hits / 8);
}

// Directions: over the hemisphere around +-ng, every fifth one within 1e-4 of grazing, none so near
// that the rounding of a float's scalar product could change its side.
std::array<float, 3> leaving_direction(CaseMaker& maker, const dvec3& n, bool may_graze) {
  const dvec3 around = maker.direction();
  const dvec3 across = glm::normalize(around - glm::dot(around, n) * n);
  const double height = may_graze && maker.uniform(0, 1) < 0.2
                            ? maker.uniform(1e-6, 1e-4)
                            : maker.uniform(may_graze ? 0 : 1e-3, 1);
  const dvec3 d = std::sqrt(1 - height * height) * across + height * n;
  std::array<float, 3> out{static_cast<float>(d.x), static_cast<float>(d.y),
                           static_cast<float>(d.z)};
  // Rounding must not turn it to the other side.
  if (glm::dot(point(out.data()), n) < 0)
    out = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
  return out;
}

// What a ray that leaves may meet again.
enum class Meets { nothing, itself_elsewhere, its_other_side };
Meets outward_of(int shape) {
  return shape == shape_bilinear || shape == shape_csg || shape == shape_molecular_patch
             ? Meets::itself_elsewhere
             : Meets::nothing;
}
Meets inward_of(int shape, const reference::Primitive& reference) {
  if (shape == shape_csg) return Meets::itself_elsewhere;
  if (reference::is_solid(reference)) return Meets::its_other_side;
  const bool flat = shape == shape_triangle || shape == shape_disk || shape == shape_partial_disk;
  return flat ? Meets::nothing : Meets::itself_elsewhere;
}

void show_if(bool wanted, const FlatPrimitive& p, const Probed& from, const Left& out,
             const std::array<float, 3>& outward, const Left& in,
             const std::array<float, 3>& inward) {
  if (!wanted) return;
  const SurfaceOut& s = from.surface;
  const auto way = [](const Left& left, const std::array<float, 3>& d) {
    return fmt::format("{:a} {:a} {:a}  {:a} {:a} {:a}: {} surface {:x} t {}", left.origin[0],
                       left.origin[1], left.origin[2], d[0], d[1], d[2],
                       left.hit.slot != CAPLET_NONE ? "hit" : "miss", left.hit.surface, left.hit.t);
  };
  ADD_FAILURE() << described(p)
                << fmt::format("\npoint {:a} {:a} {:a} surface {} error {} ng {} {} {}\noutward ",
                               s.p[0], s.p[1], s.p[2], s.surface, s.error, s.ng[0], s.ng[1],
                               s.ng[2])
                << way(out, outward) << "\ninward " << way(in, inward);
}

// `object_from_world`: where the primitives are placed, one a primitive; or empty.
void expect_clean_exits(const Probe& probe, const CaseSet& cases, CaseMaker& maker,
                        const std::vector<glm::dmat4>& object_from_world = {}) {
  const auto probed = probe.trace(cases.which, cases.rays);
  std::vector<std::uint32_t> which;
  std::vector<Probed> from;
  std::vector<std::array<float, 3>> outward, inward;
  for (std::size_t i = 0; i < probed.size(); ++i) {
    if (!is_hit(probed[i])) continue;
    const reference::Primitive& reference = cases.reference(i);
    const int shape = static_cast<int>(cases.primitive(i).shape);
    // Close to an edge a csg shape may lie on both sides.
    if (shape == shape_csg && reference::surface_at(reference, point(probed[i].surface.p)).margin <
                                  1e4 * double(probed[i].surface.error))
      continue;
    which.push_back(cases.which[i]);
    from.push_back(probed[i]);
    outward.push_back(
        leaving_direction(maker, point(probed[i].surface.ng), outward_of(shape) == Meets::nothing));
    inward.push_back(leaving_direction(maker, -point(probed[i].surface.ng),
                                       inward_of(shape, reference) != Meets::itself_elsewhere));
  }
  const auto out = probe.leave(which, from, outward), in = probe.leave(which, from, inward);
  int again = 0, lost = 0, thick = 0, shown = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const int before = again + lost;
    const reference::Primitive& reference = cases.references[which[i]];
    const int shape = static_cast<int>(cases.primitives[which[i]].shape);
    const double error = from[i].surface.error;
    // Surfaces that bend towards the ray are met again, but not at once: it leaves them at 1e-3 or
    // more. Asked where the normal turns less than that over the distance; a placed shape may be
    // bent (3 / 0.2)^2 times as sharply.
    const double sharper = object_from_world.empty() ? 1 : 225;
    const dvec3 p = point(from[i].surface.p);
    const dvec3 local =
        object_from_world.empty() ? p : dvec3(object_from_world[which[i]] * glm::dvec4(p, 1));
    const auto* patch = std::get_if<reference::Bilinear>(&reference);
    const double turn =
        patch ? bilinear_normal_limit(*patch, reference::normal_at(reference, local, 1), 16 * error)
              : 16 * error / feature_size(reference, local);
    const auto again_at_once = [&](const Left& left) {
      return sharper * turn < 1e-3 && left.hit.slot != CAPLET_NONE &&
             double(left.hit.t) < 16 * error;
    };
    again += outward_of(shape) == Meets::nothing ? out[i].hit.slot != CAPLET_NONE
                                                 : again_at_once(out[i]);
    const Meets meets = inward_of(shape, reference);
    if (meets != Meets::its_other_side) {
      again += meets == Meets::nothing ? in[i].hit.slot != CAPLET_NONE : again_at_once(in[i]);
      show_if(again > before && ++shown <= 5, cases.primitives[which[i]], from[i], out[i],
              outward[i], in[i], inward[i]);
      continue;
    }
    // Where the solid is thick enough, from inside the other side of it is the next hit.
    const auto depth = [&](const dvec3& x) {
      if (object_from_world.empty()) return -reference::value(reference, x);
      const glm::dmat4& m = object_from_world[which[i]];
      double stretch = 0;
      for (int c = 0; c < 3; ++c) stretch += glm::dot(dvec3(m[c]), dvec3(m[c]));
      return -reference::value(reference, dvec3(m * glm::dvec4(x, 1))) / std::sqrt(stretch);
    };
    if (depth(point(from[i].surface.p) - 100 * error * point(from[i].surface.ng)) > 50 * error) {
      ++thick;
      lost += !(in[i].hit.slot != CAPLET_NONE && in[i].hit.surface >> 16 == 1);
    }
    show_if(again + lost > before && ++shown <= 5, cases.primitives[which[i]], from[i], out[i],
            outward[i], in[i], inward[i]);
  }
  std::printf("%zu exits, %d hit again; %d inward, %d lost\n", from.size(), again, thick, lost);
  EXPECT_EQ(again, 0);
  EXPECT_EQ(lost, 0);
  EXPECT_GT(from.size(), probed.size() / 5);
}

TEST_P(SurfacePoints, AreLeftForGood) {
  CaseMaker maker(42);
  const CaseSet cases = maker.set(GetParam().shape, true, 2000 * test_scale(), 50);
  expect_clean_exits(Probe(test_device(), test_width(), cases.primitives, cases.leaves), cases,
                     maker);
}

// --- Under affine transforms ---

// Turned inside out, a shape has its normals on the other side and all else as it was.
TEST_P(SurfacePoints, ReversedOrientationTurnsTheNormals) {
  CaseMaker maker(47);
  const CaseSet cases = maker.set(GetParam().shape, false, 100, 20);
  Probe probe(test_device(), test_width(), cases.primitives, cases.leaves);
  const auto plain = probe.trace(cases.which, cases.rays);
  probe.flags = CAPLET_GEOMETRY_FLIP_NORMAL;
  const auto turned = probe.trace(cases.which, cases.rays);
  int hits = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    ASSERT_EQ(is_hit(plain[i]), is_hit(turned[i]));
    if (!is_hit(plain[i])) continue;
    ++hits;
    const SurfaceOut &a = plain[i].surface, &b = turned[i].surface;
    EXPECT_EQ(point(a.p), point(b.p));
    EXPECT_EQ(point(a.ng), -point(b.ng));
    EXPECT_EQ(point(a.ns), -point(b.ns));
    EXPECT_EQ(point(a.dpdu), point(b.dpdu));
    EXPECT_EQ(point(a.dpdv), point(b.dpdv));
    EXPECT_EQ(a.error, b.error);
    EXPECT_EQ(a.leaving, b.leaving);
    // The implicit function still grows outward of the solid.
    if (reference::is_solid(cases.reference(i))) {
      const reference::Primitive& reference = cases.reference(i);
      const double step = 100 * double(a.error);
      if (!(step < 0.5 * feature_size(reference, point(b.p))))
        continue;  // not through to the other side
      EXPECT_LT(reference::value(reference, point(b.p) + step * point(b.ng)),
                reference::value(reference, point(b.p)));
    }
  }
  EXPECT_GT(hits, 400);
}

TEST_P(SurfacePoints, OfInstances) {
  CaseMaker maker(43);
  const PlacedCases placed = placed_cases(maker.set(GetParam().shape, false, 300, 60), 44);
  const Probe probe(test_device(), test_width(), placed.placed, placed.cases.leaves);
  const auto probed = probe.trace(placed.cases.which, placed.cases.rays);
  int hits = 0;
  for (std::size_t i = 0; i < probed.size(); ++i) {
    if (!is_hit(probed[i])) continue;
    ++hits;
    const SurfaceOut& s = probed[i].surface;
    const std::uint32_t which = placed.cases.which[i];
    const reference::Primitive& reference = placed.cases.references[which];
    const glm::dmat4 object_from_world = glm::inverse(placed.world_from_object[which]);
    const dvec3 x = dvec3(object_from_world * glm::dvec4(point(s.p), 1));
    // An object-space distance f along the normal is f |M^T n| in the world.
    const dvec3 n = point(s.ng);
    const double stretch =
        glm::length(glm::transpose(glm::dmat3(placed.world_from_object[which])) * n);
    ASSERT_LE(std::abs(reference::value(surface_around(reference), x)) * stretch, double(s.error))
        << i;
    ASSERT_EQ(s.light, which % 2 == 0 ? CAPLET_NONE : 100 + which + 3);
    // The normal is that of the implicit function of the world point; open shapes' winding is that
    // of object space.
    if (std::holds_alternative<reference::Bilinear>(reference))
      continue;  // far from its object-space normal where it is sharp
    const double radius = is_flat(placed.cases.primitives[which]) ? 1 : feature_size(reference, x);
    if (!(double(s.error) <= 0.01 * radius) ||
        static_cast<int>(s.surface) != reference::surface_at(reference, x).surface)
      continue;
    const dvec3 gradient = reference::normal_at(reference, x, 1e-4 * radius);
    const dvec3 expected = glm::normalize(glm::transpose(glm::dmat3(object_from_world)) * gradient);
    // Condition of the matrices (3 / 0.2) on top of the world-space case.
    ASSERT_LE(glm::length(n - expected), 60 * double(s.error) / radius + 1e-4) << i;
  }
  EXPECT_GT(hits, 4000);
  CaseMaker directions(45);
  std::vector<glm::dmat4> object_from_world;
  for (const glm::dmat4& m : placed.world_from_object) object_from_world.push_back(glm::inverse(m));
  expect_clean_exits(probe, placed.cases, directions, object_from_world);
}

// A step along the surface is dpdu and dpdv times the steps of u and v, up to what the second
// derivatives make of it.
TEST_P(SurfacePoints, DerivativesMatchDifferences) {
  CaseMaker maker(48);
  const CaseSet cases = maker.set(GetParam().shape, false, 200, 20);
  const Probe probe(test_device(), test_width(), cases.primitives, cases.leaves);
  const auto here = probe.trace(cases.which, cases.rays);
  std::vector<std::uint32_t> which;
  std::vector<RayRecord> rays;
  std::vector<std::size_t> from;
  std::vector<double> steps;
  for (std::size_t i = 0; i < here.size(); ++i) {
    if (!is_hit(here[i])) continue;
    const SurfaceOut& s = here[i].surface;
    const dvec3 p = point(s.p), n = point(s.ng), dpdu = point(s.dpdu), dpdv = point(s.dpdv);
    ASSERT_TRUE(std::isfinite(glm::length(dpdu)) && std::isfinite(glm::length(dpdv)));
    const double u_length = glm::length(dpdu), v_length = glm::length(dpdv);
    if (u_length == 0 || v_length == 0) continue;
    // Tangents; next to a pole, where the one across shrinks to nothing, as far as the point's
    // error lets them.
    const double tilt = 1e-4 + 4 * two_pi * double(s.error) / std::min(u_length, v_length);
    if (tilt < 0.1) {
      EXPECT_LE(std::abs(glm::dot(dpdu, n)), tilt * u_length)
          << i << " " << described(cases.primitive(i));
      EXPECT_LE(std::abs(glm::dot(dpdv, n)), tilt * v_length)
          << i << " " << described(cases.primitive(i));
    }
    const auto shape = static_cast<int>(cases.primitive(i).shape);
    const bool flat =
        is_flat(cases.primitive(i)) || shape == shape_box || shape == shape_polyhedron;
    const double step = (flat ? 0.05 : 0.03) *
                        std::min({feature_size(cases.reference(i), p), u_length / 4, v_length / 4});
    for (const dvec3& along : {dpdu, dpdv}) {
      which.push_back(cases.which[i]);
      // From close by, so that no other part of the shape is in the way.
      rays.push_back(make_ray(p + step * glm::normalize(along) + 0.5 * step * n, -n));
      rays.back().t_max = static_cast<float>(step);
      from.push_back(i);
      steps.push_back(step);
    }
  }
  const auto there = probe.trace(which, rays);
  int checked = 0;
  double worst = 0;
  for (std::size_t i = 0; i < there.size(); ++i) {
    const SurfaceOut &a = here[from[i]].surface, &b = there[i].surface;
    if (!is_hit(there[i]) || a.surface != b.surface) continue;
    const double du = double(b.u) - double(a.u), dv = double(b.v) - double(a.v), step = steps[i];
    if (std::abs(du) > 0.5 || std::abs(dv) > 0.5) continue;  // across the seam
    const dvec3 dpdu = point(a.dpdu), dpdv = point(a.dpdv), moved = point(b.p) - point(a.p);
    if (glm::length(moved) > 2 * step) continue;  // over an edge
    // Angles make second derivatives of 2 pi times the first ones, a curved surface ones of 1 /
    // size, at least 33 steps; uv is what floats leave of it.
    const double curvature =
        2 / (33 * step) + two_pi / glm::length(dpdu) + two_pi / glm::length(dpdv);
    double twist = 0;
    if (const auto* patch = std::get_if<reference::Bilinear>(&cases.references[which[i]]))
      twist = std::abs(du * dv) * glm::length(patch->p11 - patch->p01 - patch->p10 + patch->p00);
    const double limit = step * step * curvature + 4 * double(a.error + b.error) +
                         16 * eps * (glm::length(dpdu) + glm::length(dpdv)) + twist;
    const double off = glm::length(moved - du * dpdu - dv * dpdv);
    if (!(limit < 0.2 * step)) continue;
    ++checked;
    worst = std::max(worst, off / limit);
    EXPECT_LE(off, limit) << i << " surface " << a.surface << " step " << step << " du " << du
                          << " dv " << dv << " " << described(cases.primitives[which[i]]);
  }
  std::printf("%d steps, worst %.3f of what is allowed\n", checked, worst);
  EXPECT_GT(checked, 800);
}

INSTANTIATE_TEST_SUITE_P(Kinds, SurfacePoints,
                         testing::ValuesIn(shape_kinds().begin(), shape_kinds().end()),
                         [](const auto& instance) { return std::string(instance.param.name); });

// --- Parametrisation ---

// Traces straight down on the surface at x from outside along n.
Probed at(const Probe& probe, const dvec3& x, const dvec3& n, double away) {
  return probe.trace({0}, {make_ray(x + away * n, -n)})[0];
}

struct Parametrised {
  FlatPrimitive primitive;
  double profile;  // length of the profile from v = 0 to v = 1
};

// uv.x runs along dpdu at 1 / |dpdu|, uv.y does not; across it uv.y runs at 1 / profile, up the
// axis.
TEST(SurfaceParameters, MatchDifferences) {
  const double k = 1.0 / 4, c = std::sqrt(1 - k * k), pi = two_pi / 2;
  const double tapered = 2 * (pi / 2 + std::asin(k)) + 4 * c + 1 * (pi / 2 - std::asin(k));
  const Parametrised shapes[] = {{make_sphere({1, 2, 3}, 2), 2 * pi},
                                 {make_capsule({1, 2, 3}, {2, 0, 5}, 1.5f), 3 + 1.5 * pi},
                                 {make_tapered({0, 0, 0}, {4, 0, 0}, 2, 1), tapered},
                                 {make_disk({1, 2, 3}, {0.6f, 0, 0.8f}, 2), 2}};
  for (const Parametrised& shape : shapes) {
    const Probe probe(test_device(), test_width(), std::vector<FlatPrimitive>{shape.primitive});
    CaseMaker maker(46);
    int checked = 0;
    for (int i = 0; i < 60; ++i) {
      const Probed here =
          probe.trace({0}, {maker.ray(shape.primitive, reference_of(shape.primitive))})[0];
      if (!is_hit(here)) continue;
      const dvec3 x = point(here.surface.p), n = point(here.surface.ng),
                  dpdu = point(here.surface.dpdu);
      const double speed = glm::length(dpdu);
      // Away from the seam and the poles. Steps of 0.01: second differences are 1e-4 relative,
      // rounding 1e-7 / 1e-3.
      if (speed < 3 || here.surface.u < 0.05 || here.surface.u > 0.95) continue;
      EXPECT_NEAR(glm::dot(dpdu, n) / speed, 0, 1e-5);
      constexpr double h = 0.01;
      const dvec3 along = dpdu / speed, up = glm::cross(n, along);
      const Probed before = at(probe, x - h * along, n, 1), after = at(probe, x + h * along, n, 1);
      const Probed below = at(probe, x - h * up, n, 1), above = at(probe, x + h * up, n, 1);
      if (!is_hit(before) || !is_hit(after) || !is_hit(below) || !is_hit(above)) continue;
      EXPECT_NEAR((after.surface.u - before.surface.u) / (2 * h) * speed, 1, 2e-3);
      EXPECT_NEAR(after.surface.v, before.surface.v, 1e-4);
      EXPECT_NEAR(std::abs(above.surface.v - below.surface.v) / (2 * h) * shape.profile, 1, 5e-3);
      EXPECT_NEAR(above.surface.u, below.surface.u, 1e-3);
      ++checked;
    }
    EXPECT_GT(checked, 10);
  }
}

TEST(SurfaceParameters, PolesAndRims) {
  const auto hit = [](const FlatPrimitive& p, const dvec3& o, const dvec3& d) {
    return Probe(test_device(), test_width(), std::vector<FlatPrimitive>{p})
        .trace({0}, {make_ray(o, d)})[0]
        .surface;
  };
  const FlatPrimitive tapered = make_tapered({0, 0, 0}, {4, 0, 0}, 2, 1);
  EXPECT_NEAR(hit(tapered, {-9, 0, 0}, {1, 0, 0}).v, 0, 1e-6);
  EXPECT_NEAR(hit(tapered, {9, 0, 0}, {-1, 0, 0}).v, 1, 1e-6);
  EXPECT_NEAR(hit(make_sphere({0, 0, 0}, 1), {0, 0, 9}, {0, 0, -1}).v, 1, 1e-6);
  EXPECT_NEAR(hit(make_sphere({0, 0, 0}, 1), {0, 9, 0}, {0, -1, 0}).u, 0.25, 1e-6);
  EXPECT_NEAR(hit(make_disk({0, 0, 0}, {0, 0, 1}, 2), {0, 1, 1}, {0, 0, -1}).u, 0.25, 1e-6);
  EXPECT_NEAR(hit(make_disk({0, 0, 0}, {0, 0, 1}, 2), {0, 0.5, 1}, {0, 0, -1}).v, 0.75, 1e-6);
}

TEST(SurfaceParameters, Triangles) {
  const FlatPrimitive triangle = make_triangle({0, 0, 0}, {2, 0, 0}, {0, 4, 0});
  Probe probe(test_device(), test_width(), std::vector<FlatPrimitive>{triangle});
  const std::vector<RayRecord> rays = {
      make_ray({0.5, 2, 1}, {0, 0, -1})};  // barycentric 1/4 1/4 1/2
  const SurfaceOut plain = probe.trace({0}, rays)[0].surface;
  EXPECT_NEAR(plain.u, 0.75, 1e-6);  // vertices at (0 0), (1 0), (1 1)
  EXPECT_NEAR(plain.v, 0.5, 1e-6);
  EXPECT_LT(glm::length(point(plain.dpdu) - dvec3(2, 0, 0)), 1e-6);
  EXPECT_LT(glm::length(point(plain.ng) - dvec3(0, 0, 1)), 1e-6);
  probe.mesh_uvs = {0.5f, 0, 0.5f, 2, 1.5f, 0};  // u along y by 1/4, v along x by 1
  const SurfaceOut own = probe.trace({0}, rays)[0].surface;
  EXPECT_NEAR(own.u, 1, 1e-6);
  EXPECT_NEAR(own.v, 0.5, 1e-6);
  EXPECT_LT(glm::length(point(own.dpdu) - dvec3(0, 4, 0)), 1e-6);
}

}  // namespace
}  // namespace caplet::test::surface_test
