// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Bilinear patches: how they relate to triangles and to their closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "probe.h"
#include "scene_probe.h"
#include "shared/kinds.h"
#include "widths.h"

namespace caplet::test {
namespace {

class PatchWidths : public Widths {};
INSTANTIATE_TEST_SUITE_P(Real, PatchWidths, testing::Values(8, 1));

struct Patch {
  dvec3 p00, p10, p01, p11;
  dvec3 at(double u, double v) const {
    return (1 - u) * (1 - v) * p00 + u * (1 - v) * p10 + (1 - u) * v * p01 + u * v * p11;
  }
  dvec3 du(double v) const { return (1 - v) * (p10 - p00) + v * (p11 - p01); }
  dvec3 dv(double u) const { return (1 - u) * (p01 - p00) + u * (p11 - p10); }
  // The patch's point nearest to x, started from (u, v) near it: Gauss and Newton's steps.
  std::pair<double, double> nearest(double u, double v, const dvec3& x) const {
    for (int i = 0; i < 20; ++i) {
      const dvec3 r = x - at(u, v), a = du(v), b = dv(u);
      const double aa = glm::dot(a, a), ab = glm::dot(a, b), bb = glm::dot(b, b),
                   det = aa * bb - ab * ab;
      if (!(det > 1e-12 * aa * bb)) break;
      u = std::clamp(u + (bb * glm::dot(r, a) - ab * glm::dot(r, b)) / det, 0.0, 1.0);
      v = std::clamp(v + (aa * glm::dot(r, b) - ab * glm::dot(r, a)) / det, 0.0, 1.0);
    }
    return {u, v};
  }
  // How far the line through (u, v) along d must be moved to touch the patch instead: slope^2 / 2
  // over the normal curvature along it.
  double to_fold(double u, double v, const dvec3& d) const {
    const dvec3 a = du(v), b = dv(u), n = glm::normalize(glm::cross(a, b)),
                along = glm::normalize(d);
    const double slope = glm::dot(n, along);
    const dvec3 w = along - slope * n;
    const double aa = glm::dot(a, a), ab = glm::dot(a, b), bb = glm::dot(b, b),
                 det = aa * bb - ab * ab;
    const double s = (bb * glm::dot(w, a) - ab * glm::dot(w, b)) / det,
                 t = (aa * glm::dot(w, b) - ab * glm::dot(w, a)) / det;
    return slope * slope / (4 * std::abs(s * t * glm::dot(p11 - p10 - p01 + p00, n)));
  }
  double size() const { return std::max(glm::length(p11 - p00), glm::length(p10 - p01)); }
  BilinearMeshShape mesh() const {
    return {
        {glm::vec3(p00), glm::vec3(p10), glm::vec3(p01), glm::vec3(p11)}, {{0, 1, 2, 3}}, {}, {}};
  }
};

double off_bound(const Patch& p, const dvec3& o) {
  return 24 * eps * (glm::length(o - p.p00) + 2 * p.size());
}

TEST_P(PatchWidths, FlatPatchesAreTwoTriangles) {
  Random random(10);
  int hits = 0, differ = 0, rays_in_all = 0;
  for (int i = 0; i < 60; ++i) {
    // Convex: the corners of a square, moved by less than a quarter of it, in a plane anywhere.
    const dvec3 o = std::pow(10, random(-1, 3)) * random.point(), s = random.direction();
    const dvec3 t = glm::normalize(glm::cross(s, random.direction()));
    const double width = random(0.1, 5), height = random(0.1, 5);
    const auto corner = [&](double x, double y) {
      const double wobble = i % 3 == 0 ? 0 : 0.24;
      return to_float(o + width * (x + random(-wobble, wobble)) * s +
                      height * (y + random(-wobble, wobble)) * t);
    };
    const Patch patch{corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)};
    TriangleMeshShape mesh;
    mesh.positions = patch.mesh().positions;
    mesh.triangles = {{0, 1, 3}, {0, 3, 2}};
    std::vector<RayRecord> rays;
    for (int j = 0; j < 400; ++j)
      rays.push_back(ray_at(patch.at(random(-0.2, 1.2), random(-0.2, 1.2)), patch.size(), random));
    const auto a = trace(lower_shapes({shape_of(patch.mesh())}), rays, GetParam());
    const auto b = trace(lower_shapes({shape_of(mesh)}), rays, GetParam());
    for (std::size_t j = 0; j < rays.size(); ++j) {
      ++rays_in_all;
      const dvec3 from = vec(&rays[j].ox), d = vec(&rays[j].dx);
      const dvec3 n = glm::normalize(glm::cross(s, t));
      const double slope = std::abs(glm::dot(n, d)) / glm::length(d);
      if (slope < 1e-3) continue;
      // Corners are rounded: the patch and the triangles bulge by that much.
      const double bound = 2 * off_bound(patch, from) + 4 * eps * glm::length(o);
      if (a[j].found != b[j].found) {
        ++differ;
        const SceneHit& hit = a[j].found ? a[j] : b[j];
        const dvec3 x = from + double(hit.t) * d;
        double edge = std::abs(double(hit.t)) * glm::length(d) * slope;  // it may begin there
        const dvec3 around[] = {patch.p00, patch.p10, patch.p11, patch.p01, patch.p00};
        for (int k = 0; k < 4; ++k) {
          const dvec3 along = around[k + 1] - around[k];
          const double s0 = glm::dot(x - around[k], along) / glm::dot(along, along);
          edge = std::min(edge, glm::length(x - around[k] - std::clamp(s0, 0.0, 1.0) * along));
        }
        EXPECT_LE(edge, bound / slope) << i << " " << j;
        continue;
      }
      if (a[j].found == 0) continue;
      ++hits;
      EXPECT_LE(std::abs(double(a[j].t) - double(b[j].t)) * glm::length(d) * slope, bound)
          << i << " " << j;
      EXPECT_EQ(a[j].leaving, b[j].leaving);
    }
  }
  EXPECT_GT(hits, rays_in_all / 4);
  EXPECT_LT(differ, hits / 50);
}

// Twisted patches: a ray aimed at a point of the patch meets it there or before; what it meets is
// on the patch, seen from the right side; and there are no more crossings than the quadratic has.
TEST_P(PatchWidths, TwistedPatches) {
  Random random(11);
  double worst = 0;
  int hits = 0, twice = 0, lost = 0;
  for (int i = 0; i < 150; ++i) {
    const dvec3 o = std::pow(10, random(-1, 3)) * random.point();
    const double scale = std::pow(10, random(-2, 2));
    const auto corner = [&](double x, double y) {
      return to_float(o + scale * (dvec3(x, y, 0) + 0.8 * random.point()));
    };
    const Patch patch{corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)};
    const FlatScene scene = lower_shapes({shape_of(patch.mesh())});
    std::vector<RayRecord> rays;
    std::vector<std::pair<double, double>> aims;
    for (int j = 0; j < 400; ++j) {
      const double u = random(0.01, 0.99), v = random(0.01, 0.99);
      const dvec3 aim = patch.at(u, v);
      aims.emplace_back(u, v);
      rays.push_back(
          from_to(aim + patch.size() * std::pow(10, random(-1, 3)) * random.direction(), aim));
    }
    const auto first = trace(scene, rays, GetParam());
    std::vector<RayRecord> on = rays;
    for (std::size_t j = 0; j < rays.size(); ++j) {
      ASSERT_EQ(first[j].found, first[j].any);
      const dvec3 from = vec(&rays[j].ox), d = vec(&rays[j].dx);
      const double bound = off_bound(patch, from);
      if (first[j].found == 0) {
        // Aimed so near to a fold that the ray is within its bound of passing it.
        EXPECT_LE(patch.to_fold(aims[j].first, aims[j].second, d), 2 * bound) << i << " " << j;
        ++lost;
        continue;
      }
      ++hits;
      ASSERT_LE(glm::length(patch.at(first[j].u, first[j].v) - vec(first[j].p)),
                double(first[j].error));
      const auto [u, v] = patch.nearest(first[j].u, first[j].v, from + double(first[j].t) * d);
      const dvec3 x = from + double(first[j].t) * d, p = patch.at(u, v),
                  n = glm::cross(patch.du(v), patch.dv(u));
      const double distance = glm::length(p - x);
      worst = std::max(worst, distance / bound);
      EXPECT_LE(distance, bound) << i << " " << j;
      const double slope = glm::dot(n, d) / (glm::length(n) * glm::length(d));
      // Within the bound of a fold either side may be seen.
      if (std::abs(slope) > 1e-3 && patch.to_fold(u, v, d) > bound) {
        EXPECT_EQ(first[j].leaving, slope > 0) << i << " " << j;
        EXPECT_LE(first[j].t, 1 + bound / std::abs(slope) / glm::length(d));
        // The surface's own point may have slid along by the rounding of o + t d.
        EXPECT_LE(glm::length(p - vec(first[j].p)),
                  (8 * eps * glm::length(x) + bound) / std::abs(slope))
            << i << " " << j;
      }
      const dvec3 own = glm::cross(patch.du(first[j].v), patch.dv(first[j].u));
      // The edges at (u, v) are off by a few eps of the size.
      EXPECT_LE(glm::length(glm::normalize(own) - vec(first[j].ng)),
                16 * eps * patch.size() * patch.size() / glm::length(own));
      on[j].t_min = std::nextafter(first[j].t, HUGE_VALF);
    }
    const auto second = trace(scene, on, GetParam());
    for (std::size_t j = 0; j < rays.size(); ++j)
      on[j].t_min = second[j].found ? std::nextafter(second[j].t, HUGE_VALF) : on[j].t_min;
    const auto third = trace(scene, on, GetParam());
    for (std::size_t j = 0; j < rays.size(); ++j) {
      if (first[j].found == 0 || second[j].found == 0) continue;
      ++twice;
      EXPECT_NE(first[j].leaving, second[j].leaving) << i << " " << j;
      EXPECT_EQ(third[j].found, 0u);
    }
  }
  std::printf("%d hits, %d twice, %d lost, worst %.3f of the bound\n", hits, twice, lost, worst);
  EXPECT_LE(lost, 100);
  EXPECT_GT(twice, 1000);
}

