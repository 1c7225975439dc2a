// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Boxes, polyhedra and pbrt's partial shapes: how they relate to each other and to their closed
// forms.
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

PolyhedronShape planes_of(const BoxShape& box) {
  const dvec3 low = glm::min(box.p0, box.p1), high = glm::max(box.p0, box.p1);
  return {{low, high, low, high, low, high},
          {{-1, 0, 0}, {2, 0, 0}, {0, -1, 0}, {0, 3, 0}, {0, 0, -1}, {0, 0, 1}}};
}

// --- Boxes and polyhedra ---

INSTANTIATE_TEST_SUITE_P(Real, Widths, testing::Values(8, 1));

TEST_P(Widths, ABoxIsThePolyhedronOfItsPlanes) {
  Random random(1);
  int hits = 0, rim = 0;
  for (int i = 0; i < 60; ++i) {
    const dvec3 center = std::pow(10, random(-1, 3)) * random.point();
    const dvec3 half(std::pow(10, random(-1, 1)), std::pow(10, random(-1, 1)),
                     std::pow(10, random(-1, 1)));
    const BoxShape box{to_float(center - half), to_float(center + half)};
    const double size = glm::length(half);
    std::vector<RayRecord> rays;
    for (int j = 0; j < 500; ++j)
      rays.push_back(ray_at(center + 1.2 * half * random.point(), size, random));
    const auto a = trace(lower_shapes({shape_of(box)}), rays, GetParam());
    const auto b = trace(lower_shapes({shape_of(planes_of(box))}), rays, GetParam());
    for (std::size_t j = 0; j < rays.size(); ++j) {
      const dvec3 o = vec(&rays[j].ox), d = vec(&rays[j].dx);
      // 16 eps each, in the planes' distance; the surfaces' own points are nearer.
      const double bound = 32 * eps * (glm::length(o - center) + 2 * size);
      // Where both differ the ray passes an edge of the box, or begins on it.
      const auto depth = [&](double grow) {
        double near = -HUGE_VAL, far = HUGE_VAL;
        for (int k = 0; k < 3; ++k) {
          const double low = box.p0[k] - grow - o[k], high = box.p1[k] + grow - o[k];
          if (d[k] == 0) {
            if (low > 0 || high < 0) return -HUGE_VAL;
            continue;
          }
          near = std::max(near, std::min(low / d[k], high / d[k]));
          far = std::min(far, std::max(low / d[k], high / d[k]));
        }
        return far < 0 ? -HUGE_VAL : far - near;
      };
      ASSERT_EQ(a[j].found, a[j].any);
      ASSERT_EQ(b[j].found, b[j].any);
      const dvec3 inside = glm::min(o - box.p0, box.p1 - o);
      const bool begins_there = std::abs(std::min({inside.x, inside.y, inside.z})) <= bound;
      if (a[j].found != b[j].found) {
        EXPECT_TRUE(begins_there || (depth(bound) >= 0 && !(depth(-bound) > 0))) << i << " " << j;
        ++rim;
        continue;
      }
      if (a[j].found == 0) continue;
      ++hits;
      if (begins_there) continue;
      ASSERT_EQ(a[j].leaving, b[j].leaving) << i << " " << j;
      const dvec3 x = o + double(a[j].t) * d, y = o + double(b[j].t) * d;
      if (a[j].surface == b[j].surface) {
        // Both on the same plane, within the bound of it.
        const int axis = static_cast<int>(a[j].surface) / 2;
        const double plane = a[j].surface % 2 == 0 ? box.p0[axis] : box.p1[axis];
        EXPECT_NEAR(x[axis], plane, bound);
        EXPECT_NEAR(y[axis], plane, bound);
        EXPECT_EQ(vec(a[j].ng), vec(b[j].ng));
        EXPECT_LE(glm::length(vec(a[j].p) - vec(b[j].p)),
                  2 * bound + 2 * double(a[j].error) + 2 * double(b[j].error) +
                      std::abs(double(a[j].t) - double(b[j].t)) * glm::length(d));
      } else {
        ++rim;
        for (const dvec3& at : {x, y}) {
          int near = 0;
          for (int k = 0; k < 3; ++k)
            near += std::min(std::abs(at[k] - box.p0[k]), std::abs(at[k] - box.p1[k])) <= 2 * bound;
          EXPECT_GE(near, 2) << i << " " << j;
        }
      }
    }
  }
  EXPECT_GT(hits, 10000);
  EXPECT_LT(rim, 300);
}

