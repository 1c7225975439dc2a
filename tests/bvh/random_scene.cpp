// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "random_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <iterator>
#include <limits>

#include "shared/kinds.h"

namespace caplet::test {

FlatPrimitive random_primitive(Random& random, unsigned shape, float size) {
  FlatPrimitive p{shape, 0, {}};
  for (int k = 0; k < 3; k++) p.data[k] = random.uniform(-1, 1);
  switch (shape) {
    case shape_sphere:
      p.data[3] = random.uniform(0.1f, 0.5f) * size;
      break;
    case shape_capsule:
    case shape_tapered_capsule:
      for (int k = 0; k < 3; k++) p.data[3 + k] = p.data[k] + random.uniform(-1, 1) * size;
      p.data[6] = random.uniform(0.01f, 0.3f) * size;
      if (shape == shape_tapered_capsule)
        p.data[7] = random.uniform(0, 1) < 0.2f ? 2 * size : random.uniform(0, 0.3f) * size;
      break;
    case shape_triangle:
      for (int k = 0; k < 6; k++) p.data[3 + k] = p.data[k % 3] + random.uniform(-1, 1) * size;
      break;
    default: {
      float n[3], l = 0;
      for (float& x : n) {
        x = random.uniform(-1, 1);
        l += x * x;
      }
      for (int k = 0; k < 3; k++) p.data[3 + k] = n[k] / std::sqrt(l);
      p.data[6] = random.uniform(0.1f, 0.5f) * size;
    }
  }
  return p;
}

std::vector<FlatPrimitive> random_scene(unsigned seed, unsigned shape, unsigned count, float size) {
  Random random(seed);
  std::vector<FlatPrimitive> out;
  for (unsigned i = 0; i < count; i++) {
    out.push_back(random_primitive(
        random, shape == shape_instance ? random_kinds[i % std::size(random_kinds)] : shape, size));
    out.back().id = i;
  }
  return out;
}

std::vector<RayRecord> random_rays(unsigned seed, int count) {
  Random random(seed);
  std::vector<RayRecord> out;
  for (int i = 0; i < count; i++) {
    const float reach = i % 3 == 0 ? 1.0f : 3.0f, speed = std::exp2(random.uniform(-6, 6));
    RayRecord r{};
    float* o[] = {&r.ox, &r.oy, &r.oz};
    float* d[] = {&r.dx, &r.dy, &r.dz};
    for (int k = 0; k < 3; k++) {
      *o[k] = random.uniform(-reach, reach);
      *d[k] = (random.uniform(-1, 1) - *o[k]) * speed;
    }
    r.t_min = 0;
    r.t_max = std::numeric_limits<float>::infinity();
    out.push_back(r);
  }
  return out;
}

Encoded encode(const std::vector<FlatPrimitive>& primitives, int kind_bits) {
  Encoded out;
  out.tree = encode_tree(primitives, out.nodes, out.leaves, kind_bits);
  return out;
}

namespace {

void store(const glm::dmat4& m, float* out) {
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 4; column++)
      out[4 * row + column] = static_cast<float>(m[column][row]);
}

glm::dmat4 random_placement(Random& random, unsigned i) {
  const auto u = [&](float a, float b) { return double(random.uniform(a, b)); };
  glm::dmat4 m = glm::translate(glm::dmat4(1), glm::dvec3(u(-3, 3), u(-3, 3), u(-3, 3)));
  m = glm::rotate(m, u(0, 6), glm::normalize(glm::dvec3(u(-1, 1), u(-1, 1), u(0.1f, 1))));
  return glm::scale(m, glm::dvec3(u(0.5f, 2), u(0.5f, 2), u(0.5f, 2) * (i % 2 == 0 ? 1 : -1)));
}

}  // namespace

void place(InstanceRecord& instance, const glm::dmat4& world_from_object) {
  store(world_from_object, instance.world_from_object);
  store(glm::inverse(world_from_object), instance.object_from_world);
}

PlacedScene placed_scene(unsigned seed, unsigned instance_count) {
  PlacedScene out;
  out.of_object = random_scene(seed, shape_instance, 60, 0.5f);
  out.object = encode_tree(out.of_object, out.nodes, out.leaves);
  Random random(seed + 1);
  out.of_world = random_scene(seed + 2, shape_capsule, 30, 0.8f);
  std::vector<FlatPrimitive> top = out.of_world;
  for (unsigned i = 0; i < instance_count; i++) {
    const glm::dmat4 placement = random_placement(random, i);
    InstanceRecord record{};
    place(record, placement);
    record.root = out.object.root;
    record.light_base = CAPLET_NONE;
    out.instances.push_back(record);
    FlatPrimitive box{shape_instance, i, {}};
    for (int k = 0; k < 3; k++) {
      box.data[k] = INFINITY;
      box.data[3 + k] = -INFINITY;
    }
    for (unsigned corner = 0; corner < 8; corner++) {
      const glm::dvec4 p =
          placement * glm::dvec4(double(corner & 1 ? out.object.max[0] : out.object.min[0]),
                                 double(corner & 2 ? out.object.max[1] : out.object.min[1]),
                                 double(corner & 4 ? out.object.max[2] : out.object.min[2]), 1);
      for (int k = 0; k < 3; k++) {
        box.data[k] = std::min(box.data[k], static_cast<float>(p[k]));
        box.data[3 + k] = std::max(box.data[3 + k], static_cast<float>(p[k]));
      }
    }
    top.push_back(box);
  }
  out.world = encode_tree(top, out.nodes, out.leaves);
  return out;
}

}  // namespace caplet::test
