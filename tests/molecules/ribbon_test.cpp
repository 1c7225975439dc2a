// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Ribbons: the curve, sections and arrow heads of straight ones, and surfaces that are closed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "import/detail/ribbon.h"
#include "surfaces.h"

namespace caplet {
namespace ribbon_test {
namespace {

using glm::dvec3;

constexpr Secondary c = Secondary::coil, h = Secondary::helix, e = Secondary::strand;
constexpr double kStep = 3.8;

/// Guides along x, whose sides are along y.
std::vector<RibbonGuide> straight(const std::vector<Secondary>& kinds) {
  std::vector<RibbonGuide> out;
  for (std::size_t i = 0; i < kinds.size(); ++i)
    out.push_back({{kStep * static_cast<double>(i), 0, 0}, {0, 1, 0}, kinds[i]});
  return out;
}

/// The greatest |y| and |z| of the points at x, in guides. Points of one ring have the same x but
/// for the rounding of floats of at most 64: 2^-18.
struct Extent {
  double least_width = 1e9, width = 0, height = 0;
};
Extent extent_at(const std::vector<TriangleMeshShape>& meshes, double guide) {
  Extent out;
  for (const TriangleMeshShape& mesh : meshes)
    for (std::size_t at = 0; at + 24 <= mesh.positions.size(); at += 24) {  // rings
      if (std::abs(static_cast<double>(mesh.positions[at].x) - kStep * guide) > 0x1p-18) continue;
      Extent of_ring;
      for (std::size_t i = at; i < at + 24; ++i) {
        of_ring.width = std::max(of_ring.width, std::abs(static_cast<double>(mesh.positions[i].y)));
        of_ring.height =
            std::max(of_ring.height, std::abs(static_cast<double>(mesh.positions[i].z)));
      }
      out.least_width = std::min(out.least_width, of_ring.width);
      out.width = std::max(out.width, of_ring.width);
      out.height = std::max(out.height, of_ring.height);
    }
  return out;
}

std::vector<TriangleMeshShape> meshes_of(const std::vector<RibbonGuide>& guides) {
  return ribbon_meshes(guides, {12, 6});
}

// Its conditions: it goes through its points, two derivatives are continuous, and the second is 0
// at the ends. The second derivative is linear between points, so differences of the first are
// exact.
TEST(Splines, AreNaturalCubic) {
  const std::vector<dvec3> points{{0, 0, 0}, {1, 2, 0}, {3, 1, -1}, {4, 4, 4}, {2, 0, 1}};
  const NaturalSpline curve(points);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_LT(glm::length(curve.at(static_cast<double>(i)) - points[i]), 1e-14) << i;
  const double d = 0x1p-10;
  const auto second = [&](double t, double side) {
    // The derivative is quadratic: three of its values give its slope at t.
    return side *
           (-1.5 * curve.derivative(t) + 2.0 * curve.derivative(t + side * d) -
            0.5 * curve.derivative(t + 2 * side * d)) /
           d;
  };
  for (const double t : {1.0, 2.0, 3.0}) {
    EXPECT_LT(glm::length(curve.derivative(t - 1e-13) - curve.derivative(t)), 1e-11) << t;
    EXPECT_LT(glm::length(second(t, -1) - second(t, 1)), 1e-9) << t;  // rounding: 1e-16 * 10 / d
  }
  EXPECT_LT(glm::length(second(0, 1)), 1e-9);
  EXPECT_LT(glm::length(second(4, -1)), 1e-9);
  // The derivative is that of the curve: central differences err by d^2 / 6 times the third.
  for (const double t : {0.3, 1.5, 3.7})
    EXPECT_LT(glm::length((curve.at(t + d) - curve.at(t - d)) / (2 * d) - curve.derivative(t)),
              1e-4)
        << t;
}

// Doubles are rounded to floats: lengths below 8 by 2^-22, which the tolerance 1e-6 covers.
TEST(Ribbons, HaveTheirSections) {
  const auto meshes = meshes_of(straight({c, c, h, h, h, c, e, e, e, c, c}));
  ASSERT_EQ(meshes.size(), 11U);
  for (const double at : {0.0, 0.5, 1.0, 1.5, 4.5, 5.0, 5.5, 8.5, 9.0, 10.0}) {
    EXPECT_NEAR(extent_at(meshes, at).width, 0.28, 1e-6) << at;
    EXPECT_NEAR(extent_at(meshes, at).height, 0.28, 1e-6) << at;
  }
  for (const double at : {2.5, 3.0, 3.5}) {
    EXPECT_NEAR(extent_at(meshes, at).width, 1.25, 1e-6) << at;
    EXPECT_NEAR(extent_at(meshes, at).height, 0.25, 1e-6) << at;
  }
  for (const double at : {6.25, 7.0}) {
    EXPECT_NEAR(extent_at(meshes, at).width, 1.15, 1e-6) << at;
    EXPECT_NEAR(extent_at(meshes, at).height, 0.25, 1e-6) << at;
  }
}

// The head begins where the last residue of the strand does, at 1.9, and is a coil where it ends.
TEST(Ribbons, HaveArrowHeads) {
  const auto meshes = meshes_of(straight({c, e, e, e, c}));
  EXPECT_NEAR(extent_at(meshes, 2.5).least_width, 1.15, 1e-6);
  EXPECT_NEAR(extent_at(meshes, 2.5).width, 1.9, 1e-6);
  EXPECT_NEAR(extent_at(meshes, 2.5).height, 0.29, 1e-6);
  EXPECT_NEAR(extent_at(meshes, 2.75).width, 1.495, 1e-6);  // linear
  EXPECT_NEAR(extent_at(meshes, 3).width, 1.09, 1e-6);
  EXPECT_NEAR(extent_at(meshes, 3.5).width, 0.28, 1e-6);
  // The back of the head looks backward, on a face across the strand.
  std::size_t back = 0;
  for (const glm::vec3& normal : meshes[3].normals) back += normal.x < -0.999F ? 1 : 0;
  EXPECT_EQ(back, 48U);
  // Of one residue, and at the end of the chain.
  EXPECT_NEAR(extent_at(meshes_of(straight({c, e, c})), 0.5).width, 1.9, 1e-6);
  const auto at_end = meshes_of(straight({e, e}));
  EXPECT_NEAR(extent_at(at_end, 0.5).width, 1.9, 1e-6);
  EXPECT_NEAR(extent_at(at_end, 1).width, 0.28, 1e-6);
}

// The side of a head falls from 1.9 to 0.28 within 3.8: its normal leans forward by that slope.
TEST(Ribbons, NormalsAreThoseOfTheTaper) {
  const auto meshes = meshes_of(straight({c, e, e, e, c}));
  const double slope = (1.9 - 0.28) / kStep;
  std::size_t count = 0;
  for (std::size_t at = 0; at + 24 <= meshes[3].positions.size(); at += 24) {
    const double x = static_cast<double>(meshes[3].positions[at].x) / kStep;
    if (x < 2.6 || x > 3.4) continue;
    const dvec3 normal(meshes[3].normals[at]), expected = glm::normalize(dvec3(slope, 1, 0));
    EXPECT_LT(glm::length(normal - expected), 1e-6) << x;
    ++count;
  }
  EXPECT_EQ(count, 9U);
}

// But for arrow heads, sections change by a smooth step: over 0.6 of a residue, with a slope of at
// most 1.5 / 0.6 of the change for each residue; a piece is 1/12 of it.
TEST(Ribbons, ChangeSmoothly) {
  const auto meshes = meshes_of(straight({c, c, h, h, h, c, c}));
  double last = 0.28;
  for (int k = 0; k <= 72; ++k) {
    const double width = extent_at(meshes, k / 12.0).width;
    ASSERT_GT(width, 0.27) << k;
    EXPECT_LE(std::abs(width - last), (1.25 - 0.28) * 1.5 / 0.6 / 12 + 1e-6) << k;
    last = width;
  }
  // Halfway through the change it is halfway.
  EXPECT_NEAR(extent_at(meshes_of(straight({c, h, h, c})), 0.75).width,
              0.28 + 0.97 * (0.25 / 0.6) * (0.25 / 0.6) * (3 - 2 * 0.25 / 0.6), 1e-6);
}

TEST(Ribbons, EndRound) {
  for (const Secondary kind : {c, h}) {
    const auto meshes = meshes_of(straight({kind, kind, kind}));
    double low = 0, high = 0;
    for (const TriangleMeshShape& mesh : meshes)
      for (const glm::vec3& p : mesh.positions) {
        low = std::min(low, static_cast<double>(p.x));
        high = std::max(high, static_cast<double>(p.x));
      }
    const double depth = kind == c ? 0.28 : 0.25;
    EXPECT_NEAR(low, -depth, 1e-6);
    EXPECT_NEAR(high, 2 * kStep + depth, 1e-6);
    // The end of a coil is a half ball, with its normals.
    if (kind == c)
      for (std::size_t i = 0; i < meshes[0].positions.size(); ++i) {
        const dvec3 p(meshes[0].positions[i]), n(meshes[0].normals[i]);
        if (p.x <= 0) {
          EXPECT_LT(glm::length(p - 0.28 * n), 1e-6) << i;
        }
      }
  }
}

// A tube of n-gons has the volume of the prism: n / 2 sin(2 pi / n) r^2 for each length. Of the
// coil's 24 points four pairs are one: n = 20. Each end is rings at heights r sin(a) with radii r
// cos(a), a in steps of 22.5 degrees: frustums.
TEST(Ribbons, OfACoilHaveTheVolumeOfATube) {
  const auto meshes = meshes_of(straight({c, c, c, c}));
  const double area = 20 / 2.0 * std::sin(2 * std::numbers::pi / 20);
  double ends = 0;
  for (int k = 0; k < 4; ++k) {
    const double a = std::numbers::pi / 8 * k, b = std::numbers::pi / 8 * (k + 1), r0 = std::cos(a),
                 r1 = std::cos(b);
    ends += (std::sin(b) - std::sin(a)) * (r0 * r0 + r0 * r1 + r1 * r1) / 3;
  }
  EXPECT_NEAR(test::volume(meshes),
              area * (0.28 * 0.28 * 3 * kStep + 2 * 0.28 * 0.28 * 0.28 * ends), 1e-5);
}

TEST(Ribbons, AreClosedAndLookOutward) {
  for (const auto& kinds : std::vector<std::vector<Secondary>>{
           {c, c}, {h, h}, {e, e}, {c, e, e, c, h, h, h, c}, {h, h, e, e, h}, {e, c, e, h}}) {
    std::vector<RibbonGuide> guides = straight(kinds);
    // A gentle helix, whose bends are wider than the ribbon.
    for (std::size_t i = 0; i < guides.size(); ++i) {
      const double turn = 0.3 * static_cast<double>(i);
      guides[i].place = {6 * std::cos(turn), 6 * std::sin(turn), 2.5 * static_cast<double>(i)};
      guides[i].side = {0.2, 0.1, 1};
    }
    for (const RibbonDetail& detail :
         {RibbonDetail{12, 6}, RibbonDetail{8, 4}, RibbonDetail{4, 3}}) {
      const auto meshes = ribbon_meshes(guides, detail);
      EXPECT_EQ(test::open_edges_of(meshes), 0U);
      EXPECT_EQ(test::unsound_normals(meshes), 0U);
      EXPECT_GT(test::volume(meshes), 0);
      for (const TriangleMeshShape& mesh : meshes)
        EXPECT_LE(mesh.triangles.size(), (2U * detail.pieces + 20U) * 4 * detail.corner_points);
    }
  }
}

// Sides along the curve and of no length, and guides in one place, still make a finite surface.
TEST(Ribbons, OfHardGuidesAreFinite) {
  for (const dvec3& side : {dvec3(1, 0, 0), dvec3(0, 0, 0)}) {
    std::vector<RibbonGuide> guides = straight({h, h, e, e, c});
    for (RibbonGuide& guide : guides) guide.side = side;
    guides[3].place = guides[2].place;
    for (const TriangleMeshShape& mesh : meshes_of(guides)) {
      for (const glm::vec3& p : mesh.positions) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
      for (const glm::vec3& n : mesh.normals) EXPECT_NEAR(glm::length(n), 1, 1e-6);
    }
  }
  for (RibbonGuide guide : {RibbonGuide{{1, 2, 3}, {0, 1, 0}, h}})
    for (const TriangleMeshShape& mesh : meshes_of({guide, guide, guide}))
      for (const glm::vec3& p : mesh.positions) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
}

}  // namespace
}  // namespace ribbon_test
}  // namespace caplet