TEST_P(Widths, FacesOfBoxesAreSeenFromBothSidesAtTheirPlaces) {
  const BoxShape box{{1, 2, 3}, {4, 6, 8}};
  const FlatScene scene = lower_shapes({shape_of(box)});
  const dvec3 center = 0.5 * (box.p0 + box.p1);
  std::vector<RayRecord> rays;
  for (int face = 0; face < 6; ++face) {
    dvec3 out(0.0);
    out[face / 2] = face % 2 == 0 ? -1 : 1;
    rays.push_back(make_ray(center + 10.0 * out, -out));
    rays.push_back(make_ray(center, out));
  }
  const auto hits = trace(scene, rays, GetParam());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::size_t face = i / 2;
    ASSERT_EQ(hits[i].found, 1u);
    EXPECT_EQ(hits[i].surface, face);
    EXPECT_EQ(hits[i].leaving, i % 2);
    EXPECT_EQ(vec(hits[i].p)[int(face) / 2],
              face % 2 == 0 ? box.p0[int(face) / 2] : box.p1[int(face) / 2]);
    EXPECT_EQ(glm::cross(glm::normalize(vec(hits[i].dpdu)), glm::normalize(vec(hits[i].dpdv))),
              vec(hits[i].ng));
    EXPECT_NEAR(hits[i].u, 0.5, 1e-6);
    EXPECT_NEAR(hits[i].v, 0.5, 1e-6);
  }
}

// Rays in the plane of a face, with zeros of both signs: the box is closed.
TEST_P(Widths, RaysInAFaceHitTheBox) {
  const BoxShape box{{1, 2, 3}, {4, 6, 8}};
  const FlatScene scene = lower_shapes({shape_of(box)});
  std::vector<RayRecord> rays;
  for (const double y : {2.0, 6.0})
    for (const float zero : {0.f, -0.f}) {
      RayRecord ray = make_ray({-3, y, 5}, {1, 0, 0});
      ray.dy = ray.dz = zero;
      rays.push_back(ray);
      ray.oz = 8;  // an edge
      rays.push_back(ray);
    }
  const auto inside = rays.size();
  for (const double y : {std::nextafter(2.f, 0.f), std::nextafter(6.f, 9.f)})
    rays.push_back(make_ray({-3, y, 5}, {1, 0, 0}));
  const auto hits = trace(scene, rays, GetParam());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(hits[i].found, i < inside) << i;
    if (i < inside) {
      EXPECT_EQ(hits[i].t, 4.f);
    }
  }
}

TEST_P(Widths, TouchingBoxesAreLeftAndEnteredAtTheSameT) {
  Random random(2);
  int both = 0;
  for (int i = 0; i < 40; ++i) {
    const dvec3 o = to_float(std::pow(10, random(0, 4)) * random.point());
    const double between = o.x + 1 / 3.0;
    const BoxShape left{o - dvec3(1), {between, o.y + 1, o.z + 1}},
        right{{between, o.y - 1, o.z - 1}, o + dvec3(1)};
    std::vector<RayRecord> rays;
    for (int j = 0; j < 300; ++j) {
      const dvec3 d = random.direction();
      rays.push_back(make_ray(o, {std::abs(d.x), d.y, d.z}));
    }
    const auto out = trace(lower_shapes({shape_of(left)}), rays, GetParam());
    const auto in = trace(lower_shapes({shape_of(right)}), rays, GetParam());
    for (std::size_t j = 0; j < rays.size(); ++j) {
      ASSERT_EQ(out[j].found, 1u);
      ASSERT_EQ(out[j].leaving, 1u);
      if (out[j].surface != 1) continue;
      ASSERT_EQ(in[j].found, 1u) << i << " " << j;
      EXPECT_EQ(in[j].surface, 0u);
      EXPECT_EQ(in[j].leaving, 0u);
      EXPECT_EQ(in[j].t, out[j].t);
      ++both;
    }
  }
  EXPECT_GT(both, 3000);
}

