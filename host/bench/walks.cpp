// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "bench/detail/walks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "shared/kinds.h"

namespace caplet::bench {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr int steps_a_walk = 50;

struct Vec {
  float x = 0, y = 0, z = 0;
};
Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator*(float s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
float dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vec normalize(Vec a) { return (1 / std::sqrt(dot(a, a))) * a; }

/// Calls step(from, to, radius) `count` times.
template <class Step>
void walk(std::size_t count, const Step& step) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> u(-1, 1);
  const float length = 0.01f * std::cbrt(1e6f / static_cast<float>(count));
  for (std::size_t made = 0; made < count;) {
    Vec at{u(engine), u(engine), u(engine)}, direction{u(engine), u(engine), u(engine)};
    const float radius = length * 0.12f * (1 + 0.5f * u(engine));
    for (int i = 0; i < steps_a_walk && made < count; i++, made++) {
      direction = normalize(direction + 0.6f * Vec{u(engine), u(engine), u(engine)});
      const Vec to = at + length * direction;
      step(at, to, radius);
      at = to;
    }
  }
}

Vec vec(const float* p) { return {p[0], p[1], p[2]}; }

/// Returns the normal on the side of `from`.
Vec normal_at(const FlatPrimitive& p, Vec x, Vec from) {
  Vec n;
  if (p.shape == shape_triangle) {
    n = cross(vec(p.data + 3) - vec(p.data), vec(p.data + 6) - vec(p.data));
  } else {
    const Vec a = vec(p.data), axis = vec(p.data + 3) - a;
    const float s = std::clamp(dot(x - a, axis) / std::max(dot(axis, axis), 1e-30f), 0.0f, 1.0f);
    n = x - (a + s * axis);
  }
  n = normalize(n);
  return dot(n, from - x) < 0 ? -1.0f * n : n;
}

std::uint64_t sort_key(const RayRecord& r) {
  const auto cell = [](float x) {
    return static_cast<std::uint64_t>(std::clamp((x + 1) * 16, 0.0f, 31.0f));
  };
  std::uint64_t key = 0;
  for (int bit = 4; bit >= 0; bit--)
    for (const float x : {r.ox, r.oy, r.oz}) key = key * 2 + (cell(x) >> bit & 1);
  return key * 8 + (r.dx < 0 ? 4u : 0u) + (r.dy < 0 ? 2u : 0u) + (r.dz < 0 ? 1u : 0u);
}

}  // namespace

std::vector<FlatPrimitive> walk_capsules(std::size_t count) {
  std::vector<FlatPrimitive> out;
  out.reserve(count);
  walk(count, [&](Vec a, Vec b, float radius) {
    out.push_back({shape_capsule,
                   static_cast<std::uint32_t>(out.size()),
                   {a.x, a.y, a.z, b.x, b.y, b.z, radius, 0, 0}});
  });
  return out;
}

std::vector<FlatPrimitive> walk_triangles(std::size_t count) {
  std::vector<FlatPrimitive> out;
  out.reserve(count + 1);
  const auto add = [&](Vec a, Vec b, Vec c) {
    out.push_back({shape_triangle,
                   static_cast<std::uint32_t>(out.size()),
                   {a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z}});
  };
  walk((count + 1) / 2, [&](Vec a, Vec b, float radius) {
    const Vec side = radius * normalize(cross(b - a, Vec{0.3f, 0.5f, 0.8f}));
    add(a - side, a + side, b + side);
    add(a - side, b + side, b - side);
  });
  out.resize(count);
  return out;
}

