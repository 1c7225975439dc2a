// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The power of area lights: what a light emits, radiance x pi x area x sides, must be what its file
// asks for, however its shape is stretched. Areas here are the test's own.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "lower/lower.h"
#include "scene/scene.h"

namespace caplet::test::power_test {

namespace {

using glm::dvec3;

using std::numbers::pi;

/// A solid's point furthest along a direction (of any length).
using Extreme = std::function<dvec3(const dvec3&)>;

Extreme ball(const dvec3& center, double radius) {
  return [=](const dvec3& u) { return center + radius * glm::normalize(u); };
}
Extreme disk(const dvec3& center, const dvec3& axis, double radius) {
  return [=](const dvec3& u) {
    const dvec3 n = glm::normalize(axis), across = u - glm::dot(u, n) * n;
    return center + radius * across / std::max(glm::length(across), 1e-300);
  };
}
Extreme hull(const Extreme& a, const Extreme& b) {
  return [=](const dvec3& u) {
    const dvec3 x = a(u), y = b(u);
    return glm::dot(x, u) >= glm::dot(y, u) ? x : y;
  };
}

/// Area of the image of a convex solid. With h(u) the support function and x(u) the furthest point,
/// h = x . u and grad h = x, so that the surface's area, the integral over the sphere of h^2 -
/// |grad_S h|^2 / 2 (Minkowski; by parts, so corners are allowed), is that of 3/2 (x . u)^2 - x^2
/// / 2. The image's point is M x(M^T u). Summed over 2 million even directions: kinks leave 1e-6 or
/// so.
double convex_area(const Extreme& extreme, const glm::dmat4& m) {
  const glm::dmat3 a(m);
  constexpr int n = 500000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double z = 1 - (2 * i + 1.0) / n, phi = i * pi * (3 - std::sqrt(5.0)),
                 r = std::sqrt(1 - z * z);
    const dvec3 u(r * std::cos(phi), r * std::sin(phi), z), x = a * extreme(glm::transpose(a) * u);
    sum += 1.5 * glm::dot(x, u) * glm::dot(x, u) - 0.5 * glm::dot(x, x);
  }
  return sum * 4 * pi / n;
}

/// Area of the image of a parametrised surface: 2 x 10^6 triangles, right to 1e-6 of it.
double sheet_area(const std::function<dvec3(double, double)>& map, const glm::dmat4& m) {
  const glm::dmat3 a(m);
  constexpr int n = 1000;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const auto at = [&](int s, int t) { return a * map(double(i + s) / n, double(j + t) / n); };
      const dvec3 p = at(0, 0), q = at(1, 1);
      sum += 0.5 * (glm::length(glm::cross(at(1, 0) - p, q - p)) +
                    glm::length(glm::cross(q - p, at(0, 1) - p)));
    }
  return sum;
}

/// What all lights of the scene emit. RGB (1 1 1) is a radiance of 1, as is a constant spectrum.
double emitted(const Scene& scene, double area, double sides) {
  const FlatScene flat = lower(scene);
  return flat.lights.at(0).scale * pi * area * sides;
}

Scene scene_of(const decltype(Shape::geometry)& geometry, const glm::dmat4& m) {
  Scene scene;
  scene.materials.emplace_back();
  Shape shape;
  shape.geometry = geometry;
  shape.world_from_object = m;
  shape.emission = AreaEmission{};
  shape.emission->power = 60;
  scene.shapes = {shape};
  return scene;
}

/// The same shape within an object, so that the instance stretches it.
Scene instanced(Scene scene, const glm::dmat4& m) {
  Object object;
  object.shapes = scene.shapes;
  object.shapes[0].world_from_object = glm::dmat4(1);
  scene.shapes.clear();
  scene.objects = {object};
  Instance instance;
  instance.world_from_object = m;
  scene.instances = {instance};
  return scene;
}

glm::dmat4 stretched(double x, double y, double z) {
  return glm::scale(glm::rotate(glm::dmat4(1), 0.4, dvec3(1, 2, 3)), dvec3(x, y, z));
}
glm::dmat4 sheared() {
  glm::dmat4 m = stretched(1, 3, 0.5);
  m[1] += 0.7 * m[0];
  m[3] = glm::dvec4(1, 2, 3, 1);
  return m;
}
std::vector<glm::dmat4> transforms() {
  return {glm::dmat4(1), stretched(2, 2, 2), stretched(1, 1, 10), stretched(4, -1, 1), sheared()};
}

// Shape data and radiances are floats: 1e-6 of the area and of the scale, and the sums above.
constexpr double tolerance = 1e-5;