PolyhedronShape icosahedron(const dvec3& center, double radius) {
  PolyhedronShape out;
  const double a = (1 + std::sqrt(5)) / 2, b = 1 / a;
  const auto add = [&](const dvec3& n) {
    out.normals.push_back(n);
    out.points.push_back(center + radius * glm::normalize(n));
  };
  for (int i = 0; i < 8; ++i) add({i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
  for (int i = 0; i < 4; ++i) {
    const double s = i & 1 ? 1 : -1, t = i & 2 ? 1 : -1;
    add({0, s * b, t * a});
    add({s * b, t * a, 0});
    add({s * a, 0, t * b});
  }
  return out;
}

// Aimed at edges and corners from outside and from inside, displaced inward by more than the bound,
// far from the origin.
TEST_P(Widths, NothingSlipsThroughEdgesFarFromTheOrigin) {
  const dvec3 place(148376, 1234, -223423);
  Random random(3);
  for (const bool is_box : {true, false}) {
    const BoxShape box{place - dvec3(3, 4, 5), place + dvec3(3, 4, 5)};
    const PolyhedronShape solid = is_box ? planes_of(box) : icosahedron(place, 4);
    const auto faces = polyhedron_faces(solid);
    const auto corners = polyhedron_corners(solid);
    ASSERT_EQ(corners.size(), is_box ? 8u : 12u);
    const FlatScene scene = lower_shapes({is_box ? shape_of(box) : shape_of(solid)});
    std::vector<RayRecord> rays;
    for (int i = 0; i < 40000; ++i) {
      const auto& face =
          faces[static_cast<std::size_t>(random.below(static_cast<int>(faces.size())))];
      const auto at = static_cast<std::size_t>(random.below(static_cast<int>(face.size())));
      const dvec3 edge = glm::mix(face[at], face[(at + 1) % face.size()],
                                  random.below(4) == 0 ? 0.0 : random(0, 1));
      const bool inside = i % 2 == 0;
      const dvec3 o = to_float(place + (inside ? 1.0 : random(10, 100)) * random.direction());
      // The solid as stored: planes 0.5 ulp of the coordinates (0.008) off. Then the bound 16 eps
      // (|o - c| + size).
      const double depth = 0.03 + 16 * eps * (glm::length(o - place) + 8);
      const dvec3 aim = edge + depth * 3.0 * glm::normalize(place - edge);
      rays.push_back(from_to(o, aim));
    }
    const auto hits = trace(scene, rays, GetParam());
    int lost = 0, wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      lost += hits[i].found == 0;
      wrong += hits[i].found && hits[i].leaving != (i % 2 == 0);
    }
    EXPECT_EQ(lost, 0);
    EXPECT_EQ(wrong, 0);
  }
}

// A wall of touching boxes: whatever the ray aims at, grid lines above all, some box stops it.
TEST_P(Widths, AWallOfBoxesHasNoCracks) {
  const dvec3 place(148376, 1234, -223423);
  Random random(4);
  std::vector<Shape> shapes;
  constexpr int n = 6;
  const auto corner = [&](int i, int j, int k) { return place + dvec3(i / 3.0, j / 3.0, k / 3.0); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      shapes.push_back(shape_of(BoxShape{corner(i, j, 0), corner(i + 1, j + 1, 1)}));
  std::vector<RayRecord> rays;
  for (int i = 0; i < 60000; ++i) {
    dvec3 aim =
        place + dvec3(random(0.1, n / 3.0 - 0.1), random(0.1, n / 3.0 - 0.1), random(0, 0.3));
    const int k = random.below(3);
    if (k < 2)
      aim[k] = double(float(corner(1 + random.below(n - 1), 1 + random.below(n - 1), 0)[k]));
    rays.push_back(
        from_to(aim + dvec3(random(-0.05, 0.05), random(-0.05, 0.05), random(2, 20)), aim));
  }
  const auto hits = trace(lower_shapes(shapes), rays, GetParam());
  int lost = 0;
  for (const SceneHit& hit : hits) lost += hit.found == 0;
  EXPECT_EQ(lost, 0);
}

// Scales along the axes are part of the box; anything else places it as an instance. All are the
// polyhedron under the same matrix.
TEST_P(Widths, BoxesUnderTransforms) {
  Random random(5);
  const BoxShape box{{-1, -2, -0.5}, {2, 1, 3}};
  const glm::dmat4 identity(1);
  struct Case {
    glm::dmat4 m;
    bool baked;
  };
  const dvec3 shift(3, -4, 5), scale(2, 0.5, 3);
  const Case cases[] = {{glm::scale(glm::translate(identity, shift), scale), true},
                        {glm::scale(identity, dvec3(1, -1, 1)), false},
                        {glm::rotate(glm::translate(identity, shift), 1.0, dvec3(1, 2, 3)), false},
                        {glm::rotate(glm::scale(identity, scale), 0.7, dvec3(0, 0, 1)), false}};
  for (const Case& one : cases) {
    const FlatScene placed = lower_shapes({shape_of(box, one.m)}),
                    planes = lower_shapes({shape_of(planes_of(box), one.m)});
    EXPECT_EQ(placed.instances.size(), one.baked ? 0u : 1u);
    EXPECT_EQ(planes.instances.size(), 0u);
    std::vector<RayRecord> rays;
    for (int i = 0; i < 3000; ++i)
      rays.push_back(ray_at(
          dvec3(one.m * glm::dvec4(dvec3(0.5, -0.5, 1.25) + 2.0 * random.point(), 1)), 5, random));
    const auto a = trace(placed, rays, GetParam()), b = trace(planes, rays, GetParam());
    int hits = 0, differ = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const double reach = glm::length(vec(&rays[i].ox)) + 20;
      if (a[i].found != b[i].found || (a[i].found && a[i].surface != b[i].surface)) {
        ++differ;
        continue;
      }
      if (a[i].found == 0) continue;
      ++hits;
      const dvec3 o = vec(&rays[i].ox), d = vec(&rays[i].dx);
      // Both are within the bound of the same plane, which the ray meets at this slope.
      const double slope = std::abs(glm::dot(vec(b[i].ng), d));
      EXPECT_LE(std::abs(double(a[i].t) - double(b[i].t)) * slope, 200 * eps * reach);
      EXPECT_EQ(a[i].leaving, b[i].leaving);
      EXPECT_LE(glm::length(vec(a[i].ng) - vec(b[i].ng)), 1e-6);
      EXPECT_LE(glm::length(vec(a[i].p) - (o + double(a[i].t) * d)), 1e-5 * reach);
    }
    EXPECT_GT(hits, 1000);
    EXPECT_LT(differ, 30);  // edges
  }
}

// --- Partial shapes ---

struct Clips {
  double z_min, z_max, phi_max;
};

double angle_of(double x, double y) {
  const double phi = std::atan2(y, x);
  return phi < 0 ? phi + 2 * pi : phi;
}

// Distance that (x, y, z) must be moved to change sides of a clip, with a sign: inside positive.
double within(const Clips& c, double radius, const dvec3& x) {
  double room = HUGE_VAL;
  if (c.z_min > -radius) room = std::min(room, x.z - c.z_min);
  if (c.z_max < radius) room = std::min(room, c.z_max - x.z);
  const double rho = std::hypot(x.x, x.y), phi = angle_of(x.x, x.y);
  if (c.phi_max < 2 * pi) {
    const auto chord = [&](double angle) { return 2 * rho * std::abs(std::sin(0.5 * angle)); };
    const double edge = std::min(chord(phi), chord(phi - c.phi_max));
    room = std::min(room, phi <= c.phi_max ? edge : -edge);
  }
  return room;
}

const Clips clips[] = {{-2, 2, 2 * pi},      {-0.7, 1.1, 2 * pi}, {-2, 0.3, 0.25 * pi},
                       {-0.2, 2, 0.5 * pi},  {-2, 2, pi},         {-1, 1, 1.25 * pi},
                       {0.1, 0.2, 1.9 * pi}, {-1.5, -1.2, 0.01},  {-0.5, 1.5, 1.5 * pi}};

// Rays and what must be hit, from the closed form in double; rays that pass a clip within the bound
// are not judged.
void expect_clipped(const FlatScene& scene, int width, const std::vector<RayRecord>& rays,
                    double size,
                    const std::function<std::vector<double>(const dvec3&, const dvec3&)>& crossings,
                    const std::function<double(const dvec3&)>& room,
                    const std::function<dvec3(const dvec3&)>& normal) {
  const auto hits = trace(scene, rays, width);
  int found = 0, missed = 0, second = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const dvec3 o = vec(&rays[i].ox), d = vec(&rays[i].dx);
    const double bound = 24 * eps * (glm::length(o) + size);
    bool judged = true;
    double expected = HUGE_VAL;
    int order = 0, which = 0;
    for (const double t : crossings(o, d)) {
      const dvec3 x = o + t * d;
      ++order;
      // Along the surface the ray may be `bound` over the slope of the ray to it away.
      const double slope = std::abs(glm::dot(normal(x), d)) / glm::length(d);
      judged &= std::abs(room(x)) > bound / slope && slope > 1e-3 &&
                std::abs(t) * glm::length(d) > bound / slope;
      if (room(x) > 0 && t > 0 && t < expected) {
        expected = t;
        which = order;
      }
    }
    if (!judged) continue;
    ASSERT_EQ(hits[i].found, expected < HUGE_VAL) << i;
    ASSERT_EQ(hits[i].any, hits[i].found);
    if (hits[i].found == 0) {
      ++missed;
      continue;
    }
    ++found;
    second += which == 2;
    const dvec3 x = o + expected * d;
    EXPECT_NEAR(hits[i].t, expected, 1e3 * bound / glm::length(d)) << i;
    EXPECT_EQ(hits[i].leaving, glm::dot(normal(x), d) > 0) << i;
    EXPECT_LE(glm::length(vec(hits[i].ng) - normal(x)), 1e-2);
  }
  EXPECT_GE(found, 5);
  EXPECT_GT(missed, 100);
  const bool two = crossings(dvec3(0, 0, 0.1), dvec3(1, 1, 0)).size() == 2;
  EXPECT_GE(second, two ? 3 : 0);
}