namespace {

glm::dvec3 wide(Vec a) { return {a.x, a.y, a.z}; }

FlatPrimitive peer_primitive(int shape, std::size_t id, std::initializer_list<float> data) {
  FlatPrimitive p{static_cast<std::uint32_t>(shape), static_cast<std::uint32_t>(id), {}};
  std::copy(data.begin(), data.end(), p.data);
  return p;
}

CapsulesShape one_capsule(Vec a, Vec b, float r0, float r1) {
  CapsulesShape capsule;
  capsule.p0 = {{a.x, a.y, a.z}};
  capsule.p1 = {{b.x, b.y, b.z}};
  capsule.radius0 = {r0};
  if (r0 != r1) capsule.radius1 = {r1};
  return capsule;
}

/// Returns an octahedron around the middle of the step.
PolyhedronShape octahedron(Vec a, Vec b, float radius) {
  PolyhedronShape out;
  const glm::dvec3 center = wide(0.5f * (a + b));
  for (int i = 0; i < 8; i++) {
    const glm::dvec3 n(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    out.normals.push_back(n);
    out.points.push_back(center + double(radius) * n);
  }
  return out;
}

CsgShape bitten_ball(Vec a, Vec b, float radius) {
  const auto ball = [&](Vec center, float r) {
    auto shape = std::make_shared<Shape>();
    shape->geometry = one_capsule(center, center, r, r);
    return shape;
  };
  CsgShape csg;
  csg.operation = CsgShape::Operation::set_difference;
  csg.operands = {ball(a, 2 * radius), ball(a + 0.2f * (b - a), 1.5f * radius)};
  return csg;
}

}  // namespace

const std::vector<std::string>& walk_kinds() {
  static const std::vector<std::string> kinds = {"spheres", "tapered", "disks",     "cylinders",
                                                 "cones",   "boxes",   "octahedra", "csg"};
  return kinds;
}

Scene walk_scene(const std::string& kind, std::size_t count, std::vector<FlatPrimitive>& peer) {
  Scene scene;
  scene.materials.emplace_back();
  scene.shapes.reserve(count);
  peer.clear();
  walk(count, [&](Vec a, Vec b, float r) {
    Shape shape;
    const std::size_t id = scene.shapes.size();
    if (kind == "spheres") {
      shape.geometry = one_capsule(a, a, 2 * r, 2 * r);
      peer.push_back(peer_primitive(shape_sphere, id, {a.x, a.y, a.z, 2 * r}));
    } else if (kind == "tapered") {
      shape.geometry = one_capsule(a, b, r, 0.5f * r);
      peer.push_back(
          peer_primitive(shape_tapered_capsule, id, {a.x, a.y, a.z, b.x, b.y, b.z, r, 0.5f * r}));
    } else if (kind == "disks") {
      shape.geometry = DiskShape{0, double(2 * r)};
      const Vec n = normalize(b - a), u = normalize(cross(n, Vec{0.3f, 0.5f, 0.8f})),
                v = cross(n, u);
      shape.world_from_object = glm::dmat4(glm::dvec4(wide(u), 0), glm::dvec4(wide(v), 0),
                                           glm::dvec4(wide(n), 0), glm::dvec4(wide(a), 1));
      peer.push_back(peer_primitive(shape_disk, id, {a.x, a.y, a.z, n.x, n.y, n.z, 2 * r}));
    } else if (kind == "cylinders") {
      shape.geometry = CylinderShape{wide(a), wide(b), double(r), {}};
    } else if (kind == "cones") {
      shape.geometry = ConeShape{wide(a), wide(b), {double(r), double(0.5f * r)}, {}};
    } else if (kind == "boxes") {
      shape.geometry =
          BoxShape{wide(a) - 1.5 * glm::dvec3(double(r)), wide(a) + 1.5 * glm::dvec3(double(r))};
    } else if (kind == "octahedra") {
      shape.geometry = octahedron(a, b, r);
    } else {
      shape.geometry = bitten_ball(a, b, r);
    }
    scene.shapes.push_back(std::move(shape));
  });
  return scene;
}

Scene walk_lamps(std::size_t count, bool emit) {
  Scene scene;
  scene.materials.emplace_back();
  CapsulesShape capsules;
  capsules.p0.reserve(count);
  capsules.p1.reserve(count);
  capsules.radius0.reserve(count);
  walk(count, [&](Vec a, Vec b, float r) {
    capsules.p0.emplace_back(a.x, a.y, a.z);
    capsules.p1.emplace_back(b.x, b.y, b.z);
    capsules.radius0.push_back(r);
  });
  Shape& shape = scene.shapes.emplace_back();
  shape.geometry = std::move(capsules);
  if (emit) shape.emission = AreaEmission{};
  return scene;
}

std::vector<RayRecord> camera_rays(int size) {
  std::vector<RayRecord> out;
  out.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (int ty = 0; ty < size; ty += 8)
    for (int tx = 0; tx < size; tx += 8)
      for (int y = ty; y < std::min(ty + 8, size); y++)
        for (int x = tx; x < std::min(tx + 8, size); x++) {
          const float u =
              0.6f * (2 * (static_cast<float>(x) + 0.5f) / static_cast<float>(size) - 1);
          const float v =
              0.6f * (1 - 2 * (static_cast<float>(y) + 0.5f) / static_cast<float>(size));
          const Vec d = normalize({u, v, -1});
          out.push_back({0, 0, 3, 0, d.x, d.y, d.z, inf});
        }
  return out;
}

std::vector<RayRecord> bounce_rays(std::span<const FlatPrimitive> primitives,
                                   std::span<const std::uint32_t> slots,
                                   std::span<const RayRecord> rays,
                                   std::span<const HitRecord> hits) {
  std::vector<std::uint32_t> primitive_of(
      static_cast<std::size_t>(*std::max_element(slots.begin(), slots.end())) + 1);
  for (std::size_t i = 0; i < slots.size(); i++)
    primitive_of[slots[i]] = static_cast<std::uint32_t>(i);
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> u(0, 1);
  std::vector<RayRecord> out;
  for (std::size_t i = 0; i < rays.size(); i++) {
    if (hits[i].slot == CAPLET_NONE) continue;
    const Vec o{rays[i].ox, rays[i].oy, rays[i].oz}, d{rays[i].dx, rays[i].dy, rays[i].dz};
    const Vec x = o + hits[i].t * d;
    const Vec n = normal_at(primitives[primitive_of[hits[i].slot]], x, o);
    const float phi = 6.2831853f * u(engine), z = 2 * u(engine) - 1, s = std::sqrt(1 - z * z);
    // The direction leads to a point of the unit sphere that touches the surface here, so it is
    // cosine-distributed.
    const Vec w = n + 0.9999f * Vec{s * std::cos(phi), s * std::sin(phi), z};
    const Vec b = normalize(w), start = x + 1e-5f * n;
    out.push_back({start.x, start.y, start.z, 0, b.x, b.y, b.z, inf});
  }
  return out;
}

std::vector<RayRecord> scattered_rays(std::span<const RayRecord> rays,
                                      std::span<const HitRecord> hits) {
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> u(0, 1);
  std::vector<RayRecord> out;
  for (std::size_t i = 0; i < rays.size(); i++) {
    if (hits[i].slot == CAPLET_NONE) continue;
    const Vec o{rays[i].ox, rays[i].oy, rays[i].oz}, d{rays[i].dx, rays[i].dy, rays[i].dz};
    const float phi = 6.2831853f * u(engine), z = 2 * u(engine) - 1, s = std::sqrt(1 - z * z);
    Vec w{s * std::cos(phi), s * std::sin(phi), z};
    if (dot(w, d) > 0) w = -1.0f * w;
    const Vec start = o + (hits[i].t - 1e-5f) * d;
    out.push_back({start.x, start.y, start.z, 0, w.x, w.y, w.z, inf});
  }
  return out;
}

void sort_rays(std::vector<RayRecord>& rays) {
  std::stable_sort(rays.begin(), rays.end(), [](const RayRecord& a, const RayRecord& b) {
    return sort_key(a) < sort_key(b);
  });
}

}  // namespace caplet::bench