// Neighbours share their edges: no ray that aims at one, or at a corner, gets through.
TEST_P(PatchWidths, ASheetOfPatchesHasNoCracks) {
  Random random(12);
  for (const dvec3 place : {dvec3(0), dvec3(148376, 1234, -223423)}) {
    constexpr int n = 7;
    BilinearMeshShape mesh;
    std::vector<dvec3> at;
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        mesh.positions.emplace_back(place + dvec3(i, j, 0) +
                                    dvec3(random(-0.2, 0.2), random(-0.2, 0.2), random(-0.5, 0.5)));
        at.push_back(dvec3(mesh.positions.back()));
      }
    for (std::uint32_t j = 0; j < n; ++j)
      for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
        // Parametrised from any corner, either way round.
        const std::array<std::uint32_t, 4> turned[] = {
            {a, b, c, d}, {b, d, a, c}, {d, c, b, a}, {a, c, b, d}};
        mesh.patches.push_back(turned[random.below(4)]);
      }
    std::vector<RayRecord> rays;
    for (int k = 0; k < 60000; ++k) {
      const int i = 1 + random.below(n - 1), j = 1 + random.below(n - 1);
      const dvec3 a = at[static_cast<std::size_t>(j * (n + 1) + i)];
      const dvec3 b = at[static_cast<std::size_t>(random.below(2) == 0 ? j * (n + 1) + i + 1
                                                                       : (j + 1) * (n + 1) + i)];
      const dvec3 aim = glm::mix(a, b, random.below(4) == 0 ? 0.0 : random(0, 0.9));
      rays.push_back(
          from_to(aim + dvec3(random(-0.2, 0.2), random(-0.2, 0.2), random(1, 10)), aim));
    }
    const auto hits = trace(lower_shapes({shape_of(mesh)}), rays, GetParam());
    int lost = 0;
    for (const SceneHit& hit : hits) lost += hit.found == 0;
    EXPECT_EQ(lost, 0);
  }
}