std::vector<double> sphere_crossings(double r, const dvec3& o, const dvec3& d) {
  const double dd = glm::dot(d, d), middle = -glm::dot(o, d) / dd;
  const dvec3 q = o + middle * d;
  const double disc = r * r - glm::dot(q, q);
  if (disc < 0) return {};
  return {middle - std::sqrt(disc / dd), middle + std::sqrt(disc / dd)};
}

std::vector<RayRecord> rays_around(double size, int n, Random& random) {
  std::vector<RayRecord> rays;
  for (int i = 0; i < n; ++i) rays.push_back(ray_at(size * random.point(), size, random));
  return rays;
}

TEST_P(Widths, PartialSpheres) {
  Random random(6);
  for (const Clips& clip : clips) {
    const double r = 1.5;
    const Clips c{double(float(std::max(clip.z_min, -r))), double(float(std::min(clip.z_max, r))),
                  double(float(clip.phi_max))};
    const FlatScene scene =
        lower_shapes({shape_of(PartialSphereShape{r, c.z_min, c.z_max, c.phi_max})});
    expect_clipped(
        scene, GetParam(), rays_around(2, c.phi_max < 0.1 ? 200000 : 3000, random), r,
        [&](const dvec3& o, const dvec3& d) { return sphere_crossings(r, o, d); },
        [&](const dvec3& x) { return within(c, r, x); },
        [&](const dvec3& x) { return glm::normalize(x); });
  }
}