void check(const std::string& name, double slack, const decltype(Shape::geometry)& geometry,
           const std::function<double(const glm::dmat4&)>& area) {
  int number = 0;
  for (const glm::dmat4& m : transforms()) {
    const double real = area(m);
    EXPECT_NEAR(emitted(scene_of(geometry, m), real, 1), 60, 60 * slack) << name << ' ' << number;
    EXPECT_NEAR(emitted(instanced(scene_of(geometry, m), m), real, 1), 60, 60 * slack)
        << name << " instanced " << number;
    ++number;
  }
}

CapsulesShape capsule(double r0, double r1) {
  CapsulesShape shape;
  shape.p0 = {{-0.125f, -0.125f, -0.75f}};
  shape.p1 = {{0.125f, 0.125f, 0.75f}};
  shape.radius0 = {static_cast<float>(r0)};
  shape.radius1 = {static_cast<float>(r1)};
  return shape;
}

}  // namespace

// The surface of a spheroid in closed form, here of half axes 1, 1, c.
TEST(LightPower, OfASpheroid) {
  const auto area = [](double c) {
    if (c > 1) {
      const double e = std::sqrt(1 - 1 / (c * c));
      return 2 * pi * (1 + c / e * std::asin(e));
    }
    const double e = std::sqrt(1 - c * c);
    return 2 * pi * (1 + c * c / e * std::atanh(e));
  };
  for (const double c : {1e-3, 0.1, 0.9, 3.0, 10.0, 1000.0}) {
    Scene scene = scene_of(SphereShape{1}, glm::scale(glm::dmat4(1), dvec3(1, 1, c)));
    EXPECT_NEAR(emitted(scene, area(c), 1), 60, 60 * 2e-5) << c;
  }
}

TEST(LightPower, OfSolids) {
  check("sphere", 5e-4, SphereShape{0.75},
        [](const auto& m) { return convex_area(ball(dvec3(0), 0.75), m); });
  const dvec3 p0(-0.125, -0.125, -0.75), p1(0.125, 0.125, 0.75), axis = p1 - p0;
  check("capsule", 5e-4, capsule(0.5, 0.5),
        [&](const auto& m) { return convex_area(hull(ball(p0, 0.5), ball(p1, 0.5)), m); });
  check("tapered", 5e-4, capsule(0.75, 0.25),
        [&](const auto& m) { return convex_area(hull(ball(p0, 0.75), ball(p1, 0.25)), m); });
  const auto end = [&](Cap cap, const dvec3& p, double r) {
    return cap == Cap::round ? ball(p, r) : disk(p, axis, r);
  };
  for (const Cap a : {Cap::flat, Cap::round})
    for (const Cap b : {Cap::flat, Cap::round}) {
      check("cylinder", 5e-4, CylinderShape{p0, p1, 0.5, {a, b}},
            [&](const auto& m) { return convex_area(hull(end(a, p0, 0.5), end(b, p1, 0.5)), m); });
      check("cone", 5e-4, ConeShape{p0, p1, {0.75, 0.25}, {a, b}}, [&](const auto& m) {
        return convex_area(hull(end(a, p0, 0.75), end(b, p1, 0.25)), m);
      });
    }
  // A ball that reaches through the other end's disk.
  const ConeShape bulb{p0, p0 + dvec3(0, 0, 0.5), {0.75, 0.8}, {Cap::flat, Cap::round}};
  check("bulb", 5e-4, bulb, [&](const auto& m) {
    return convex_area(hull(disk(bulb.p0, dvec3(0, 0, 1), 0.75), ball(bulb.p1, 0.8)), m);
  });
}

