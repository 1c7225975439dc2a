// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Boxes, polyhedra, pbrt's partial shapes and bilinear patches: how they relate to each other and
// to their closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

#include "probe.h"
#include "scene_probe.h"
#include "shared/kinds.h"

namespace caplet::test {
namespace {

using glm::dvec3;

constexpr double pi = std::numbers::pi;
constexpr double eps = 0x1p-24;

class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(engine_); }
  dvec3 point() { return {(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)}; }
  dvec3 direction() {
    const double z = (*this)(-1, 1), phi = (*this)(0, 2 * pi), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  std::mt19937 engine_;
};

// Through memory: GCC 12 drops the rounding of a double to float and back where it vectorises it.
dvec3 to_float(const dvec3& x) {
  volatile float rounded[3] = {float(x.x), float(x.y), float(x.z)};
  return {rounded[0], rounded[1], rounded[2]};
}

PolyhedronShape planes_of(const BoxShape& box) {
  const dvec3 low = glm::min(box.p0, box.p1), high = glm::max(box.p0, box.p1);
  return {{low, high, low, high, low, high},
          {{-1, 0, 0}, {2, 0, 0}, {0, -1, 0}, {0, 3, 0}, {0, 0, -1}, {0, 0, 1}}};
}

RayRecord from_to(const dvec3& o, const dvec3& aim) { return make_ray(o, aim - to_float(o)); }

// Where a ray goes, from any side, near or far, along axes with zeros of either sign.
RayRecord ray_at(const dvec3& aim, double size, Random& random) {
  switch (random.below(4)) {
    case 0:
      return from_to(aim + size * random(0, 3) * random.direction(), aim);
    case 1:
      return from_to(aim + size * std::pow(10, random(0, 4)) * random.direction(), aim);
    case 2: {
      dvec3 d(random.below(2) == 0 ? 0.0 : -0.0);
      d[random.below(3)] = random.below(2) == 0 ? 1 : -1;
      return make_ray(aim - random(-1, 3) * size * d, d);
    }
    default:
      return make_ray(aim - random(-1, 3) * size * random.direction(), random.direction());
  }
}

// --- Boxes and polyhedra ---

class Widths : public testing::TestWithParam<int> {};
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

// --- Bilinear patches ---

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

TEST_P(Widths, FlatPatchesAreTwoTriangles) {
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
TEST_P(Widths, TwistedPatches) {
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
TEST_P(Widths, ASheetOfPatchesHasNoCracks) {
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

TEST_P(Widths, PatchesHaveTheirMeshsUvsAndNormals) {
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