TEST_P(Widths, OpenCylinders) {
  Random random(7);
  for (const Clips& clip : clips) {
    const double r = 0.75;
    const Clips c{double(float(clip.z_min)), double(float(clip.z_max)),
                  double(float(clip.phi_max))};
    const FlatScene scene =
        lower_shapes({shape_of(OpenCylinderShape{r, c.z_min, c.z_max, c.phi_max})});
    expect_clipped(
        scene, GetParam(), rays_around(2, c.phi_max < 0.1 ? 200000 : 3000, random), 2.2,
        [&](const dvec3& o, const dvec3& d) {
          if (d.x == 0 && d.y == 0) return std::vector<double>{};
          return sphere_crossings(r, {o.x, o.y, 0}, {d.x, d.y, 0});
        },
        [&](const dvec3& x) { return within(c, HUGE_VAL, x); },
        [&](const dvec3& x) { return glm::normalize(dvec3(x.x, x.y, 0)); });
  }
}

TEST_P(Widths, PartialDisks) {
  Random random(8);
  for (const Clips& clip : clips)
    for (const double inner : {0.0, 0.5}) {
      const double r = 1.25, height = double(float(0.3));
      if (inner == 0 && clip.phi_max >= 2 * pi) continue;  // whole
      const Clips c{-1, 1, double(float(clip.phi_max))};
      const FlatScene scene = lower_shapes({shape_of(DiskShape{height, r, inner, c.phi_max})});
      expect_clipped(
          scene, GetParam(), rays_around(2, c.phi_max < 0.1 ? 200000 : 3000, random), 2,
          [&](const dvec3& o, const dvec3& d) {
            return d.z == 0 ? std::vector<double>{} : std::vector<double>{(height - o.z) / d.z};
          },
          [&](const dvec3& x) {
            const double rho = std::hypot(x.x, x.y);
            return std::min(
                {within(c, 0.1, {x.x, x.y, 0}), r - rho, inner > 0 ? rho - inner : HUGE_VAL});
          },
          [&](const dvec3&) { return dvec3(0, 0, 1); });
    }
}