TEST_P(PatchWidths, PatchesHaveTheirMeshsUvsAndNormals) {
  Random random(13);
  const Patch patch{{0, 0, 0}, {2, 0, 0.5}, {0, 1, 0.25}, {2.5, 1.5, -0.5}};
  BilinearMeshShape mesh = patch.mesh();
  mesh.uvs = {{0, 0}, {1, 0.1}, {0.2, 2}, {1.5, 2.5}};
  const auto uv_at = [&](double u, double v) {
    glm::dvec2 sum(0);
    const double w[] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
    for (std::size_t k = 0; k < 4; ++k) sum += w[k] * glm::dvec2(mesh.uvs[k]);
    return sum;
  };
  const auto plain_scene = lower_shapes({shape_of(patch.mesh())}),
             uv_scene = lower_shapes({shape_of(mesh)});
  std::vector<RayRecord> rays;
  for (int i = 0; i < 300; ++i) {
    const dvec3 aim = patch.at(random(0.1, 0.9), random(0.1, 0.9));
    rays.push_back(
        from_to(aim + dvec3(random(-1, 1), random(-1, 1), random.below(2) == 0 ? 3 : -3), aim));
  }
  const auto plain = trace(plain_scene, rays, GetParam()), own = trace(uv_scene, rays, GetParam());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_TRUE(plain[i].found && own[i].found);
    const double u = plain[i].u, v = plain[i].v, h = 1e-4;
    const glm::dvec2 uv = uv_at(u, v);
    EXPECT_NEAR(own[i].u, uv.x, 1e-5);
    EXPECT_NEAR(own[i].v, uv.y, 1e-5);
    EXPECT_LE(glm::length(vec(plain[i].dpdu) - patch.du(v)), 1e-5);
    EXPECT_LE(glm::length(vec(plain[i].dpdv) - patch.dv(u)), 1e-5);
    // A step in (u, v) is a step in the mesh's parameters, times the derivatives by those.
    for (const glm::dvec2 step : {glm::dvec2(h, 0), glm::dvec2(0, h)}) {
      const glm::dvec2 by = uv_at(u + step.x, v + step.y) - uv;
      const dvec3 moved = patch.at(u + step.x, v + step.y) - patch.at(u, v);
      EXPECT_LE(glm::length(by.x * vec(own[i].dpdu) + by.y * vec(own[i].dpdv) - moved),
                1e-4 * h + 1e-5 * h);
    }
  }
  // Normals at the corners say which side is out and bend the shading normal; a mirror turns the
  // winding and the normals with it.
  for (const double side : {1.0, -1.0})
    for (const bool mirrored : {false, true}) {
      BilinearMeshShape bent = mesh;
      bent.normals = {glm::vec3(0.3, 0, side), glm::vec3(-0.3, 0, side), glm::vec3(0, 0.3, side),
                      glm::vec3(0, 0, side)};
      const glm::dmat4 m = glm::scale(glm::dmat4(1), dvec3(mirrored ? -1 : 1, 1, 1));
      std::vector<RayRecord> seen = rays;
      if (mirrored)
        for (RayRecord& ray : seen) ray.ox = -ray.ox, ray.dx = -ray.dx;
      const auto hits = trace(lower_shapes({shape_of(bent, m)}), seen, GetParam());
      const auto bare = trace(lower_shapes({shape_of(patch.mesh(), m)}), seen, GetParam());
      for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(hits[i].found && bare[i].found);
        EXPECT_GT(hits[i].ng[2] * side, 0);
        EXPECT_GT(hits[i].ns[2] * side, 0);
        EXPECT_NEAR(hits[i].u, own[i].u, 1e-5);
        EXPECT_NEAR(hits[i].v, own[i].v, 1e-5);
        EXPECT_GT(bare[i].ng[2],
                  0);  // as pbrt: a mirroring transform turns the normal of the winding back
        EXPECT_EQ(bare[i].leaving, plain[i].leaving != mirrored);
      }
    }
}

}  // namespace
}  // namespace caplet::test