TEST(LightPower, OfFlatAndOpenShapes) {
  // A parallelepiped: the lengths of the cross products of its edges' images.
  const auto box_area = [](const glm::dmat4& m) {
    const dvec3 x = dvec3(m[0]) * 2.0, y = dvec3(m[1]) * 1.0, z = dvec3(m[2]) * 0.5;
    return 2 * (glm::length(glm::cross(x, y)) + glm::length(glm::cross(y, z)) +
                glm::length(glm::cross(z, x)));
  };
  check("box", tolerance, BoxShape{{-1, 0, 0}, {1, 1, 0.5}}, box_area);
  check("polyhedron", tolerance,
        PolyhedronShape{{dvec3(-1, 0, 0), dvec3(1, 1, 0.5), dvec3(-1, 0, 0), dvec3(1, 1, 0.5),
                         dvec3(-1, 0, 0), dvec3(1, 1, 0.5)},
                        {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}},
        box_area);
  const auto plane = [](double area) {
    return [=](const glm::dmat4& m) {
      return area * glm::length(glm::cross(dvec3(m[0]), dvec3(m[1])));
    };
  };
  check("disk", tolerance, DiskShape{0.5, 0.75}, plane(pi * 0.5625));
  check("partial disk", tolerance, DiskShape{0.5, 1, 0.5, 2}, plane(0.75));
  TriangleMeshShape quad;
  quad.positions = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
  quad.triangles = {{0, 1, 2}, {0, 2, 3}};
  check("quad", tolerance, quad, plane(2));
  BilinearMeshShape saddle;
  saddle.positions = {{0, 0, 0}, {1, 0, 0.5}, {0, 1, 0.5}, {1, 1, -0.25}};
  saddle.patches = {{0, 1, 2, 3}};
  check("bilinear", tolerance, saddle, [](const auto& m) {
    return sheet_area(
        [](double u, double v) { return dvec3(u, v, 0.5 * u + 0.5 * v - 1.25 * u * v); }, m);
  });
  check("partial sphere", tolerance, PartialSphereShape{1, -0.25, 0.75, 4}, [](const auto& m) {
    return sheet_area(
        [](double u, double v) {
          const double z = -0.25 + u, r = std::sqrt(1 - z * z);
          return dvec3(r * std::cos(4 * v), r * std::sin(4 * v), z);
        },
        m);
  });
  check("open cylinder", tolerance, OpenCylinderShape{0.5, -1, 2, 5}, [](const auto& m) {
    return sheet_area(
        [](double u, double v) {
          return dvec3(0.5 * std::cos(5 * v), 0.5 * std::sin(5 * v), 3 * u - 1);
        },
        m);
  });
}

// Power is for both sides together, "scale" multiplies it, and "surfaces" say where it leaves.
TEST(LightPower, WithTwoSidesScaleAndSurfaces) {
  Scene scene = scene_of(DiskShape{0, 1}, glm::dmat4(1));
  scene.shapes[0].emission->two_sided = true;
  EXPECT_NEAR(emitted(scene, pi, 2), 60, 1e-4);
  scene.shapes[0].emission->scale = 3;
  EXPECT_NEAR(emitted(scene, pi, 2), 180, 3e-4);
  for (const glm::dmat4& m : transforms()) {
    const auto area = [&](const dvec3& x, const dvec3& y) {
      return glm::length(glm::cross(glm::dmat3(m) * x, glm::dmat3(m) * y));
    };
    Scene box = scene_of(BoxShape{{0, 0, 0}, {1, 2, 3}}, m);
    box.shapes[0].emission->surfaces = {1, 4};  // greatest x, least z
    EXPECT_NEAR(emitted(box, area({0, 2, 0}, {0, 0, 3}) + area({1, 0, 0}, {0, 2, 0}), 1), 60,
                60 * tolerance);
    Scene tube = scene_of(CylinderShape{{0, 0, -1}, {0, 0, 2}, 0.5}, m);
    tube.shapes[0].emission->surfaces = {0};
    const double side = sheet_area(
        [](double u, double v) {
          return dvec3(0.5 * std::cos(2 * pi * v), 0.5 * std::sin(2 * pi * v), 3 * u - 1);
        },
        m);
    EXPECT_NEAR(emitted(tube, side, 1), 60, 60 * tolerance);
    tube.shapes[0].emission->surfaces = {2};
    EXPECT_NEAR(emitted(tube, area({0.5, 0, 0}, {0, 0.5, 0}) * pi, 1), 60, 60 * tolerance);
    Scene cone = scene_of(ConeShape{{0, 0, 0}, {0, 0, 2}, {0.5, 1}, {Cap::flat, Cap::round}}, m);
    cone.shapes[0].emission->surfaces = {0};
    // From the rim (0.5, 0) tangent to the ball of radius 1 at height 2: apart = sqrt(4.25), the
    // tangent's length sqrt(3.25). It touches where the outward normal n has n . (rim - centre) =
    // 1: n = (cos a, sin a) with 0.5 cos a - 2 sin a = 1.
    const double a = std::acos(1 / std::sqrt(4.25)) - std::atan2(2, 0.5), r = std::cos(a),
                 z = 2 + std::sin(a);
    const double flank = sheet_area(
        [=](double u, double v) {
          const double at = 0.5 + u * (r - 0.5);
          return dvec3(at * std::cos(2 * pi * v), at * std::sin(2 * pi * v), u * z);
        },
        m);
    EXPECT_NEAR(emitted(cone, flank, 1), 60, 60 * tolerance);
  }
}

}  // namespace caplet::test::power_test