// p(u, v) of pbrt's parametrisations gives the point back; dpdu and dpdv are its differences, and
// span the tangent plane outward.
TEST_P(Widths, PartialShapesHavePbrtsParameters) {
  Random random(9);
  const double r = 1.5, z0 = -0.75, z1 = 1.25, phi = double(float(4.2)), inner = 0.25;
  const double theta0 = std::acos(z0 / r), theta1 = std::acos(z1 / r);
  struct Case {
    Shape shape;
    std::function<dvec3(double, double)> at;
  };
  const Case cases[] = {{shape_of(PartialSphereShape{r, z0, z1, phi}),
                         [&](double u, double v) {
                           const double theta = theta0 + v * (theta1 - theta0);
                           return r * dvec3(std::sin(theta) * std::cos(u * phi),
                                            std::sin(theta) * std::sin(u * phi), std::cos(theta));
                         }},
                        {shape_of(OpenCylinderShape{r, z0, z1, phi}),
                         [&](double u, double v) {
                           return dvec3(r * std::cos(u * phi), r * std::sin(u * phi),
                                        z0 + v * (z1 - z0));
                         }},
                        {shape_of(DiskShape{0.5, r, inner, phi}), [&](double u, double v) {
                           const double rho = r - v * (r - inner);
                           return dvec3(rho * std::cos(u * phi), rho * std::sin(u * phi), 0.5);
                         }}};
  for (const Case& one : cases) {
    const auto hits = trace(lower_shapes({one.shape}), rays_around(2, 2000, random), GetParam());
    int found = 0;
    for (const SceneHit& hit : hits) {
      if (hit.found == 0) continue;
      ++found;
      const double u = hit.u, v = hit.v, h = 1e-5;
      ASSERT_TRUE(u >= 0 && u <= 1 && v >= 0 && v <= 1);
      EXPECT_LE(glm::length(one.at(u, v) - vec(hit.p)), 3e-6);
      const dvec3 du = (one.at(u + h, v) - one.at(u - h, v)) / (2 * h),
                  dv = (one.at(u, v + h) - one.at(u, v - h)) / (2 * h);
      EXPECT_LE(glm::length(du - vec(hit.dpdu)), 2e-5);
      EXPECT_LE(glm::length(dv - vec(hit.dpdv)), 2e-5);
      EXPECT_LE(glm::length(glm::normalize(glm::cross(du, dv)) - vec(hit.ng)), 2e-6);
    }
    EXPECT_GT(found, 200);
  }
}

}  // namespace
}  // namespace caplet::test
